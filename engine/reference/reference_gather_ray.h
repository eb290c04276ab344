#pragma once
// What the parts of ReferenceGather share: a ray's way through the slices of a level, and the values on a slice.

#include <array>
#include <cmath>

#include "engine/reference/reference_gather.h"

namespace freevoxels {

inline std::array<int, 2> sidesOf(int axis) {
  return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
}

inline glm::dvec2 onSides(glm::dvec3 v, int axis) {
  const std::array<int, 2> sides = sidesOf(axis);
  return {v[sides[0]], v[sides[1]]};
}

/// (1 - exp(-x)) / x for x of either sign.
inline double meanTransmittance(double x) {
  return std::abs(x) < 1e-6 ? 1.0 - 0.5 * x : -std::expm1(-x) / x;
}

/// Calls `add(corner, weight, block)` with the bilinear weights of those of the four blocks around a position on a slice that are in the
/// volume. The second side's corners follow the first's.
template <typename Add>
void forCorners(glm::dvec2 position, int axis, int slice, glm::ivec3 dimensions, const Add& add) {
  const std::array<int, 2> sides = sidesOf(axis);
  const glm::dvec2 low = glm::floor(position), part = position - low;
  for (int corner = 0; corner < 4; ++corner) {
    const glm::dvec2 side(corner & 1, corner >> 1 & 1), shares = glm::mix(1.0 - part, part, side);
    glm::ivec3 block;
    block[axis] = slice;
    block[sides[0]] = int(low.x + side.x);
    block[sides[1]] = int(low.y + side.y);
    const bool within = glm::all(glm::greaterThanEqual(block, glm::ivec3(0))) && glm::all(glm::lessThan(block, dimensions));
    if (within) add(std::size_t(corner), shares.x * shares.y, block);
  }
}

inline std::size_t indexOf(glm::ivec3 block, glm::ivec3 dimensions) {
  return std::size_t(block.x) + std::size_t(dimensions.x) * (std::size_t(block.y) + std::size_t(dimensions.y) * std::size_t(block.z));
}

/// The slices of a level that a ray's march reads: `first` to `end` - 1 in the order of the march.
struct ReferenceGather::Slab {
  int axis = 0, sign = 1;
  double edge = 1.0;  ///< edge of a block in voxels
  int first = 0, count = 0;

  int slice(int number) const { return first + sign * number; }
  /// The distance of the ray's intersection with the middle of a slice.
  double distance(const Ray& ray, double slice) const {
    return ((slice + 0.5) * edge - 0.5 - ray.origin[axis]) / ray.direction[axis];
  }
  /// The position of that intersection on the sides, in blocks.
  glm::dvec2 position(const Ray& ray, double slice) const {
    return (onSides(ray.origin + distance(ray, slice) * ray.direction, axis) + 0.5) / edge - 0.5;
  }
  /// World length of the ray between two slices.
  double layer(const Ray& ray) const { return edge * ray.worldLength / std::abs(ray.direction[axis]); }
  /// Distance from the eye plane in slices, negative behind it.
  double ahead(const Ray& ray, double slice) const { return distance(ray, slice) * std::abs(ray.direction[axis]) / edge; }
};

/// The scalar at a place of a ray, in intervals of the transfer function's table.
struct ReferenceGather::Scalar {
  double coverage = 0.0;  ///< by voxels with data
  double value = 0.0;
};

/// What a ray meets between two slices of scalars.
struct ReferenceGather::ScalarStretch {
  int slice = 0;  ///< the second of them
  Scalar begin, middle, end;
  std::array<glm::dvec4, 2> means{};      ///< source term and extinction of its halves
  std::array<double, 2> coverages{};      ///< of the halves, as far as they are in front of the eye
  /// Where an end has no data, the other one's scalar.
  const Scalar& first() const { return begin.coverage > 0.0 ? begin : end; }
  const Scalar& second() const { return end.coverage > 0.0 ? end : begin; }
};

}  // namespace freevoxels
