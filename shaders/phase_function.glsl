// Henyey and Greenstein 1941.
#ifndef PHASE_FUNCTION_GLSL
#define PHASE_FUNCTION_GLSL

const float kPi = 3.14159265358979;

// The phase function per steradian, from the directions (unit vectors) of the light before and after
// scattering; it integrates to 1 over the sphere. 1 + g² - 2 g cos is computed without the difference of
// large terms.
float phaseFunction(float g, vec3 before, vec3 after) {
  const vec3 apart = after - sign(g) * before;
  const float width = (1.0 - abs(g)) * (1.0 - abs(g)) + abs(g) * dot(apart, apart);
  return (1.0 - g * g) / (4.0 * kPi * width * sqrt(width));
}

#endif
