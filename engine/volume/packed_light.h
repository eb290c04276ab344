#pragma once
// Light and albedos packed into 4 bytes (shaders/packed_light.glsl).

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/gtc/packing.hpp>

namespace freevoxels {

/// The largest component of the brightest voxel, in stored units.
inline constexpr double kBrightest = 32768.0;
/// Light below this is stored as 0: a thousand such voxels on a ray are a sixtieth of one of the brightest.
inline constexpr double kFaintest = kBrightest / (1 << 16);

/// Packs components from 0 to kBrightest. Returns the same bits as glm::packF3x9_E1x5 in a fifth of the time,
/// without logarithms and powers.
inline std::uint32_t packColor(glm::dvec3 color) {
  const glm::vec3 parts(color);
  const float largest = std::max({parts.r, parts.g, parts.b});
  const int floorOfLog2 = int(std::bit_cast<std::uint32_t>(largest) >> 23) - 127;
  int exponent = std::max(floorOfLog2, -16) + 16;  // stored
  const auto scale = [&] { return std::bit_cast<float>(std::uint32_t(127 + 24 - exponent) << 23); };
  if (largest * scale() + 0.5f >= 512.0f) ++exponent;
  const glm::uvec3 bits(parts * scale() + 0.5f);
  return bits.r | bits.g << 9 | bits.b << 18 | std::uint32_t(exponent) << 27;
}
/// Packs light; light fainter than kFaintest becomes 0.
inline std::uint32_t packLight(glm::dvec3 light) {
  return std::max({light.r, light.g, light.b}) < kFaintest ? 0 : packColor(light);
}
inline glm::dvec3 unpackColor(std::uint32_t bits) {
  return glm::unpackF3x9_E1x5(bits);
}

}  // namespace freevoxels
