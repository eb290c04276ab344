#version 460
// The roughness at each coarse sample: the largest fourth difference of C and E along its row and its column of coarse samples, to which
// the error of interpolation by cubics is proportional. It is relative to the square root of the values, since a display shows the same
// error more clearly in dark parts. Distances, which are interpolated linearly, count with their second difference, in proportion to the alpha
// that has them: surfaces of the same colour one behind the other have edges in images of depth.
#extension GL_GOOGLE_include_directive : require
#include "gather_adaptive.glsl"

layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2) uniform textureBuffer distances;    // sum of e times distance
layout(binding = 3, r32f) writeonly uniform imageBuffer roughness;

const float kDarkest = 1.0 / 256.0;  // values below which errors are judged as at this one

vec4 coarseSample(ivec2 coarse) { return texelFetch(colorEnergy, placeOfCoarse(coarse)); }

float distanceSum(ivec2 coarse) { return texelFetch(distances, placeOfCoarse(coarse)).x; }

// The sample itself has the sums `here` and `sumHere`.
float roughnessAlong(ivec2 at, vec4 here, float sumHere, ivec2 next) {
  const vec4 a = coarseSample(at - 2 * next), b = coarseSample(at - next), d = coarseSample(at + next), e = coarseSample(at + 2 * next);
  const vec4 largest = max(max(max(a, b), max(d, e)), here);
  const vec4 differences = abs(a + e - 4.0 * (b + d) + 6.0 * here) * inversesqrt(max(largest, vec4(kDarkest)));
  const vec3 energies = vec3(b.a, here.a, d.a), sums = vec3(distanceSum(at - next), sumHere, distanceSum(at + next));
  const float alpha = min(energies.x, min(energies.y, energies.z));
  const vec3 means = sums / max(energies, vec3(1e-20));
  const float bend = alpha > 0.0 ? alpha * abs(means.x + means.z - 2.0 * means.y) : 0.0;
  return max(max(max(differences.x, differences.y), max(differences.z, differences.w)),
             bend * (frame.sampleTolerance / frame.distanceTolerance));
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy), extent = coarseExtent();
  if (any(greaterThanEqual(at, extent))) return;
  const vec4 here = coarseSample(at);
  const float sum = distanceSum(at);
  const float largest = max(roughnessAlong(at, here, sum, ivec2(1, 0)), roughnessAlong(at, here, sum, ivec2(0, 1)));
  imageStore(roughness, at.x + at.y * extent.x, vec4(largest));
}
