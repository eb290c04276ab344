#version 460
// What a voxel adds to a pixel's sums: Subr et al. 2007, Eq. 10. The ray's world length per index length is
// common to all voxels of the pixel: resolve.comp multiplies by it.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "splat_weight.glsl"

layout(location = 3) flat in vec3 depthToEye;

layout(location = 0) out vec4 colorEnergySum;
layout(location = 1) out float opticalDepthSum;
#ifdef WITH_DISTANCE
layout(location = 2) out float distanceSum;
#endif

void main() {
  const float weight = splatWeight(rayLength2());
  // The optical depth on the pixel's own ray, to first order: what is half in the shadow of something shows
  // its lit half.
  const vec2 d = gl_FragCoord.xy - centerDistance.xy;
  const float depth = max(depthToEye.x + dot(depthToEye.yz, d), 0.0);
  colorEnergySum = weight * exp(-depth) * colorEnergy;
  opticalDepthSum = weight * conicDepth.w;
#ifdef WITH_DISTANCE
  distanceSum = colorEnergySum.a * centerDistance.z;
#endif
}
