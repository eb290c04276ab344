// Which sample of the lattice a thread of a dispatch has, and the slabs in which the volumes of a frame of several are added up.
#ifndef GATHER_SAMPLES_GLSL
#define GATHER_SAMPLES_GLSL
#include "gather_ray.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SampleList { SampleListHead head; uint samples[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MergeConstants { MergeFrame values; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MergedRays { MergedRay values[]; };
// By slab and slot: the light (rgb) that the medium in the slab sends to the eye if nothing dims it, and its optical depth (a).
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Slabs { vec4 values[]; };
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

// The number of the slab at a distance from the eye plane, with the fraction of it that is in front.
float slabAt(float distance) {
  MergeConstants merge = MergeConstants(push.merge);
  float slab = 0.0;
  for (int i = 0; i < merge.values.intervals; ++i) {
    const SlabInterval interval = merge.values.interval[i];
    slab += interval.perUnit * clamp(distance - interval.begin, 0.0, interval.end - interval.begin);
  }
  return slab;
}

// Adds what the medium between two distances has, in equal parts for equal distances: see Slabs. With `tinted` also its optical depth for
// light, by colour.
void addToSlabs(vec3 light, float depth, vec3 depths, float near, float far, bool tinted) {
  if (depth == 0.0 && light == vec3(0.0)) return;
  const float begin = slabAt(near), end = max(slabAt(far), begin + 1e-4), share = 1.0 / (end - begin);
  const int slot = slotOfThread(), last = min(int(end), MergeConstants(push.merge).values.slabs - 1);
  int slab = min(int(begin), last);
  bool more;
  do {
    if (slab <= last) {
      const float part = share * clamp(min(end, float(slab + 1)) - max(begin, float(slab)), 0.0, end - begin);
      const int i = slab * push.slots + slot;
      Slabs(push.slabs).values[i] += part * vec4(light, depth);
      if (tinted) Slabs(push.depths).values[i].rgb += part * depths;
    }
    more = ++slab <= last;
  } while (more);
}

#endif
