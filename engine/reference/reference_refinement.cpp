#include "engine/reference/reference_refinement.h"

#include <array>
#include <cmath>

namespace freevoxels {

namespace {

constexpr double kDarkest = 1.0 / 256.0;

glm::dvec4 valuesOf(const GatherSums& sums) {
  return {sums.color, sums.energy};
}

double meanDistance(const GatherSums& sums) {
  return sums.energy > 0.0 ? sums.distance / sums.energy : 0.0;
}

double largestComponent(glm::dvec4 values) {
  return std::max({values.x, values.y, values.z, values.w});
}

/// The cubic through four evenly spaced values, in their middle.
glm::dvec4 middle(const std::array<glm::dvec4, 4>& values) {
  return (9.0 * (values[1] + values[2]) - values[0] - values[3]) / 16.0;
}

}  // namespace

ReferenceRefinement::ReferenceRefinement(const std::vector<GatherSums>& samples, glm::ivec2 extent)
    : samples_(samples), extent_(extent), coarseExtent_((extent + 1) / 2) {
  for (int y = 0; y < coarseExtent_.y; ++y)
    for (int x = 0; x < coarseExtent_.x; ++x) {
      const ReferenceRoughness row = roughnessAlong({x, y}, {1, 0}), column = roughnessAlong({x, y}, {0, 1});
      roughness_.push_back({.color = std::max(row.color, column.color), .distance = std::max(row.distance, column.distance)});
    }
}

const GatherSums& ReferenceRefinement::coarse(glm::ivec2 at) const {
  const glm::ivec2 place = 2 * glm::clamp(at, glm::ivec2(0), coarseExtent_ - 1);
  return samples_[std::size_t(place.x) + std::size_t(place.y) * std::size_t(extent_.x)];
}

ReferenceRoughness ReferenceRefinement::roughnessAlong(glm::ivec2 at, glm::ivec2 next) const {
  std::array<GatherSums, 5> sums;
  std::array<glm::dvec4, 5> values;
  glm::dvec4 largest(kDarkest);
  for (int i = 0; i < 5; ++i) {
    sums[std::size_t(i)] = coarse(at + (i - 2) * next);
    values[std::size_t(i)] = valuesOf(sums[std::size_t(i)]);
    largest = glm::max(largest, values[std::size_t(i)]);
  }
  const glm::dvec4 fourth = values[0] - 4.0 * values[1] + 6.0 * values[2] - 4.0 * values[3] + values[4];
  const double alpha = std::min({sums[1].energy, sums[2].energy, sums[3].energy});
  const double second = meanDistance(sums[1]) - 2.0 * meanDistance(sums[2]) + meanDistance(sums[3]);
  return {.color = largestComponent(glm::abs(fourth) / glm::sqrt(largest)), .distance = alpha > 0.0 ? alpha * std::abs(second) : 0.0};
}

std::optional<double> ReferenceRefinement::roughnessOfCell(glm::ivec2 sample, double tolerance, double distanceTolerance) const {
  const glm::ivec2 cell = sample / 2;
  if (sample == 2 * cell || glm::any(glm::greaterThanEqual(cell, coarseExtent_ - 1))) return {};
  double largest = 0.0;
  for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
    const glm::ivec2 at = cell + corner;
    largest = std::max(largest,
                       roughness_[std::size_t(at.x) + std::size_t(at.y) * std::size_t(coarseExtent_.x)].of(tolerance, distanceTolerance));
  }
  return largest;
}

GatherSums ReferenceRefinement::interpolated(glm::ivec2 sample) const {
  const glm::ivec2 cell = sample / 2, between = sample - 2 * cell;  // 1 along the axes on which the sample is between coarse ones
  const auto alongX = [&](int y) {
    std::array<glm::dvec4, 4> row;
    for (int i = 0; i < 4; ++i) row[std::size_t(i)] = valuesOf(coarse({cell.x + i - 1, y}));
    return between.x == 1 ? middle(row) : row[1];
  };
  glm::dvec4 values = alongX(cell.y);
  if (between.y == 1) {
    std::array<glm::dvec4, 4> column;
    for (int j = 0; j < 4; ++j) column[std::size_t(j)] = alongX(cell.y + j - 1);
    values = middle(column);
  }
  values = glm::max(values, glm::dvec4(0.0));
  double energy = 0.0, distance = 0.0;  // sums of the nearest coarse samples
  for (int j = 0; j <= between.y; ++j)
    for (int i = 0; i <= between.x; ++i) {
      energy += coarse(cell + glm::ivec2(i, j)).energy;
      distance += coarse(cell + glm::ivec2(i, j)).distance;
    }
  if (energy <= 0.0) return {.color = glm::dvec3(values), .energy = 0.0, .distance = 0.0};
  return {.color = glm::dvec3(values), .energy = values.w, .distance = values.w * distance / energy};
}

}  // namespace freevoxels
