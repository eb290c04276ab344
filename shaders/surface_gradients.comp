#version 460
// Gradients at the centres of all blocks of bricks, whose directions are the normals of surfaces: of the
// scalars if voxels are classified after interpolation, otherwise of extinctions. Sobel's weights smooth
// equally in all directions, so that a steep surface shows no steps from voxel to voxel. A workgroup for each
// brick, a thread for each row of blocks.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "blocks.glsl"
#define CODE_TEXELS_BINDING 2
#define CODE_TEXELS_CONSTANT 2
#include "code_bricks.glsl"
#include "rank.glsl"
#include "packed_gradient.glsl"

layout(constant_id = 0) const bool kScalars = false;
layout(constant_id = 1) const bool kStoresTexels = true;  // whether all gradients are within the range of texels

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { SurfaceGradientsPush push; };
layout(binding = 0) uniform utextureBuffer brickCells;  // position of each brick's first block, in blocks: x, y, z
layout(binding = 1) uniform utextureBuffer occupancy;   // OccupancyWord
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Extinctions { float values[]; };
layout(binding = 4, r32ui) writeonly uniform uimageBuffer gradientTexels;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Gradients { uint values[]; };

const int kEdge = kGatherBrickEdge + 2;
shared float values[kEdge * kEdge * kEdge];  // of the brick and one block around it

float extinctionAt(ivec3 cell) {
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, push.level.dimensions))) return 0.0;
  const uint address = blockAddress(push.level, cell);
  const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
  const int bit = int(address % kBlocksPerWord);
  if ((word.x >> bit & 1u) == 0) return 0.0;
  return Extinctions(push.extinction).values[push.level.firstRank + rankIn(word, bit)];
}

// Loads a row of scalars, whose words of two codes are in at most three bricks.
void loadScalars(ivec3 cell, int to) {
  const int place = cell.x + push.scalars.corner.x, odd = place & 1, firstBrick = place >> kBrickLevels;
  uint bricks[3];
  [[unroll]] for (int i = 0; i < 3; ++i) {
    const int begin = max((firstBrick + i) * kBrickEdge - push.scalars.corner.x, 0);  // the first brick may begin before the volume
    bricks[i] = codeBrick(push.scalars, push.level.dimensions, ivec3(begin, cell.yz));
  }
  uint words[kEdge / 2 + 1];
  [[unroll]] for (int j = 0; j <= kEdge / 2; ++j) {
    const int x = cell.x - odd + 2 * j, number = ((place - odd + 2 * j) >> kBrickLevels) - firstBrick;
    words[j] = codeWord(push.scalars, number == 0 ? bricks[0] : number == 1 ? bricks[1] : bricks[2], ivec3(x, cell.yz));
  }
  [[unroll]] for (int i = 0; i < kEdge; ++i) {
    const uint word = odd == 0 ? words[i / 2] : words[(i + 1) / 2];
    const uint code = bitfieldExtract(word, ((i + odd) & 1) * 16, 16);
    const int x = cell.x + i;
    values[to + i] = x >= 0 && x < push.level.dimensions.x ? scalarOfCode(code) : kNoScalar;
  }
}

// Sums over the 3x3 blocks of a column across x: smoothed along y and z, y's derivative, z's derivative.
vec3 columnOf(float column[9]) {
  vec3 sums[3];  // by z: smoothed along y, y's derivative
  [[unroll]] for (int z = 0; z < 3; ++z)
    sums[z] = vec3(column[3 * z] + 2.0 * column[3 * z + 1] + column[3 * z + 2], column[3 * z + 2] - column[3 * z], 0.0);
  return vec3(sums[0].xy + 2.0 * sums[1].xy + sums[2].xy, sums[2].x - sums[0].x);
}

struct Column {
  vec3 values, present;
  float middle;
};

Column columnAt(int middle) {
  float column[9], presence[9];
  [[unroll]] for (int i = 0; i < 9; ++i) {
    const float found = values[middle + kEdge * (i % 3 - 1 + kEdge * (i / 3 - 1))];
    column[i] = found != kNoScalar ? found : 0.0;
    presence[i] = found != kNoScalar ? 1.0 : 0.0;
  }
  return Column(columnOf(column), columnOf(presence), values[middle]);
}

vec3 changeOf(vec3 before, vec3 here, vec3 after) { return vec3(after.x - before.x, before.yz + 2.0 * here.yz + after.yz) / 32.0; }

// In place of blocks without data, the middle one's value counts.
vec3 gradientOf(Column before, Column here, Column after) {
  if (here.middle == kNoScalar) return vec3(0.0);
  return changeOf(before.values, here.values, after.values) - here.middle * changeOf(before.present, here.present, after.present);
}

void store(uint block, uint gradient) {
  if (kStoresTexels)
    imageStore(gradientTexels, int(block), uvec4(gradient));
  else
    Gradients(push.gradients).values[block] = gradient;
}

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const ivec3 corner = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz);
  for (int row = int(gl_LocalInvocationIndex); row < kEdge * kEdge; row += kBrickQuadsThreads) {
    const ivec3 cell = corner + ivec3(0, row % kEdge, row / kEdge) - 1;
    if (kScalars)
      loadScalars(cell, row * kEdge);
    else
      for (int x = 0; x < kEdge; ++x) values[row * kEdge + x] = extinctionAt(cell + ivec3(x, 0, 0));
  }
  barrier();
  const int row = int(gl_LocalInvocationIndex), y = row % kGatherBrickEdge, z = row / kGatherBrickEdge;
  const uint block = (push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge;
  const int first = kEdge * (y + 1 + kEdge * (z + 1));
  Column before = columnAt(first), here = columnAt(first + 1);
  for (int x = 0; x < kGatherBrickEdge; ++x) {
    const Column after = columnAt(first + x + 2);
    store(block + x, packGradient(gradientOf(before, here, after)));
    before = here;
    here = after;
  }
}
