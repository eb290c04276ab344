#include "apps/view/light_edits.h"

#include <algorithm>
#include <cmath>

#include "apps/view/transfer_model.h"

namespace freevoxels {

namespace {

/// As many digits as a hand is exact.
glm::dvec3 rounded(glm::dvec3 value, double steps) {
  return glm::round(value * steps) / steps;
}

}  // namespace

void dropIdleOptions(LightingDescription& options) {
  if (options.lights.empty()) {
    options.attenuation.reset();
    options.phaseG.reset();
    options.shading.reset();
    options.surface.reset();
  }
  if (options.shading == Shading::Scatter) options.surface.reset();
  if (!options.environment) {
    options.environmentRotation.reset();
    options.environmentIntensity.reset();
  }
  if (options.lights.empty() && !options.ambient && !options.environment) options.tint.reset();
}

glm::dvec2 anglesOf(glm::dvec3 direction) {
  const glm::dvec3 unit = glm::normalize(direction);
  return glm::degrees(glm::dvec2(std::atan2(unit.x, unit.z), std::asin(std::clamp(unit.y, -1.0, 1.0))));
}

glm::dvec3 directionOf(glm::dvec2 angles) {
  const double azimuth = glm::radians(angles.x), elevation = glm::radians(angles.y);
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

glm::dvec3 directionOnBall(glm::dvec2 place) {
  const double distance = glm::length(place);
  const double radius = distance <= 1.0 ? distance : std::max(2.0 - distance, 0.0);
  const glm::dvec2 across = distance > 0.0 ? place * (radius / distance) : place;
  const double depth = std::sqrt(std::max(1.0 - radius * radius, 0.0));
  return {across, distance <= 1.0 ? depth : -depth};
}

LightingDescription::GivenLight newLight(const Camera& camera, const Volume& volume, bool atInfinity, std::size_t others) {
  const double fill = atInfinity ? 0.15 : 0.05;  // a point light is near
  const double side = others % 2 == 0 ? -0.5 : 0.5;
  const glm::dvec3 fromAbove = glm::transpose(glm::dmat3(worldToCamera(camera))) * glm::normalize(glm::dvec3(side, 0.7, 0.5));
  LightingDescription::GivenLight given{.light = {.atInfinity = atInfinity}};
  if (atInfinity) {
    constexpr double kSteps = 1e3;
    given.light.place = rounded(fromAbove, kSteps);
  } else {
    constexpr double kBeyondBox = 1.1;  // not far, so that its handle is in the image
    const glm::dvec3 half = 0.5 * glm::dvec3(volume.dimensions), middle = half - 0.5;
    const glm::dvec3 inVoxels = glm::abs(glm::inverse(glm::dmat3(volume.indexToWorld)) * fromAbove),
                     ways = half / glm::max(inVoxels, 1e-12);
    const double steps = std::pow(10.0, 3.0 - std::floor(std::log10(halfDiagonal(volume))));
    given.light.place = rounded(
        glm::dvec3(volume.indexToWorld * glm::dvec4(middle, 1.0)) + kBeyondBox * std::min({ways.x, ways.y, ways.z}) * fromAbove, steps);
  }
  if (others > 0) {  // the others light the volume well by themselves
    given.hasIntensity = true;
    const double intensity = fill * defaultIntensity(given.light, volume);
    given.light.intensity = roundedTo(intensity, std::pow(10.0, std::floor(std::log10(intensity)) - 2.0));
  }
  return given;
}

double halfDiagonal(const Volume& volume) {
  return 0.5 * glm::length(glm::dmat3(volume.indexToWorld) * glm::dvec3(volume.dimensions));
}

}  // namespace freevoxels
