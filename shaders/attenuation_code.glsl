// The two codes of a table byte; engine/scene/directions.cpp has them in double precision.
#ifndef ATTENUATION_CODE_GLSL
#define ATTENUATION_CODE_GLSL
#include "interface.h"

uint encodeDepth(int code, float depth) {
  return code == kCodeDepth8 ? uint(sqrt(min(depth, kMaximumDepth)) * (255.0 / sqrt(kMaximumDepth)) + 0.5)
                             : uint(255.0 * exp(-depth) + 0.5);
}

float decodeDepth(int code, uint byte) {
  const float fraction = float(byte) * (1.0 / 255.0);
  if (code == kCodeDepth8) return kMaximumDepth * fraction * fraction;
  return byte == 0 ? kOpaqueDepth : -log(fraction);
}

// A bound in half a byte: never darker than the code itself. For linear8 only the bound 0 hides anything.
uint packBound(int code, uint byte) { return code == kCodeDepth8 ? byte / 16 : min((byte + 15) / 16, 15); }
uint unpackBound(uint byte, int place) { return 16 * bitfieldExtract(byte, 4 * place, 4); }

#endif
