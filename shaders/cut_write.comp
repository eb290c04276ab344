#version 460
// Last pass of the cut, one dispatch for each level, after compact_scan.comp: writes the drawn blocks at
// their positions, in the order of their slots.
#extension GL_GOOGLE_include_directive : require
#include "cut_frame.glsl"

layout(local_size_x = kCutThreads) in;
layout(scalar, binding = 2) readonly buffer Masks { uint masks[]; };
layout(scalar, binding = 3) readonly buffer GroupOffsets { uint groupOffsets[]; };
layout(scalar, binding = 4) writeonly buffer Drawn { uint drawn[]; };

#define COUNT_THREADS kCutThreads
#include "count_before.glsl"

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint thread = gl_LocalInvocationIndex;
  const uint first = (group * kCutThreads + thread) * kCutSlotsPerThread;
  uint mask = first < push.slotCount ? masks[(push.firstGroup + group) * kCutThreads + thread] : 0;
  uint offset = countBefore(thread, bitCount(mask));
  if (mask == 0) return;
  offset += groupOffsets[push.firstGroup + group];
  for (; mask != 0; mask &= mask - 1)
    drawn[offset++] = blockAddress(frame.levels[push.level], cellOfSlot(first + uint(findLSB(mask))));
}
