// The two codes of a table byte; engine/attenuation/directions.cpp has them in double precision.

uint encodeDepth(int code, float depth) {
  return code == kCodeDepth8 ? uint(sqrt(min(depth, kMaximumDepth)) * (255.0 / sqrt(kMaximumDepth)) + 0.5)
                             : uint(255.0 * exp(-depth) + 0.5);
}

float decodeDepth(int code, uint byte) {
  const float fraction = float(byte) * (1.0 / 255.0);
  if (code == kCodeDepth8) return kMaximumDepth * fraction * fraction;
  return byte == 0 ? kOpaqueDepth : -log(fraction);
}
