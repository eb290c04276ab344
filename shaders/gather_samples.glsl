// Which sample of the lattice a thread of a dispatch has, and the slabs in which the volumes of a frame of several are added up.
#ifndef GATHER_SAMPLES_GLSL
#define GATHER_SAMPLES_GLSL
#include "gather_ray.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SampleList { SampleListHead head; uint samples[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MergeConstants { MergeFrame values; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MergedRays { uint values[]; };
// What a volume has in the slabs in which it has something, front to back: by number and slot the light (rgb) that the medium in the slab sends to
// the eye if nothing dims it, and its optical depth (a), whose lowest kSlabBits bits are the number of the slab.
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SlabEntries { vec4 values[]; };
// By volume and slot: the number of entries.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer EntryCounts { int values[]; };
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

// The first intervals of slabs, which two volumes have at most: loads from addresses are slow on lavapipe.
const int kKeptIntervals = 3;
SlabInterval keptIntervals[kKeptIntervals];
int intervalCount = 0;

// Has to be called before the functions below.
void keepIntervals() {
  MergeConstants merge = MergeConstants(push.merge);
  intervalCount = merge.values.intervals;
  [[unroll]] for (int i = 0; i < kKeptIntervals; ++i) {
    keptIntervals[i] = SlabInterval(3e38, 3e38, 1.0, 3e38);
    if (i < intervalCount) keptIntervals[i] = merge.values.interval[i];
  }
}

float slabsIn(SlabInterval interval, float distance) {
  return interval.perUnit * clamp(distance - interval.begin, 0.0, interval.end - interval.begin);
}

// The number of the slab at a distance from the eye plane, with the fraction of it that is in front.
float slabAt(float distance) {
  float slab = 0.0;
  [[unroll]] for (int i = 0; i < kKeptIntervals; ++i) slab += slabsIn(keptIntervals[i], distance);
  for (int i = kKeptIntervals; i < intervalCount; ++i) slab += slabsIn(MergeConstants(push.merge).values.interval[i], distance);
  return slab;
}

// The distance of the middle of a slab.
float distanceOf(int slab) {
  const float middle = float(slab) + 0.5;
  float distance = 0.0;
  [[unroll]] for (int i = 0; i < kKeptIntervals; ++i)
    if (middle >= keptIntervals[i].first) distance = keptIntervals[i].begin + (middle - keptIntervals[i].first) / keptIntervals[i].perUnit;
  for (int i = kKeptIntervals; i < intervalCount; ++i) {
    const SlabInterval interval = MergeConstants(push.merge).values.interval[i];
    if (middle >= interval.first) distance = interval.begin + (middle - interval.first) / interval.perUnit;
  }
  return distance;
}

// Rounded to the bits that are left; not 0, as devices may take the bits of denormalised numbers for 0.
float withSlab(float depth, int slab) {
  const uint bits = floatBitsToUint(max(depth, 2e-38)) + uint(kMaxSlabs / 2);
  return uintBitsToFloat(bits & ~uint(kMaxSlabs - 1) | uint(slab));
}
int slabOf(float depth) { return int(floatBitsToUint(depth) & uint(kMaxSlabs - 1)); }
float depthOf(float depth) { return uintBitsToFloat(floatBitsToUint(depth) & ~uint(kMaxSlabs - 1)); }

// The place of an entry of the volume that is marched.
int placeOfEntry(int volume, int number, int slot) { return (volume * push.slabs + number) * push.slots + slot; }

// The slab that the march is in.
int openSlab = -1, entryCount = 0;
vec4 openSum = vec4(0.0);
vec3 openDepths = vec3(0.0);

void closeSlab(int slot, bool tinted) {
  if (openSum != vec4(0.0)) {
    const int place = placeOfEntry(push.volume, entryCount, slot);
    SlabEntries(push.entries).values[place] = vec4(openSum.rgb, withSlab(openSum.a, openSlab));
    if (tinted) SlabEntries(push.depths).values[place] = vec4(openDepths, 0.0);
    ++entryCount;
  }
  openSum = vec4(0.0);
  openDepths = vec3(0.0);
}

// Adds what the medium between two distances has, in equal parts for equal distances. With `tinted` also its optical depth for light, by
// colour. Distances ascend from call to call.
void addToSlabs(vec3 light, float depth, vec3 depths, float near, float far, bool tinted) {
  if (depth == 0.0 && light == vec3(0.0)) return;
  const float begin = min(slabAt(near), float(push.slabs) - 1e-3);  // what is rounded beyond the last slab belongs to it
  const float end = max(slabAt(far), begin + max(1e-4, 1e-6 * begin)), share = 1.0 / (end - begin);
  const int slot = slotOfThread(), last = min(int(end), push.slabs - 1);
  int slab = clamp(int(begin), openSlab, last);
  bool more;
  do {
    if (slab <= last) {
      const float part = share * clamp(min(end, float(slab + 1)) - max(begin, float(slab)), 0.0, end - begin);
      if (slab != openSlab) closeSlab(slot, tinted);
      openSlab = slab;
      openSum += part * vec4(light, depth);
      openDepths += part * depths;
    }
    more = ++slab <= last;
  } while (more);
}

// The mean of exp(-depth) over a segment along which the depth changes linearly from 0 to x, of either sign. It is multiplied by the
// transmittance at its beginning, which is nothing where x is less than -64.
float meanTransmittance(float x) { return abs(x) < 0.02 ? 1.0 - x * (0.5 - x / 6.0) : (1.0 - exp(-max(x, -64.0))) / x; }

#endif
