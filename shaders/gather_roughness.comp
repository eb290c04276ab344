#version 460
// The roughness at each coarse sample: the largest fourth difference of C and E along its row and its column of coarse samples, to which the
// error of interpolation by cubics is proportional. It is relative to the square root of the values, since a display shows the same error
// more clearly in dark parts.
#extension GL_GOOGLE_include_directive : require
#include "gather_adaptive.glsl"

layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2, r32f) writeonly uniform imageBuffer roughness;

const float kDarkest = 1.0 / 256.0;  // values below which errors are judged as at this one

vec4 coarseSample(ivec2 coarse) { return texelFetch(colorEnergy, placeOfCoarse(coarse)); }

vec4 differences(ivec2 at, vec4 here, ivec2 next) {
  const vec4 a = coarseSample(at - 2 * next), b = coarseSample(at - next), d = coarseSample(at + next), e = coarseSample(at + 2 * next);
  const vec4 largest = max(max(max(a, b), max(d, e)), here);
  return abs(a + e - 4.0 * (b + d) + 6.0 * here) * inversesqrt(max(largest, vec4(kDarkest)));
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy), extent = coarseExtent();
  if (any(greaterThanEqual(at, extent))) return;
  const vec4 here = coarseSample(at);
  const vec4 largest = max(differences(at, here, ivec2(1, 0)), differences(at, here, ivec2(0, 1)));
  imageStore(roughness, at.x + at.y * extent.x, vec4(max(max(largest.x, largest.y), max(largest.z, largest.w))));
}
