#version 460
// Blends a voxel in front of what its pixel holds already: Subr et al. 2007, Eq. 9, which leaks. Colours are
// premultiplied; every output is blended with its own alpha: source + (1 - alpha) destination.
#extension GL_GOOGLE_include_directive : require
#include "frame_interface.h"
#include "splat_weight.glsl"

layout(location = 0) out vec4 color;
#ifdef WITH_DISTANCE
layout(location = 1) out vec4 distanceSum;  // the target has x only; the blending takes alpha from here
#endif

void main() {
  const float length2 = rayLength2();
  color = splatWeight(length2) * worldPerIndex(length2) * colorEnergy;
  color /= max(color.a, 1.0);
#ifdef WITH_DISTANCE
  distanceSum = vec4(color.a * centerDistance.z, 0.0, 0.0, color.a);
#endif
}
