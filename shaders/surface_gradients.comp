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
#include "code_bricks.glsl"
#include "rank.glsl"
#include "packed_gradient.glsl"

layout(constant_id = 0) const bool kScalars = false;

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { SurfaceGradientsPush push; };
layout(binding = 0) uniform utextureBuffer brickCells;  // position of each brick's first block, in blocks: x, y, z
layout(binding = 1) uniform utextureBuffer occupancy;   // OccupancyWord
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Extinctions { float values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Gradients { uint values[]; };

const int kEdge = kGatherBrickEdge + 2;
shared float values[kEdge * kEdge * kEdge];  // of the brick and one block around it

float valueAt(ivec3 cell) {
  if (kScalars) return scalarOfCode(codeAt(push.scalars, push.level.dimensions, cell));
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, push.level.dimensions))) return 0.0;
  const uint address = blockAddress(push.level, cell);
  const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
  const int bit = int(address % kBlocksPerWord);
  if ((word.x >> bit & 1u) == 0) return 0.0;
  return Extinctions(push.extinction).values[push.level.firstRank + rankIn(word, bit)];
}

// Sums over the 3x3 blocks of a column across x: smoothed along y and z, y's derivative, z's derivative; and the same of the blocks' presence.
struct Column {
  vec3 values, present;
  float middle;
};

Column columnAt(int middle) {
  Column column = Column(vec3(0.0), vec3(0.0), values[middle]);
  [[unroll]] for (int z = -1; z <= 1; ++z)
    [[unroll]] for (int y = -1; y <= 1; ++y) {
      const float found = values[middle + kEdge * (y + kEdge * z)];
      const vec3 weights = vec3((2 - abs(y)) * (2 - abs(z)), y * (2 - abs(z)), z * (2 - abs(y)));
      if (found == kNoScalar) continue;
      column.values += found * weights;
      column.present += weights;
    }
  return column;
}

// In place of blocks without data, the middle one's value counts.
vec3 gradientOf(Column before, Column here, Column after) {
  if (here.middle == kNoScalar) return vec3(0.0);
  const vec3 change = vec3(after.values.x - before.values.x, before.values.yz + 2.0 * here.values.yz + after.values.yz);
  const vec3 present = vec3(after.present.x - before.present.x, before.present.yz + 2.0 * here.present.yz + after.present.yz);
  return (change - here.middle * present) / 32.0;
}

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const ivec3 corner = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz);
  for (int i = int(gl_LocalInvocationIndex); i < kEdge * kEdge * kEdge; i += kBrickQuadsThreads)
    values[i] = valueAt(corner + ivec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)) - 1);
  barrier();
  const int row = int(gl_LocalInvocationIndex), y = row % kGatherBrickEdge, z = row / kGatherBrickEdge;
  const uint block = (push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge;
  const int first = kEdge * (y + 1 + kEdge * (z + 1));
  Column before = columnAt(first), here = columnAt(first + 1);
  for (int x = 0; x < kGatherBrickEdge; ++x) {
    const Column after = columnAt(first + x + 2);
    Gradients(push.gradients).values[block + x] = packGradient(gradientOf(before, here, after));
    before = here;
    here = after;
  }
}
