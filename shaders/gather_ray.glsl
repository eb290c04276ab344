// The ray of a lattice sample and how it meets the slices across an axis. Requires gather_interface.h.
#ifndef GATHER_RAY_GLSL
#define GATHER_RAY_GLSL
#include "major_axis.glsl"

// The sample's position relative to the image's middle, in pixels: (1, x, y).
vec3 samplePosition(vec2 firstSample, float pitch, ivec2 index) { return vec3(1.0, firstSample + pitch * vec2(index)); }

#endif
