// Which sample of the lattice a thread of a dispatch has.
#ifndef GATHER_SAMPLES_GLSL
#define GATHER_SAMPLES_GLSL
#include "gather_ray.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SampleList { SampleListHead head; uint samples[]; };
// Of several volumes: by slot, which of them the ray meets, a bit for each.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MergedRays { uint values[]; };
layout(push_constant, scalar) uniform Push { SamplesPush push; };

// The number of this thread's sample in the list, counted from that of the range if `firstRow` is 0.
uint numberInList(int firstRow) {
  const uint group = gl_WorkGroupID.x + (gl_WorkGroupID.y + uint(firstRow)) * uint(push.groupsOfARow);
  return group * uint(kGatherTile * kGatherTile) + gl_LocalInvocationIndex;
}

// The sample of this thread, relative to the first one of those that are marched; beyond them if there is none.
ivec2 sampleOfThread() {
  if (push.step != 0) return push.step * (ivec2(gl_GlobalInvocationID.xy) + ivec2(0, push.firstRow));
  const uint number = numberInList(push.firstRow);
  SampleList list = SampleList(push.list);
  if (number >= list.head.count) return frame.seenExtent;
  const int place = int(list.samples[number]);
  return ivec2(place % frame.samples.x, place / frame.samples.x) - frame.firstSeen;
}

// The place of this thread's ray among those of the dispatch.
int slotOfThread() { return push.step != 0 ? int(gl_GlobalInvocationID.x) + int(gl_GlobalInvocationID.y) * push.columns : int(numberInList(0)); }

#endif
