#include "engine/scene/sphere_quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/scene/directions.h"

namespace freevoxels {

namespace {

constexpr DirectionSet kSet = DirectionSet::Directions26;
constexpr std::size_t kMoments = 6;
using Moments = std::array<double, kMoments>;

/// The independent products of two components.
Moments momentsOf(const glm::dvec3& unit) {
  return {unit.x * unit.x, unit.y * unit.y, unit.z * unit.z, unit.x * unit.y, unit.x * unit.z, unit.y * unit.z};
}

/// Whether the columns are orthogonal and of equal length, up to rounding.
bool isCubic(const glm::dmat3& matrix) {
  const glm::dmat3 products = glm::transpose(matrix) * matrix;
  const double scale = products[0][0];
  double largest = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(products[i][j] - (i == j ? scale : 0.0)));
  return largest < 1e-5 * scale;
}

/// Solves a symmetric positive definite system by elimination.
Moments solve(std::array<Moments, kMoments> matrix, Moments right) {
  for (std::size_t i = 0; i < kMoments; ++i)
    for (std::size_t row = i + 1; row < kMoments; ++row) {
      const double factor = matrix[row][i] / matrix[i][i];
      for (std::size_t column = i; column < kMoments; ++column) matrix[row][column] -= factor * matrix[i][column];
      right[row] -= factor * right[i];
    }
  for (std::size_t i = kMoments; i-- > 0;) {
    for (std::size_t column = i + 1; column < kMoments; ++column) right[i] -= matrix[i][column] * right[column];
    right[i] /= matrix[i][i];
  }
  return right;
}

/// Makes the rule exact for second moments; even ones of degree 1 and 3 vanish, as opposite directions have equal weights.
void correctWeights(std::vector<QuadratureDirection>& directions) {
  std::array<Moments, kMoments> matrix{};
  Moments right{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0, 0.0, 0.0};
  for (const QuadratureDirection& direction : directions) {
    const Moments moments = momentsOf(direction.unit);
    for (std::size_t i = 0; i < kMoments; ++i) {
      right[i] -= direction.weight * moments[i];
      for (std::size_t j = 0; j < kMoments; ++j) matrix[i][j] += direction.weight * moments[i] * moments[j];
    }
  }
  const Moments factors = solve(matrix, right);
  std::vector<double> weights;
  for (const QuadratureDirection& direction : directions) {
    const Moments moments = momentsOf(direction.unit);
    double change = 0.0;
    for (std::size_t i = 0; i < kMoments; ++i) change += factors[i] * moments[i];
    weights.push_back(direction.weight * (1.0 + change));
  }
  if (!std::ranges::all_of(weights, [](double weight) { return weight > 0.0; })) return;
  for (std::size_t i = 0; i < directions.size(); ++i) directions[i].weight = weights[i];
}

}  // namespace

std::vector<QuadratureDirection> sphereQuadrature(const glm::dmat4& indexToWorld) {
  const glm::dmat3 toWorld(indexToWorld);
  const bool cubic = isCubic(toWorld);
  const std::vector<double> shares = cubic ? std::vector<double>() : directionShares(kSet, indexToWorld);
  std::vector<QuadratureDirection> directions;
  for (int i = 0; i < directionCount(kSet); ++i) {
    const glm::ivec3 step = directionCell(kSet, i);
    const glm::dvec3 way = toWorld * glm::dvec3(step);
    constexpr std::array<double, 4> kLebedev{0.0, 1.0 / 21.0, 4.0 / 105.0, 9.0 / 280.0};  // by the number of axes
    const int axes = std::abs(step.x) + std::abs(step.y) + std::abs(step.z);
    directions.push_back({.step = step,
                          .unit = glm::normalize(way),
                          .length = glm::length(way),
                          .weight = cubic ? kLebedev[std::size_t(axes)] : shares[std::size_t(i)]});
  }
  if (!cubic) correctWeights(directions);
  return directions;
}

std::vector<glm::dvec3> surroundingRadiances(const Lighting& lighting, std::span<const QuadratureDirection> directions,
                                             const glm::dmat4& indexToWorld) {
  std::vector<glm::dvec3> sky(directions.size(), lighting.ambient);
  if (!lighting.environment) return sky;
  const std::vector<glm::dvec3> around = directionRadiances(*lighting.environment, kSet, indexToWorld);
  const std::vector<double> shares = directionShares(kSet, indexToWorld);
  glm::dvec3 mean(0.0), ofRule(0.0);
  for (std::size_t i = 0; i < sky.size(); ++i) {
    mean += shares[i] * around[i];
    ofRule += directions[i].weight * around[i];
  }
  for (std::size_t i = 0; i < sky.size(); ++i)  // light from a direction travels along the opposite one
    sky[sky.size() - 1 - i] += around[i] * glm::mix(mean / ofRule, glm::dvec3(1.0), glm::equal(ofRule, glm::dvec3(0.0)));
  return sky;
}

}  // namespace freevoxels
