#version 460
// Makes pixels of the lattice's sums along one axis of the image: first along x, to rows of the lattice with the image's width, then along
// y into the image. A pixel is the mean over its width of the Catmull-Rom interpolation, by Simpson's rule; with a holdout, whose edges
// lie between pixels, the mean of its own samples.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "catmull_rom.glsl"
#include "gather_frame.glsl"
#include "mean_distance.glsl"

layout(constant_id = 0) const bool kWithDistance = false;
layout(constant_id = 1) const bool kAlongY = false;
layout(constant_id = 2) const int kTaps = kResampleTaps;

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2) uniform textureBuffer distances;    // sum of e times distance
layout(binding = 3, rgba32f) writeonly uniform imageBuffer colorEnergyOut;
layout(binding = 4, r32f) writeonly uniform imageBuffer distancesOut;
layout(binding = 5, rgba32f) writeonly uniform image2D colorImage;
layout(binding = 6, r32f) writeonly uniform image2D distanceImage;

// Computes a pixel from its sums: Subr et al. 2007, Eq. 10. The transmittance is exact, so E is the pixel's alpha and nothing is normalised;
// only the interpolation may leave the valid range. A negative distance means that there is none (mean_distance.glsl).
void resolvePixel(ivec2 pixel, vec4 colorEnergy, float distance) {
  const float alpha = clamp(colorEnergy.a, 0.0, 1.0);
  imageStore(colorImage, pixel, vec4(max(colorEnergy.rgb, vec3(0.0)), alpha));
  if (kWithDistance)
    imageStore(distanceImage, pixel, vec4(alpha > 0.0 && distance >= 0.0 ? distance / alpha : uintBitsToFloat(0x7f800000u)));
}

// Sets the weights of kTaps samples, and returns the index of the first one.
int weightsOf(int pixel, out float weights[kTaps]) {
  if (frame.raysOfPixel > 0) {
    [[unroll]] for (int i = 0; i < kTaps; ++i) weights[i] = i < frame.raysOfPixel ? 1.0 / float(frame.raysOfPixel) : 0.0;
    return kLatticeMargin + pixel * frame.raysOfPixel;
  }
  const float halfPixel = 0.5 / frame.pitch;
  const float before = floor(float(pixel) / frame.pitch);  // samples between the first pixel and this one
  const float middle = (float(pixel) - before * frame.pitch) / frame.pitch, lowest = floor(middle - halfPixel);
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

void main() {
  ivec2 index = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(index, kAlongY ? frame.pixelExtent : ivec2(frame.pixelExtent.x, frame.seenExtent.y)))) return;
  index += kAlongY ? frame.firstPixel : ivec2(frame.firstPixel.x, frame.firstSeen.y);
  const int axis = kAlongY ? 1 : 0;
  float weights[kTaps];
  const int first = weightsOf(index[axis], weights), last = frame.firstSeen[axis] + frame.seenExtent[axis] - 1;
  const int row = kAlongY ? frame.size.x : 1;
  const int start = kAlongY ? index.x : index.y * frame.samples.x;
  vec4 color = vec4(0.0);
  MeanDistance mean = kNoDistance;
  [[unroll]] for (int i = 0; i < kTaps; ++i) {
    const int place = start + clamp(first + i, frame.firstSeen[axis], last) * row;
    const vec4 texel = texelFetch(colorEnergy, place);
    color += weights[i] * texel;
    if (kWithDistance && (frame.raysOfPixel == 0 || weights[i] > 0.0)) addSample(mean, weights[i], texel.a, texelFetch(distances, place).x);
  }
  const float distance = distancesOf(mean, color.a);
  if (kAlongY) {
    resolvePixel(index, color, distance);
    return;
  }
  imageStore(colorEnergyOut, index.x + index.y * frame.size.x, color);
  if (kWithDistance) imageStore(distancesOut, index.x + index.y * frame.size.x, vec4(distance));
}
