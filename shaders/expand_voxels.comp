#version 460
// The extinction of all voxels of a slab, for the sweeps: a word of voxels a thread.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { ExpandPush push; };
layout(scalar, binding = 0) readonly buffer Occupancy { OccupancyWord occupancy[]; };
layout(scalar, binding = 1) readonly buffer Extinction { float extinction[]; };
layout(scalar, binding = 2) writeonly buffer SlabExtinction { vec4 slabExtinction[]; };

void main() {
  const uint word = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kOccupancyThreads;
  if (word >= push.wordCount) return;
  const uint mask = occupancy[push.firstWord + word].mask;
  uint rank = occupancy[push.firstWord + word].before;
  for (uint q = 0; q < kBlocksPerWord / 4; ++q) {
    vec4 quad = vec4(0.0);
    if ((mask >> (4 * q) & 15u) != 0)
      for (uint c = 0; c < 4; ++c)
        if ((mask >> (4 * q + c) & 1u) != 0) quad[c] = extinction[rank++];
    slabExtinction[kBlocksPerWord / 4 * word + q] = quad;
  }
}
