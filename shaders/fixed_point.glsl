// 64-bit fixed point in two words, low and high, in two's complement: integers that are added exactly, in any order.
#ifndef FIXED_POINT_GLSL
#define FIXED_POINT_GLSL
#include "share_interface.h"

// |x| 2^digits, rounded to the nearest integer: the float's 24 bits of mantissa are shifted, so that nothing is rounded that is at least
// 2^(23 - digits). At most 2^kSumBits - 1; `fits` becomes false beyond.
uvec2 fixedPoint(float x, int digits, inout bool fits) {
  const uint bits = floatBitsToUint(abs(x));
  if (bits < 0x00800000u) return uvec2(0);  // 0, and what has less than 24 bits
  const uint mantissa = (bits & 0x007fffffu) | 0x00800000u;
  const int shift = int(bits >> 23) - 150 + digits;
  if (shift < -24) return uvec2(0);
  if (shift < 0) return uvec2((mantissa + (1u << (-shift - 1))) >> -shift, 0);
  if (shift == 0) return uvec2(mantissa, 0);
  if (shift <= kSumBits - 24) return uvec2(mantissa << shift, mantissa >> (32 - shift));
  fits = false;
  return uvec2(0xffffffffu, (1u << (kSumBits - 32)) - 1);
}

// sum + x 2^digits
uvec2 addFixed(uvec2 sum, float x, int digits, inout bool fits) {
  uvec2 value = fixedPoint(x, digits, fits);
  uint carry;
  if (x < 0.0) {
    value.x = uaddCarry(~value.x, 1u, carry);
    value.y = ~value.y + carry;
  }
  sum.x = uaddCarry(sum.x, value.x, carry);
  sum.y += value.y + carry;
  return sum;
}

#endif
