#version 460
// Third pass of the list of a level's occupied blocks: each block's index is written at its position, in
// ascending order, so that splats are drawn, and their sums rounded, in the same order every time. The
// position in the list is the block's rank in its level.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "interface.h"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { CompactPush push; };
layout(scalar, binding = 0) buffer Occupancy { OccupancyWord occupancy[]; };
layout(scalar, binding = 1) readonly buffer GroupOffsets { uint groupOffsets[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Blocks { uint values[]; };

#define COUNT_THREADS kOccupancyThreads
#include "count_before.glsl"

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint thread = gl_LocalInvocationIndex;
  const uint word = group * kOccupancyThreads + thread;
  uint mask = word < push.wordCount ? occupancy[push.firstWord + word].mask : 0;
  uint offset = countBefore(thread, bitCount(mask));
  if (word >= push.wordCount) return;
  offset += groupOffsets[group];
  occupancy[push.firstWord + word].before = offset;
  for (; mask != 0; mask &= mask - 1)
    Blocks(push.blocks).values[offset++] = (push.firstWord + word) * kBlocksPerWord + uint(findLSB(mask));
}
