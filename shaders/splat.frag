#version 460
// What a voxel adds to a pixel's sums: Subr et al. 2007, Eq. 10. The ray's world length per index length is
// common to all voxels of the pixel: resolve.comp multiplies by it.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "splat_weight.glsl"

layout(location = 0) out vec4 colorEnergySum;
layout(location = 1) out float opticalDepthSum;
#ifdef WITH_DISTANCE
layout(location = 2) out float distanceSum;
#endif

void main() {
  const float weight = splatWeight(rayLength2());
  colorEnergySum = weight * colorEnergy;
  opticalDepthSum = weight * conicDepth.w;
#ifdef WITH_DISTANCE
  distanceSum = weight * colorEnergy.a * centerDistance.z;
#endif
}
