#version 460
// First pass of the list of a level's occupied blocks: counts those of each workgroup's stretch.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { CompactPush push; };
layout(scalar, binding = 0) readonly buffer Occupancy { OccupancyWord occupancy[]; };
layout(scalar, binding = 1) buffer GroupCounts { uint groupCounts[]; };

shared uint total;

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint word = group * kOccupancyThreads + gl_LocalInvocationIndex;
  if (gl_LocalInvocationIndex == 0) total = 0;
  barrier();
  if (word < push.wordCount) atomicAdd(total, bitCount(occupancy[push.firstWord + word].mask));
  barrier();
  if (gl_LocalInvocationIndex == 0 && group < push.groupCount) groupCounts[group] = total;
}
