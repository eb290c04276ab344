// Computes a pixel from its sums: Subr et al. 2007, Eq. 10. The transmittance is exact, so E is the pixel's
// alpha and nothing is normalised; only the interpolation may leave the valid range. A negative distance
// means that there is none (mean_distance.glsl).
#ifndef GATHER_RESOLVE_GLSL
#define GATHER_RESOLVE_GLSL
#include "gather_interface.h"

layout(constant_id = 0) const bool kWithDistance = false;

layout(binding = 5, rgba32f) writeonly uniform image2D colorImage;
layout(binding = 6, r32f) writeonly uniform image2D distanceImage;

void resolvePixel(ivec2 pixel, vec4 colorEnergy, float distance) {
  const float alpha = clamp(colorEnergy.a, 0.0, 1.0);
  imageStore(colorImage, pixel, vec4(max(colorEnergy.rgb, vec3(0.0)), alpha));
  if (kWithDistance)
    imageStore(distanceImage, pixel, vec4(alpha > 0.0 && distance >= 0.0 ? distance / alpha : uintBitsToFloat(0x7f800000u)));
}

#endif
