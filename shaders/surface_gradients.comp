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
const float kNoData = -1.0;
shared float values[kEdge * kEdge * kEdge];  // of the brick and one block around it

float valueAt(ivec3 cell) {
  if (kScalars) {
    const uint code = codeAt(push.scalars, push.level.dimensions, cell);
    return code == 0 ? kNoData : (float(code) - 1.0) * (float(kTransferIntervals) / float(kScalarCodes));
  }
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, push.level.dimensions))) return 0.0;
  const uint address = blockAddress(push.level, cell);
  const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
  const int bit = int(address % kBlocksPerWord);
  if ((word.x >> bit & 1u) == 0) return 0.0;
  return Extinctions(push.extinction).values[push.level.firstRank + rankIn(word, bit)];
}

// A block without data has the value of its neighbour.
vec3 gradientOf(int middle) {
  const float here = values[middle];
  if (here == kNoData) return vec3(0.0);
  vec3 sum = vec3(0.0);
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const float found = values[middle + x + kEdge * (y + kEdge * z)];
        const float value = found == kNoData ? here : found;
        const vec3 weights = 2.0 - abs(vec3(x, y, z));
        sum += value * vec3(x, y, z) * weights.yzx * weights.zxy;
      }
  return sum / 32.0;
}

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const ivec3 first = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz);
  for (int i = int(gl_LocalInvocationIndex); i < kEdge * kEdge * kEdge; i += kBrickQuadsThreads)
    values[i] = valueAt(first + ivec3(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge)) - 1);
  barrier();
  const int row = int(gl_LocalInvocationIndex), y = row % kGatherBrickEdge, z = row / kGatherBrickEdge;
  const uint block = (push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge;
  for (int x = 0; x < kGatherBrickEdge; ++x)
    Gradients(push.gradients).values[block + x] = packGradient(gradientOf(x + 1 + kEdge * (y + 1 + kEdge * (z + 1))));
}
