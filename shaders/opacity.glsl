// 1 - exp(-x) and its inverse, -log(1 - opacity), accurate for small values.
#ifndef OPACITY_GLSL
#define OPACITY_GLSL

float opacityOf(float x) { return x < 0.02 ? x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0))) : 1.0 - exp(-x); }

float opticalDepthOf(float opacity) {
  return opacity < 0.02 ? opacity * (1.0 + opacity * (1.0 / 2.0 + opacity * (1.0 / 3.0))) : -log(1.0 - opacity);
}

#endif
