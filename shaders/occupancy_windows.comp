#version 460
// Words of occupancy that overlap by half, so that a block and its next neighbour in x are always in one of them.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "gather_interface.h"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { WindowsPush push; };
layout(scalar, binding = 0) readonly buffer Occupancy { OccupancyWord occupancy[]; };
layout(scalar, binding = 1) writeonly buffer Windows { OccupancyWord windows[]; };

void main() {
  const uint window = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kOccupancyThreads;
  if (window >= push.windowCount) return;
  const OccupancyWord word = occupancy[window / 2];
  OccupancyWord result = word;
  if (window % 2 == 1) {
    const uint next = window + 1 < push.windowCount ? occupancy[(window + 1) / 2].mask : 0u;
    result.mask = word.mask >> kWindowStep | next << kWindowStep;
    result.before = word.before + bitCount(word.mask & 0xffffu);
  }
  windows[window] = result;
}
