// The part of a footprint's line integral that is ahead of a point at -x, in half chords from the middle of the
// kernel's chord: the integral of (1 - t²)^(7/2) from -x to 1 over that from -1 to 1, to 1e-7.
#ifndef PART_AHEAD_GLSL
#define PART_AHEAD_GLSL

float partAhead(float x) {
  const float c = clamp(x, -1.0, 1.0), s = c * c;
  const float high = -0.03735495 + s * (-0.00848876 + s * (0.00475784 - s * 0.0032369));
  const float bend = 0.66410406 + s * (-0.69398808 + s * (0.32421521 + s * high));
  return max(0.5 + c * (0.5 + (1.0 - s) * bend), 0.0);
}

#endif
