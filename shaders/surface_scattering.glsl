// Light that a surface scatters, in place of a phase function: Blinn and Phong, two-sided.
#ifndef SURFACE_SCATTERING_GLSL
#define SURFACE_SCATTERING_GLSL
#include "frame_interface.h"
#include "phase_function.glsl"

// Per steradian; all directions are in the world and of length 1.
float surfaceScattering(vec3 normal, vec3 toLight, vec3 toEye) {
  const vec3 between = toLight + toEye;
  const float facing = min(abs(dot(normal, between)) / max(length(between), 1e-6), 1.0);
  const float highlight = (kHighlightExponent + 1.0) / (8.0 * kPi) * pow(facing, kHighlightExponent);
  return (1.0 - kHighlight) * abs(dot(normal, toLight)) / (2.0 * kPi) + kHighlight * highlight;
}

#endif
