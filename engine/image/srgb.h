#pragma once
// The transfer curve of sRGB, IEC 61966-2-1.

#include <cmath>

namespace freevoxels {

/// 0..1 to 0..1.
inline float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// 0..1 to 0..1.
inline float linearFromSrgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

}  // namespace freevoxels
