// How much of its own light leaves a voxel towards the eye: the mean of the transmittance over its layer, or over its kernel,
// relative to that at the front of the layer.
#ifndef SELF_ATTENUATION_GLSL
#define SELF_ATTENUATION_GLSL
#include "block_depth.glsl"

// The mean over a layer of optical depth x: (1 - exp(-x)) / x, accurate for small x.
float selfAttenuation(float x) {
  return x < 0.02 ? 1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0))) : (1.0 - exp(-x)) / x;
}

// The mean over half a layer of optical depth x, from its front, with weights of mean 1 that fall to 0 at its
// end: 2 (x - 1 + exp(-x)) / x², valid for x < 0 and near 0.
float fadingMean(float x) {
  return abs(x) < 0.1 ? 1.0 - x * (1.0 / 3.0 - x * (1.0 / 12.0 - x * (1.0 / 60.0))) : 2.0 * (x - 1.0 + exp(-x)) / (x * x);
}

// Interpolates between the four voxels around a position in a plane of voxels; 0 outside.
float extinctionAt(vec3 position, int axis) {
  const int sideA = (axis + 1) % 3, sideB = (axis + 2) % 3;
  const vec3 low = floor(position);
  float sum = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    vec3 voxel = low;
    voxel[axis] = round(position[axis]);
    voxel[sideA] += float(corner & 1);
    voxel[sideB] += float(corner >> 1);
    const float share = (1.0 - abs(position[sideA] - voxel[sideA])) * (1.0 - abs(position[sideB] - voxel[sideB]));
    sum += share * extinctionOf(frame.levels[0], ivec3(voxel));
  }
  return sum;
}

// The kernel is a tent along the line of sight: 3/4 of it is in the voxel's own layer of optical depth `own`,
// and 1/8 in each of the half layers in front and behind. `inFront` is the depth to the eye at the layer's
// front.
float kernelMean(vec3 position, vec3 direction, float own, float inFront) {
  const int axis = majorAxis(direction);
  const float layer = layerLength(direction);
  const float before = min(layer * extinctionAt(position + direction, axis), inFront);
  const float behind = layer * extinctionAt(position - direction, axis);
  const float halfLayer = selfAttenuation(0.5 * own);
  return 0.5 * selfAttenuation(own) + 0.25 * halfLayer * halfLayer + 0.125 * fadingMean(-0.5 * before) +
         0.125 * exp(-own) * fadingMean(0.5 * behind);
}

#endif
