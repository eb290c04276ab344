#pragma once
// Light and albedos in 4 bytes: shaders/packed_light.glsl.

#include <algorithm>
#include <cstdint>
#include <glm/gtc/packing.hpp>

namespace freevoxels {

/// Of the brightest voxel's components, in the units that are stored.
inline constexpr double kBrightest = 32768.0;
/// The same of what is left out: a thousand such voxels on a ray are a sixtieth of one of the brightest.
inline constexpr double kFaintest = kBrightest / (1 << 16);

/// Components from 0 to kBrightest.
inline std::uint32_t packColor(glm::dvec3 color) {
  return glm::packF3x9_E1x5(glm::vec3(color));
}
/// 0 of what is fainter than kFaintest.
inline std::uint32_t packLight(glm::dvec3 light) {
  return std::max({light.r, light.g, light.b}) < kFaintest ? 0 : packColor(light);
}
inline glm::dvec3 unpackColor(std::uint32_t bits) {
  return glm::unpackF3x9_E1x5(bits);
}

}  // namespace freevoxels
