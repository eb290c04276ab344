#version 460
// The sums of rays that meet several volumes, from what these have in each slab, front to back, and of those that meet none: within a slab the media
// are mixed, C = T (1 - exp(-t)) / t times the light that they send to the eye, t the sum of their optical depths. The order of the volumes
// does not matter.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_samples.glsl"

layout(constant_id = 0) const bool kTinted = false;
layout(constant_id = 1) const int kVolumes = 2;

layout(binding = 1, rgba32f) writeonly uniform imageBuffer colorEnergy;
layout(binding = 2, r32f) writeonly uniform imageBuffer distances;
layout(binding = 3) uniform textureBuffer slabEntries;

void main() {
  ivec2 index = sampleOfThread();
  if (any(greaterThanEqual(index, frame.seenExtent))) return;
  index += frame.firstSeen;
  const int slot = slotOfThread(), place = index.x + index.y * frame.samples.x;
  const uint met = MergedRays(push.rays).values[slot];
  if (met != 0 && (met & (met - 1)) == 0) return;
  const float endTransmittance = MergeConstants(push.merge).values.endTransmittance;
  keepIntervals();
  // The next entry of each volume.
  vec4 next[kVolumes];
  int slabs[kVolumes], numbers[kVolumes], counts[kVolumes];
  int slab = kMaxSlabs;  // the nearest of all
  [[unroll]] for (int v = 0; v < kVolumes; ++v) {
    counts[v] = (met >> v & 1u) != 0 ? EntryCounts(push.counts).values[v * push.slots + slot] : 0;
    numbers[v] = 0;
    next[v] = counts[v] > 0 ? texelFetch(slabEntries, placeOfEntry(v, 0, slot)) : vec4(0.0);
    slabs[v] = counts[v] > 0 ? slabOf(next[v].a) : kMaxSlabs;
    slab = min(slab, slabs[v]);
  }
  vec3 color = vec3(0.0), colorTransmittance = vec3(1.0);
  float transmittance = 1.0, distance = 0.0;
  bool more = slab < kMaxSlabs;
  do {
    if (more) {
      vec4 sum = vec4(0.0);
      vec3 depths = vec3(0.0);
      int following = kMaxSlabs;
      [[unroll]] for (int v = 0; v < kVolumes; ++v) {
        if (slabs[v] == slab) {
          sum += vec4(next[v].rgb, depthOf(next[v].a));
          if (kTinted) depths += SlabEntries(push.depths).values[placeOfEntry(v, numbers[v], slot)].rgb;
          ++numbers[v];
          const bool hasNext = numbers[v] < counts[v];
          if (hasNext) next[v] = texelFetch(slabEntries, placeOfEntry(v, numbers[v], slot));
          slabs[v] = hasNext ? slabOf(next[v].a) : kMaxSlabs;
        }
        following = min(following, slabs[v]);
      }
      if (!kTinted) depths = sum.aaa;
      const float rest = transmittance * exp(-sum.a);
      const vec3 before = kTinted ? colorTransmittance : vec3(transmittance);
      [[unroll]] for (int c = 0; c < 3; ++c) color[c] += before[c] * sum[c] * meanTransmittance(depths[c]);
      if (kTinted) colorTransmittance *= exp(-depths);
      distance += (transmittance - rest) * distanceOf(slab);
      transmittance = rest;
      slab = following;
      more = slab < kMaxSlabs && transmittance > endTransmittance;
    }
  } while (more);
  // As in gather.comp.
  const float energy = 1.0 - transmittance;
  const float whole = transmittance > endTransmittance ? 1.0 : 1.0 / energy;
  imageStore(colorEnergy, place, whole * vec4(color, energy));
  imageStore(distances, place, vec4(whole * distance));
}
