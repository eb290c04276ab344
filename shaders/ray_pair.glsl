// Where the depths of a pair of planes are. A face's rays may have more depths than 32 bits can number where only some are in memory.
#ifndef RAY_PAIR_GLSL
#define RAY_PAIR_GLSL
#include "interface.h"

// The device address of the pair's depths, one for each ray.
uvec2 pairAddress(FaceRays fan, int pair) {
  uint high, low, carry;
  umulExtended(uint(pair), 4 * uint(fan.rayCount.x * fan.rayCount.y), high, low);
  low = uaddCarry(fan.depths.x, low, carry);
  return uvec2(low, fan.depths.y + high + carry);
}

#endif
