#version 460
// The sums of rays that meet several volumes, from what all of these have in each slab, and of those that meet none: within a slab the media
// are mixed, C = T (1 - exp(-t)) / t times the light that they send to the eye, t the sum of their optical depths. The order of the volumes
// does not matter.
#extension GL_GOOGLE_include_directive : require
#include "gather_samples.glsl"

layout(constant_id = 0) const bool kTinted = false;

layout(binding = 1, rgba32f) writeonly uniform imageBuffer colorEnergy;
layout(binding = 2, r32f) writeonly uniform imageBuffer distances;

vec3 meanTransmittance(vec3 x) { return mix((1.0 - exp(-x)) / max(x, 1e-6), 1.0 - x * (0.5 - x / 6.0), lessThan(x, vec3(0.02))); }

// The distance of the middle of a slab.
float distanceOf(int slab) {
  MergeConstants merge = MergeConstants(push.merge);
  float distance = 0.0;
  for (int i = 0; i < merge.values.intervals; ++i) {
    const SlabInterval interval = merge.values.interval[i];
    if (float(slab) + 0.5 >= interval.first) distance = interval.begin + (float(slab) + 0.5 - interval.first) / interval.perUnit;
  }
  return distance;
}

void main() {
  ivec2 index = sampleOfThread();
  if (any(greaterThanEqual(index, frame.seenExtent))) return;
  index += frame.firstSeen;
  const int slot = slotOfThread(), place = index.x + index.y * frame.samples.x;
  const MergedRay ray = MergedRays(push.rays).values[slot];
  if (ray.volumes != 0 && (ray.volumes & (ray.volumes - 1)) == 0) return;
  const float endTransmittance = MergeConstants(push.merge).values.endTransmittance;
  vec3 color = vec3(0.0), colorTransmittance = vec3(1.0);
  float transmittance = 1.0, distance = 0.0;
  int slab = ray.volumes == 0 ? ray.endSlab : ray.firstSlab;
  bool more = slab < ray.endSlab;
  while (more) {
    const int i = slab * push.slots + slot;
    const vec4 sum = Slabs(push.slabs).values[i];
    const vec3 depths = kTinted ? Slabs(push.depths).values[i].rgb : sum.aaa;
    const float rest = transmittance * exp(-sum.a);
    color += (kTinted ? colorTransmittance : vec3(transmittance)) * sum.rgb * meanTransmittance(depths);
    if (kTinted) colorTransmittance *= exp(-depths);
    if (rest < transmittance) distance += (transmittance - rest) * distanceOf(slab);
    transmittance = rest;
    ++slab;
    more = slab < ray.endSlab && transmittance > endTransmittance;
  }
  // As in gather.comp.
  const float energy = 1.0 - transmittance;
  const float whole = transmittance > endTransmittance ? 1.0 : 1.0 / energy;
  imageStore(colorEnergy, place, whole * vec4(color, energy));
  imageStore(distances, place, vec4(whole * distance));
}
