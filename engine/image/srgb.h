#pragma once
// The transfer curve of sRGB, IEC 61966-2-1.

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "shaders/display_interface.h"

namespace freevoxels {

/// The luminance of linear Rec.709, whose primaries sRGB has: Y = dot(kLuminance, rgb).
inline constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

/// 0..1 to 0..1.
inline float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// 0..1 to 0..1.
inline float linearFromSrgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

/// Maps 0..1 to 0..255, rounded to nearest, halves up. std::lround would be a function call for every value.
inline std::uint8_t byteFromUnit(float unit) {
  const float scaled = 255.0f * unit;
  const int whole = int(scaled);
  return std::uint8_t(whole + int(scaled - float(whole) >= 0.5f));
}

/// The table of srgbByteFromLinear, for shaders too; display_interface.h describes its layout.
std::span<const std::uint32_t> srgbBuckets();

/// Equals byteFromUnit(srgbFromLinear(linear)) for 0..1. `buckets` are srgbBuckets().
inline std::uint8_t srgbByteFromLinear(std::span<const std::uint32_t> buckets, float linear) {
  const auto bits = std::bit_cast<std::uint32_t>(linear);
  if (bits < shader::kSrgbFirstBits) return 0;
  if (bits >= shader::kSrgbEndBits) return 255;
  const std::uint32_t bucket = buckets[(bits - shader::kSrgbFirstBits) >> shader::kSrgbDroppedBits];
  const bool isNext = (bits & shader::kSrgbDroppedMask) >= (bucket & shader::kSrgbNextMask);
  return std::uint8_t((bucket >> shader::kSrgbByteShift) + std::uint32_t(isNext));
}
inline std::uint8_t srgbByteFromLinear(float linear) {
  return srgbByteFromLinear(srgbBuckets(), linear);
}

}  // namespace freevoxels
