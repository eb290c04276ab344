// The part of a footprint's line integral that is ahead of a point at -x, in half chords from the middle of the
// kernel's chord: the integral of (1 - t²)^(7/2) from -x to 1 over that from -1 to 1, to 2e-6.
float partAhead(float x) {
  const float c = clamp(x, -1.0, 1.0), s = c * c;
  const float bend = 0.66409266 + s * (-0.69371367 + s * (0.32255806 + s * (-0.03413753 - s * 0.00871221)));
  return max(0.5 + c * (0.5 + (1.0 - s) * bend), 0.0);
}
