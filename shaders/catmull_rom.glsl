// Catmull-Rom interpolation of evenly spaced samples.
#ifndef CATMULL_ROM_GLSL
#define CATMULL_ROM_GLSL

// Weights of the samples at -1, 0, 1 and 2 for a position x in 0..1.
vec4 cubicWeights(float x) {
  return 0.5 * vec4(x * (-1.0 + x * (2.0 - x)), 2.0 + x * x * (-5.0 + 3.0 * x), x * (1.0 + x * (4.0 - 3.0 * x)),
                    x * x * (-1.0 + x));
}

#endif
