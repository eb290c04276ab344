#include "engine/validation/sky_environment.h"

#include <cmath>
#include <numbers>

namespace freevoxels {

namespace {

constexpr glm::dvec3 kHorizon{0.75, 0.8, 0.9}, kZenith{0.2, 0.35, 0.75}, kGround{0.1, 0.09, 0.07};
constexpr glm::dvec3 kSun{420.0, 350.0, 250.0};

glm::dvec3 towards(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          std::cos(elevation) * std::cos(azimuth)};
}

}  // namespace

Environment makeSky(int height) {
  constexpr double kPi = std::numbers::pi;
  const glm::dvec3 sun = towards(glm::radians(kSkySunAzimuth), glm::radians(kSkySunElevation));
  Environment sky{.size = {2 * height, height}, .radiance = {}};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < 2 * height; ++column) {
      const glm::dvec3 direction =
          towards(kPi - kPi * (column + 0.5) / height, kPi / 2.0 - kPi * (row + 0.5) / height);
      glm::dvec3 radiance = direction.y < 0.0 ? kGround : glm::mix(kHorizon, kZenith, std::sqrt(direction.y));
      if (glm::dot(direction, sun) > std::cos(glm::radians(kSkySunRadius))) radiance += kSun;
      sky.radiance.emplace_back(radiance);
    }
  return sky;
}

}  // namespace freevoxels
