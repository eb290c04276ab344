#version 460
// The contribution of a voxel to a pixel's sums: Subr et al. 2007, Eq. 10. The ray's world length per index
// length is common to all voxels of a pixel, so resolve.comp multiplies by it.
#extension GL_GOOGLE_include_directive : require
#include "frame_interface.h"
#include "splat_weight.glsl"

layout(location = 0) out vec4 colorEnergySum;
layout(location = 1) out float opticalDepthSum;
#ifdef WITH_DISTANCE
layout(location = 2) out float distanceSum;
#endif

// The optical depth on the pixel's own ray, to first order: a voxel that is half in the shadow of something
// shows its lit half. Around the eye it grows along every ray by the voxel's own.
float depthOnRay(float length2) {
  if (isCut()) return max(depthToEye.x + depthToEye.y * worldPerIndex(length2) * cutAhead(length2), 0.0);
  const vec2 d = pixelPosition() - centerDistance.xy;
  return max(depthToEye.x + dot(depthToEye.yz, d), 0.0);
}

void main() {
  const float length2 = rayLength2();
  const float weight = splatWeight(length2);
  colorEnergySum = weight * exp(-depthOnRay(length2)) * colorEnergy;
  opticalDepthSum = weight * abs(conicDepth.w);
#ifdef WITH_DISTANCE
  distanceSum = colorEnergySum.a * centerDistance.z;
#endif
}
