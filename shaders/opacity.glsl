// 1 - exp(-x), accurate for small x.
#ifndef OPACITY_GLSL
#define OPACITY_GLSL

float opacityOf(float x) { return x < 0.02 ? x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0))) : 1.0 - exp(-x); }

#endif
