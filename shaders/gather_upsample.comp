#version 460
// Interpolates the lattice's sums at the pixels by Catmull-Rom along one axis of the image: first along x, to
// rows of the lattice with the image's width, then along y into the image.
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
  const float position = (float(index[axis]) + 0.5 - 0.5 * float(frame.size[axis]) - frame.firstSample[axis]) / frame.pitch;
  const float low = clamp(floor(position), 1.0, float(frame.samples[axis] - 3));
  const vec4 weights = cubicWeights(position - low);
  const int row = kAlongY ? frame.size.x : 1;
  int place = kAlongY ? index.x + (int(low) - 1) * row : int(low) - 1 + index.y * frame.samples.x;
  vec4 color = vec4(0.0);
  MeanDistance mean = kNoDistance;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const vec4 texel = texelFetch(colorEnergy, place);
    color += weights[i] * texel;
    if (kWithDistance) addSample(mean, weights[i], texel.a, texelFetch(distances, place).x);
    place += row;
  }
  const float distance = distancesOf(mean, color.a);
  if (kAlongY) {
    resolvePixel(index, color, distance);
    return;
  }
  imageStore(colorEnergyOut, index.x + index.y * frame.size.x, color);
  if (kWithDistance) imageStore(distancesOut, index.x + index.y * frame.size.x, vec4(distance));
}
