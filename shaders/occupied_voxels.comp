#version 460
// Which voxels hold anything: a word of voxels a thread.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { VoxelsPush push; };
layout(binding = 0) uniform textureBuffer extinction;
layout(scalar, binding = 1) buffer Occupancy { OccupancyWord occupancy[]; };

void main() {
  const uint word = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kOccupancyThreads;
  if (word >= push.count) return;
  uint mask = 0;
  [[unroll]] for (uint q = 0; q < kBlocksPerWord / 4; ++q) {
    const bvec4 visible = greaterThan(texelFetch(extinction, int(kBlocksPerWord / 4 * word + q)), vec4(0.0));
    [[unroll]] for (uint c = 0; c < 4; ++c) mask |= uint(visible[c]) << (4 * q + c);
  }
  occupancy[word].mask = mask;
}
