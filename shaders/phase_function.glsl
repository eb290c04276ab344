// How much light is scattered from one direction to another: by a medium, and by a surface.
#ifndef PHASE_FUNCTION_GLSL
#define PHASE_FUNCTION_GLSL
#include "frame_interface.h"

const float kPi = 3.14159265358979;

// The phase function of Henyey and Greenstein 1941 per steradian, from the directions (unit vectors) of the light before and after
// scattering; it integrates to 1 over the sphere. 1 + g² - 2 g cos is computed without the difference of
// large terms.
float phaseFunction(float g, vec3 before, vec3 after) {
  const vec3 apart = after - sign(g) * before;
  const float width = (1.0 - abs(g)) * (1.0 - abs(g)) + abs(g) * dot(apart, apart);
  return (1.0 - g * g) / (4.0 * kPi * width * sqrt(width));
}

// Light that a surface scatters per steradian, in place of a phase function: Blinn and Phong, two-sided. All directions are in the world
// and of length 1.
float surfaceScattering(vec3 normal, vec3 toLight, vec3 toEye) {
  const vec3 between = toLight + toEye;
  const float facing = min(abs(dot(normal, between)) / max(length(between), 1e-6), 1.0);
  const float highlight = (kHighlightExponent + 1.0) / (8.0 * kPi) * pow(facing, kHighlightExponent);
  return (1.0 - kHighlight) * abs(dot(normal, toLight)) / (2.0 * kPi) + kHighlight * highlight;
}

#endif
