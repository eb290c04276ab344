// Several volumes in one image: what each has along a ray is added up in slabs. All volumes that a ray meets but the last one store that in
// lists. The last one composites the lists with its own slabs as it marches: within a slab the media are mixed, C = T (1 - exp(-t)) / t times
// the light that they send to the eye, t the sum of their optical depths. The order of the volumes does not matter.
#ifndef GATHER_SLABS_GLSL
#define GATHER_SLABS_GLSL
#include "gather_march.glsl"
#include "gather_samples.glsl"

layout(constant_id = 12) const bool kComposites = false;  // with kMerged: whether this is the last volume that rays meet
layout(constant_id = 13) const int kLists = 1;            // with kComposites: the number of volumes in front of it in the list of volumes

// What a volume has in the slabs in which it has something, front to back: by number and slot the light (rgb) that the medium in the slab sends to
// the eye if nothing dims it, and its optical depth (a), whose lowest bits are the number of the slab.
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SlabEntries { vec4 values[]; };
layout(binding = 15) uniform textureBuffer slabEntries;  // the same, which lavapipe reads in less time
layout(binding = 16) uniform textureBuffer slabDepths;   // with kTinted: the optical depth for light, by colour
// By volume and slot: the number of entries.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer EntryCounts { int values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MergeConstants { MergeFrame values; };

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

// The place of an entry of a volume.
int placeOfEntry(int volume, int number) { return (volume * push.slabs + number) * push.slots + slotOfThread(); }

// The slab that the march is in.
int openSlab = -1, entryCount = 0;
vec4 openSum = vec4(0.0);
vec3 openDepths = vec3(0.0);

void storeSlab() {
  if (openSum == vec4(0.0)) return;
  const int place = placeOfEntry(push.volume, entryCount);
  SlabEntries(push.entries).values[place] = vec4(openSum.rgb, withSlab(openSum.a, openSlab));
  if (kTinted) SlabEntries(push.depths).values[place] = vec4(openDepths, 0.0);
  ++entryCount;
}

// With kComposites: the next entry of each list, and the nearest slab of all of these; kMaxSlabs behind the last one.
vec4 listNext[kLists];
int listSlabs[kLists], listNumbers[kLists], listCounts[kLists];
int nearestListed = kMaxSlabs;
// The sums of all volumes.
vec3 mergedColor = vec3(0.0), mergedColorTransmittance = vec3(1.0);
float mergedTransmittance = 1.0, mergedDistance = 0.0;

// `met` has a bit for each volume that the ray meets.
void openLists(uint met) {
  [[unroll]] for (int v = 0; v < kLists; ++v) {
    listCounts[v] = (met >> v & 1u) != 0 ? EntryCounts(push.counts).values[v * push.slots + slotOfThread()] : 0;
    listNumbers[v] = 0;
    listNext[v] = listCounts[v] > 0 ? texelFetch(slabEntries, placeOfEntry(v, 0)) : vec4(0.0);
    listSlabs[v] = listCounts[v] > 0 ? slabOf(listNext[v].a) : kMaxSlabs;
    nearestListed = min(nearestListed, listSlabs[v]);
  }
}

// Composites what lists have in front of the open slab, and then that one.
void compositeSlabs() {
  bool more = mergedTransmittance > frame.endTransmittance;
  do {
    if (more) {
      const int slab = min(nearestListed, openSlab);
      vec4 sum = slab == openSlab ? openSum : vec4(0.0);
      vec3 depths = slab == openSlab ? openDepths : vec3(0.0);
      int following = kMaxSlabs;
      [[unroll]] for (int v = 0; v < kLists; ++v) {
        if (listSlabs[v] == slab) {
          sum += vec4(listNext[v].rgb, depthOf(listNext[v].a));
          if (kTinted) depths += texelFetch(slabDepths, placeOfEntry(v, listNumbers[v])).rgb;
          ++listNumbers[v];
          const bool hasNext = listNumbers[v] < listCounts[v];
          if (hasNext) listNext[v] = texelFetch(slabEntries, placeOfEntry(v, listNumbers[v]));
          listSlabs[v] = hasNext ? slabOf(listNext[v].a) : kMaxSlabs;
        }
        following = min(following, listSlabs[v]);
      }
      nearestListed = following;
      if (!kTinted) depths = sum.aaa;
      const float rest = mergedTransmittance * exp(-sum.a);
      const vec3 before = kTinted ? mergedColorTransmittance : vec3(mergedTransmittance);
      [[unroll]] for (int c = 0; c < 3; ++c) mergedColor[c] += before[c] * sum[c] * meanTransmittance(depths[c]);
      if (kTinted) mergedColorTransmittance *= exp(-depths);
      mergedDistance += (mergedTransmittance - rest) * distanceOf(slab);
      mergedTransmittance = rest;
      more = slab < openSlab && mergedTransmittance > frame.endTransmittance;
    }
  } while (more);
}

void closeSlab() {
  if (kComposites)
    compositeSlabs();
  else
    storeSlab();
  openSum = vec4(0.0);
  openDepths = vec3(0.0);
}

// Closes the last slab, and composites what lists have behind it.
void closeAllSlabs() {
  closeSlab();
  if (!kComposites) {
    EntryCounts(push.counts).values[push.volume * push.slots + slotOfThread()] = entryCount;
    return;
  }
  openSlab = kMaxSlabs - 1;
  compositeSlabs();
}

// What a part of a stretch has: the light that it sends to the eye if nothing dims it (rgb) and its optical depth (a); with kTinted also
// that for light, by colour.
struct SlabPart {
  vec4 sum;
  vec3 depths;
};

// Adds the two halves of a stretch, each of which is spread evenly over its distances: from borders.x to borders.y and on to borders.z.
// Distances ascend from call to call.
void addToSlabs(SlabPart near, SlabPart far, vec3 borders) {
  const vec4 whole = near.sum + far.sum;
  const float begin = min(slabAt(borders.x), float(push.slabs) - 1e-3);  // what is rounded beyond the last slab belongs to it
  const float end = max(slabAt(borders.z), begin + max(1e-4, 1e-6 * begin));
  const float nearShare = clamp((borders.y - borders.x) / max(borders.z - borders.x, 1e-30), 0.0, 1.0), middle = mix(begin, end, nearShare);
  const float perNear = 1.0 / max(middle - begin, 1e-6), perFar = 1.0 / max(end - middle, 1e-6);
  const int last = whole == vec4(0.0) ? openSlab : max(min(int(end), push.slabs - 1), openSlab);
  vec4 before = vec4(0.0);  // what is in slabs in front of the open one
  vec3 depthsBefore = vec3(0.0);
  do {
    if (openSlab < last) {
      const float border = float(openSlab + 1);
      const vec2 parts = clamp(vec2((border - begin) * perNear, (border - middle) * perFar), 0.0, 1.0);
      const vec4 upTo = parts.x * near.sum + parts.y * far.sum;
      openSum += upTo - before;
      before = upTo;
      if (kTinted) {
        const vec3 depthsUpTo = parts.x * near.depths + parts.y * far.depths;
        openDepths += depthsUpTo - depthsBefore;
        depthsBefore = depthsUpTo;
      }
      closeSlab();
      openSlab = max(openSlab + 1, int(begin));
    }
  } while (openSlab < last);
  openSum += whole - before;
  if (kTinted) openDepths += near.depths + far.depths - depthsBefore;
}

#endif
