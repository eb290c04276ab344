#version 460
// A frame's image as the bytes that a PNG of it has: exposure, tone map, background and sRGB. The same arithmetic as in
// engine/image/display.cpp, operation by operation.
#extension GL_GOOGLE_include_directive : require
#include "display_interface.h"

layout(constant_id = 0) const int kToneMap = kToneMapNone;
layout(constant_id = 1) const bool kHasBackground = false;

layout(binding = 0, rgba32f) readonly uniform image2D image;  // linear, premultiplied
layout(scalar, binding = 1) readonly buffer Srgb { uint buckets[]; };
// Of display.vert: DisplayPush.
layout(location = 0) flat in float gain;
layout(location = 1) flat in float height;
layout(location = 2) flat in vec3 top;
layout(location = 3) flat in vec3 bottom;
layout(location = 0) out vec4 shown;  // sRGB, straight alpha

float filmicCurve(float x) {
  precise const float curve = (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
  return curve;
}

float toneMapped(float light) {
  precise float mapped = light;
  if (kToneMap == kToneMapFilmic) mapped = filmicCurve(2.0 * light) / filmicCurve(11.2);
  if (kToneMap == kToneMapAces)
    mapped = light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
  return mapped;
}

// 0 for NaN.
float clampUnit(float value) {
  return value > 0.0 ? min(value, 1.0) : 0.0;
}

float srgbUnit(float linear) {
  const uint bits = floatBitsToUint(linear);
  if (bits < kSrgbFirstBits) return 0.0;
  if (bits >= kSrgbEndBits) return 1.0;
  const uint bucket = buckets[(bits - kSrgbFirstBits) >> kSrgbDroppedBits];
  const bool isNext = (bits & kSrgbDroppedMask) >= (bucket & kSrgbNextMask);
  return float((bucket >> kSrgbByteShift) + (isNext ? 1u : 0u)) / 255.0;
}

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec4 light = imageLoad(image, pixel);
  precise const float down = (float(pixel.y) + 0.5) / height;
  vec3 mapped;
  for (int c = 0; c < 3; ++c) mapped[c] = toneMapped(gain * light[c]);
  float most = light.a;
  for (int c = 0; c < 3; ++c)
    if (!kHasBackground && light[c] > most) most = light[c];  // not by max(), which may return NaN
  precise const float excess = gain * (most - light.a);
  precise const float needed = light.a + excess;
  const float alpha = clampUnit(gain == 1.0 ? most : needed);
  vec4 result = vec4(0.0, 0.0, 0.0, kHasBackground ? 1.0 : alpha);
  for (int c = 0; c < 3; ++c) {
    precise const float behind = top[c] * (1.0 - down) + bottom[c] * down;
    precise const float composited = mapped[c] + (1.0 - alpha) * behind;
    precise const float straight = alpha > 0.0 ? mapped[c] / alpha : 0.0;
    result[c] = srgbUnit(clampUnit(kHasBackground ? composited : straight));
  }
  shown = result;
}
