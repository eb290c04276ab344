#version 460
// Makes pixels of the lattice's sums along one axis of the image: first along x, to rows of the lattice with the image's width, then along
// y into the image (ALONG_Y). A pixel is the mean over its width of the Catmull-Rom interpolation, by Simpson's rule; with a holdout, whose
// edges lie between pixels, the mean of its own samples. Both steps are drawn, in listed tiles (gather_tiles.vert): lavapipe stores what a
// fragment has in a third of the time that a compute shader's stores take.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "catmull_rom.glsl"
#include "mean_distance.glsl"

layout(constant_id = 0) const int kTaps = kResampleTaps;
layout(constant_id = 1) const int kRaysOfPixel = 0;  // GatherFrame::raysOfPixel

#define FLAT in
#include "resample_flats.glsl"
#ifdef ALONG_Y
layout(binding = 1, rgba32f) readonly uniform image2D colorEnergy;  // of rows from firstRow on
layout(binding = 2, r32f) readonly uniform image2D distances;
const int kAlong = 1;
#else
layout(binding = 1, rgba32f) readonly uniform imageBuffer colorEnergy;  // C, E
layout(binding = 2, r32f) readonly uniform imageBuffer distances;       // sum of e times distance
const int kAlong = 0;
#endif
layout(location = 0) out vec4 colorOut;
#ifdef WITH_DISTANCE
layout(location = 1) out float distanceOut;
#endif

// Sets the weights of kTaps samples, and returns the index of the first one.
int weightsOf(int pixel, out float weights[kTaps]) {
  if (kRaysOfPixel > 0) {
    [[unroll]] for (int i = 0; i < kTaps; ++i) weights[i] = i < kRaysOfPixel ? 1.0 / float(kRaysOfPixel) : 0.0;
    return kLatticeMargin + pixel * kRaysOfPixel;
  }
  const float halfPixel = 0.5 / pitch;
  const float before = floor(float(pixel) / pitch);  // samples between the first pixel and this one
  const float middle = (float(pixel) - before * pitch) / pitch, lowest = floor(middle - halfPixel);
  [[unroll]] for (int i = 0; i < kTaps; ++i) weights[i] = 0.0;
  [[unroll]] for (int k = -1; k <= 1; ++k) {
    // At most that of the last weights, whatever a division rounds to: the interpolation is continuous.
    const float position = middle + float(k) * halfPixel, low = min(floor(position), lowest + float(kTaps - 4));
    const vec4 cubic = cubicWeights(position - low) * (k == 0 ? 4.0 / 6.0 : 1.0 / 6.0);
    [[unroll]] for (int shift = 0; shift <= kTaps - 4; ++shift) {
      const vec4 shifted = low - lowest == float(shift) ? cubic : vec4(0.0);
      [[unroll]] for (int i = 0; i < 4; ++i) weights[shift + i] += shifted[i];
    }
  }
  return int(before + lowest) + kLatticeMargin - 1;
}

// Of a sample of the lattice, or of a pixel in a row of it.
vec4 colorEnergyAt(ivec2 at) {
#ifdef ALONG_Y
  return imageLoad(colorEnergy, at - ivec2(0, firstRow));
#else
  return imageLoad(colorEnergy, at.x + at.y * rowSamples);
#endif
}

#ifdef WITH_DISTANCE
float distanceAt(ivec2 at) {
#ifdef ALONG_Y
  return imageLoad(distances, at - ivec2(0, firstRow)).x;
#else
  return imageLoad(distances, at.x + at.y * rowSamples).x;
#endif
}
#endif

// Sets a pixel from its sums: Subr et al. 2007, Eq. 10. The transmittance is exact, so E is the pixel's alpha and nothing is normalised;
// only the interpolation may leave the valid range. A negative distance means that there is none (mean_distance.glsl).
void resolvePixel(vec4 color, float distance) {
  const float alpha = clamp(color.a, 0.0, 1.0);
  colorOut = vec4(max(color.rgb, vec3(0.0)), alpha);
#ifdef WITH_DISTANCE
  distanceOut = alpha > 0.0 && distance >= 0.0 ? distance / alpha : uintBitsToFloat(0x7f800000u);
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
#ifndef ALONG_Y
  at.y += firstRow;
#endif
  float weights[kTaps];
  const int first = weightsOf(at[kAlong], weights);
  vec4 color = vec4(0.0);
  MeanDistance mean = kNoDistance;
  [[unroll]] for (int i = 0; i < kTaps; ++i) {
    at[kAlong] = clamp(first + i, firstSeen, lastSeen);
    const vec4 texel = colorEnergyAt(at);
    color += weights[i] * texel;
#ifdef WITH_DISTANCE
    if (kRaysOfPixel == 0 || weights[i] > 0.0) addSample(mean, weights[i], texel.a, distanceAt(at));
#endif
  }
  const float distance = distancesOf(mean, color.a);
#ifdef ALONG_Y
  resolvePixel(color, distance);
#else
  colorOut = color;
#ifdef WITH_DISTANCE
  distanceOut = distance;
#endif
#endif
}
