// Light and albedos in 4 bytes: 9 bits a component with a shared exponent (VK_FORMAT_E5B9G9R9_UFLOAT_PACK32).
// The error of a component is at most 1/512 of the largest component. The unit of light is such that the
// brightest voxel has kBrightest (engine/volume/packed_light.h).
#ifndef PACKED_LIGHT_GLSL
#define PACKED_LIGHT_GLSL

vec3 unpackLight(uint bits) {
  const uvec3 parts = uvec3(bits, bits >> 9, bits >> 18) & 511u;
  // 2^(exponent - 24) made of its bits, because ldexp is slow on lavapipe.
  return uintBitsToFloat(((bits >> 27) + 103u) << 23) * vec3(parts);
}

// Packs components in 0..kBrightest.
uint packLight(vec3 light) {
  const float largest = max(light.r, max(light.g, light.b));
  int exponent = max(int(floatBitsToUint(largest) >> 23) - 127, -16) + 1;
  if (uint(ldexp(largest, 9 - exponent) + 0.5) == 512u) ++exponent;
  const uvec3 parts = uvec3(ldexp(light, ivec3(9 - exponent)) + 0.5);
  return parts.r | parts.g << 9 | parts.b << 18 | uint(exponent + 15) << 27;
}

#endif
