#version 460
// What a voxel adds to a pixel's sums: Subr et al. 2007, Eq. 10, with the footprint evaluated on the pixel's
// own ray, which is exact for perspective and for any voxel shape. The ray's world length per index length is
// common to all voxels of the pixel: resolve.comp multiplies by it.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(scalar, push_constant) uniform Push { SplatPush push; };

layout(location = 0) flat in vec4 colorEnergy;
layout(location = 1) flat in vec4 conicDepth;
layout(location = 2) flat in vec3 centerDistance;

layout(location = 0) out vec4 colorEnergySum;
layout(location = 1) out float opticalDepthSum;
#ifdef WITH_DISTANCE
layout(location = 2) out float distanceSum;
#endif

void main() {
  const vec2 pixel = gl_FragCoord.xy;
  const vec2 p = pixel - push.imageMiddle;
  const float rayLength2 =
      push.rayLength2.x + p.x * (push.rayLength2.y + push.rayLength2Squares.x * p.x) +
      p.y * (push.rayLength2.z + push.rayLength2Squares.y * p.x + push.rayLength2Squares.z * p.y);
  const vec2 d = pixel - centerDistance.xy;
  const vec3 conic = conicDepth.xyz;
  const float r2 = (d.x * (conic.x * d.x + 2.0 * conic.y * d.y) + conic.z * d.y * d.y) / rayLength2;
  const float w = max(1.0 - r2, 0.0);
  const float weight = (w * w) * (w * w);
  colorEnergySum = weight * colorEnergy;
  opticalDepthSum = weight * conicDepth.w;
#ifdef WITH_DISTANCE
  distanceSum = weight * colorEnergy.a * centerDistance.z;
#endif
}
