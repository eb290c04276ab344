// Where the depths of a pair of planes are among those of a face's rays, whose number may exceed 32 bits where only some of them are
// in memory.
#ifndef RAY_PAIR_GLSL
#define RAY_PAIR_GLSL
#include "interface.h"

// Device address; of the depth of each ray.
uvec2 pairAddress(FaceRays fan, int pair) {
  uint high, low, carry;
  umulExtended(uint(pair), 4 * uint(fan.rayCount.x * fan.rayCount.y), high, low);
  low = uaddCarry(fan.depths.x, low, carry);
  return uvec2(low, fan.depths.y + high + carry);
}

#endif
