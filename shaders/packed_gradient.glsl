// Gradients in 4 bytes: three signed components of 9 bits with a shared exponent.
#ifndef PACKED_GRADIENT_GLSL
#define PACKED_GRADIENT_GLSL

const float kMantissas = 255.0;
const int kMinExponent = -16;  // smaller gradients become 0

uint packGradient(vec3 gradient) {
  const float most = max(max(abs(gradient.x), abs(gradient.y)), abs(gradient.z));
  const int exponent = most > 0.0 ? clamp(int(ceil(log2(most))), kMinExponent, kMinExponent + 31) : kMinExponent;
  const ivec3 parts = ivec3(round(clamp(gradient * exp2(float(-exponent)), -1.0, 1.0) * kMantissas)) & 0x1ff;
  return uint(parts.x | parts.y << 9 | parts.z << 18 | (exponent - kMinExponent) << 27);
}

vec3 unpackGradient(uint bits) {
  const ivec3 parts = ivec3(bitfieldExtract(int(bits), 0, 9), bitfieldExtract(int(bits), 9, 9), bitfieldExtract(int(bits), 18, 9));
  return vec3(parts) * (exp2(float(int(bits >> 27) + kMinExponent)) / kMantissas);
}

#endif
