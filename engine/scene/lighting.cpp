#include "engine/scene/lighting.h"

#include <algorithm>
#include <cmath>

namespace freevoxels {

namespace {

/// Number of sample points along the edge of a quad between four directions. The midpoint rule then has an
/// error of 1e-5 of a fraction.
constexpr int kQuadParts = 32;

}  // namespace

double phaseFunction(double g, double cosine) {
  const double width = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (4.0 * std::numbers::pi * width * std::sqrt(width));
}

PhaseSplit splitPhase(const Lighting& lighting) {
  const double g = lighting.phaseG;
  if (g <= 0.0 || lighting.scattering == 1) return {.forward = 0.0, .g = g};
  return {.forward = g * g, .g = g / (1.0 + g)};
}

double surfaceScattering(glm::dvec3 normal, glm::dvec3 toLight, glm::dvec3 toEye) {
  const double diffuse = std::abs(glm::dot(normal, toLight)) / (2.0 * std::numbers::pi);
  const glm::dvec3 between = toLight + toEye;
  const double length = glm::length(between);
  const double facing = length > 1e-6 ? std::abs(glm::dot(normal, between)) / length : 0.0;
  const double highlight =
      (kHighlightExponent + 1.0) / (8.0 * std::numbers::pi) * std::pow(facing, kHighlightExponent);
  return (1.0 - kHighlight) * diffuse + kHighlight * highlight;
}

double surfaceShare(double relativeChange) {
  return std::min(2.0 * relativeChange, 1.0);
}

RaySource lightSource(const Light& light, const glm::dmat4& indexToWorld) {
  const glm::dvec4 place(light.place, light.atInfinity ? 0.0 : 1.0);
  return {.place = glm::dvec3(glm::inverse(indexToWorld) * place), .atInfinity = light.atInfinity};
}

std::vector<double> directionShares(DirectionSet set, const glm::dmat4& indexToWorld) {
  const glm::dmat3 toWorld(indexToWorld);
  std::vector<double> shares(std::size_t(directionCount(set)), 0.0);
  double whole = 0.0;
  const int parts = 2 * int(set) * kQuadParts;  // sample points along an edge of the cube
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < parts; ++j)
      for (int i = 0; i < parts; ++i) {
        glm::dvec3 point;
        point[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
        point[(face / 2 + 1) % 3] = (2.0 * i + 1.0) / parts - 1.0;
        point[(face / 2 + 2) % 3] = (2.0 * j + 1.0) / parts - 1.0;
        // Solid angle of a part of the cube's face, up to the determinant, which is the same for all parts.
        const double angle = std::pow(glm::length(toWorld * point), -3.0);
        const DirectionBlend blend = bilinearDirections(set, point);
        for (std::size_t k = 0; k < blend.directions.size(); ++k)
          shares[std::size_t(blend.directions[k])] += angle * blend.weights[k];
        whole += angle;
      }
  for (double& share : shares) share /= whole;
  return shares;
}

}  // namespace freevoxels
