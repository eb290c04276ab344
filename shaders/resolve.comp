#version 460
// Turns the sums of a pixel into its colour, in place. Additive: Subr et al. 2007, Eq. 10 and 11. Normalised:
// alpha is exact, and the sums only decide how the colours along the ray mix. Sorted: the colour is complete
// already.
#extension GL_GOOGLE_include_directive : require
#include "opacity.glsl"
#include "world_per_index.glsl"

layout(constant_id = 0) const bool kWithDistance = false;

layout(local_size_x = kResolveTile, local_size_y = kResolveTile) in;
layout(scalar, push_constant) uniform Push { ResolvePush push; };
layout(binding = 0, rgba32f) uniform image2D colorEnergy;      // C, E -> premultiplied colour, alpha
layout(binding = 1, r32f) readonly uniform image2D opticalDepth;  // T
layout(binding = 2, r32f) uniform image2D meanDistance;        // sum of e times distance -> mean distance

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, push.size))) return;
  const float scale = worldPerIndex(push, pixel);
  const vec4 sums = imageLoad(colorEnergy, pixel);
  if (kWithDistance) {
    const float weighted = imageLoad(meanDistance, pixel).r;
    imageStore(meanDistance, pixel, vec4(sums.a > 0.0 ? weighted / sums.a : uintBitsToFloat(0x7f800000u)));
  }
  vec4 result = push.composite == kCompositeSorted ? sums : sums * scale;
  if (push.composite == kCompositeNormalised) {
    const float alpha = opacityOf(imageLoad(opticalDepth, pixel).r * scale);
    result = vec4(result.rgb * (result.a > 0.0 ? alpha / result.a : 1.0), alpha);
  }
  imageStore(colorEnergy, pixel, result);
}
