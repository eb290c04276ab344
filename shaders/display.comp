#version 460
// A frame's image as the bytes that a PNG of it has: exposure, tone map, background and sRGB. The same arithmetic as in
// engine/image/png.cpp, operation by operation.
#extension GL_GOOGLE_include_directive : require
#include "display_interface.h"

layout(local_size_x = kDisplayTile, local_size_y = kDisplayTile) in;
layout(scalar, push_constant) uniform Push { DisplayPush push; };
layout(binding = 0, rgba32f) readonly uniform image2D image;  // linear, premultiplied
layout(binding = 1, rgba8) writeonly uniform image2D shown;   // sRGB, straight alpha
layout(scalar, binding = 2) readonly buffer Srgb { SrgbBucket buckets[]; };

float filmicCurve(float x) {
  precise const float curve = (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
  return curve;
}

float toneMapped(float light) {
  precise float mapped = light;
  if (push.toneMap == kToneMapFilmic) mapped = filmicCurve(2.0 * light) / filmicCurve(11.2);
  if (push.toneMap == kToneMapAces)
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
  const SrgbBucket bucket = buckets[(bits - kSrgbFirstBits) >> kSrgbDroppedBits];
  return float(bucket.byte + (linear >= bucket.next ? 1u : 0u)) / 255.0;
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, push.size))) return;
  const vec4 light = imageLoad(image, pixel);
  precise const float down = (float(pixel.y) + 0.5) / float(push.size.y);
  vec3 mapped;
  for (int c = 0; c < 3; ++c) mapped[c] = toneMapped(push.gain * light[c]);
  const bool over = push.hasBackground != 0;
  float most = light.a;
  for (int c = 0; c < 3; ++c)
    if (!over && light[c] > most) most = light[c];  // not by max(), which may return NaN
  precise const float excess = push.gain * (most - light.a);
  precise const float needed = light.a + excess;
  const float alpha = clampUnit(push.gain == 1.0 ? most : needed);
  vec4 result = vec4(0.0, 0.0, 0.0, over ? 1.0 : alpha);
  for (int c = 0; c < 3; ++c) {
    precise const float behind = push.top[c] * (1.0 - down) + push.bottom[c] * down;
    precise const float composited = mapped[c] + (1.0 - alpha) * behind;
    precise const float straight = alpha > 0.0 ? mapped[c] / alpha : 0.0;
    result[c] = srgbUnit(clampUnit(over ? composited : straight));
  }
  imageStore(shown, pixel, result);
}
