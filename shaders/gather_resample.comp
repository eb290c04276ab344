#version 460
// Makes pixels of the lattice's sums along one axis of the image: first along x, to rows of the lattice with the image's width, then along
// y into the image. A pixel is the mean over its width of the Catmull-Rom interpolation, by Simpson's rule.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "catmull_rom.glsl"
#include "gather_frame.glsl"
#include "gather_resolve.glsl"
#include "mean_distance.glsl"

layout(constant_id = 1) const bool kAlongY = false;

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2) uniform textureBuffer distances;    // sum of e times distance
layout(binding = 3, rgba32f) writeonly uniform imageBuffer colorEnergyOut;
layout(binding = 4, r32f) writeonly uniform imageBuffer distancesOut;

void main() {
  const ivec2 index = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 extent = ivec2(frame.size.x, kAlongY ? frame.size.y : frame.samples.y);
  if (any(greaterThanEqual(index, extent))) return;
  const int axis = kAlongY ? 1 : 0;
  const float halfPixel = 0.5 / frame.pitch;
  const float before = floor(float(index[axis]) / frame.pitch);  // samples between the first pixel and this one
  const float position = (float(index[axis]) - before * frame.pitch) / frame.pitch + float(kResampleTaps / 2 - 1);
  const int low = int(before) + kLatticeMargin - kResampleTaps / 2 + 1;
  const int row = kAlongY ? frame.size.x : 1;
  const int start = kAlongY ? index.x : index.y * frame.samples.x;
  vec4 color = vec4(0.0);
  MeanDistance mean = kNoDistance;
  [[unroll]] for (int i = 0; i < kResampleTaps; ++i) {
    const float offset = position - float(i);
    const float weight = (cubicKernel(offset - halfPixel) + 4.0 * cubicKernel(offset) + cubicKernel(offset + halfPixel)) / 6.0;
    const int place = start + clamp(low + i, 0, frame.samples[axis] - 1) * row;
    const vec4 texel = texelFetch(colorEnergy, place);
    color += weight * texel;
    if (kWithDistance) addSample(mean, weight, texel.a, texelFetch(distances, place).x);
  }
  const float distance = distancesOf(mean, color.a);
  if (kAlongY) {
    resolvePixel(index, color, distance);
    return;
  }
  imageStore(colorEnergyOut, index.x + index.y * frame.size.x, color);
  if (kWithDistance) imageStore(distancesOut, index.x + index.y * frame.size.x, vec4(distance));
}
