#pragma once
// Which cells of a volume a ray of the gather meets anything in, found on the host from ranges of the voxels' values.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// A byte for each cell of a box, x fastest.
struct Cells {
  glm::ivec3 dimensions{0};
  std::vector<std::uint8_t> values;

  explicit Cells(glm::ivec3 size)
      : dimensions(size), values(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z)) {}
  /// Of y and z.
  glm::ivec2 strides() const { return {dimensions.x, dimensions.x * dimensions.y}; }
  std::size_t index(glm::ivec3 cell) const {
    return std::size_t(cell.x) +
           std::size_t(dimensions.x) * (std::size_t(cell.y) + std::size_t(dimensions.y) * std::size_t(cell.z));
  }
  std::uint8_t at(glm::ivec3 cell) const { return values[index(cell)]; }
};

/// 1 where the cell of `edge` voxels along each axis has a voxel with a density above `density`, or with emission. With a transfer function, where
/// a scalar interpolated from c * edge to (c + 1) * edge, both included, may have extinction: such scalars lie between those
/// of the voxels there.
Cells metCells(const Volume& volume, const Classification& classification, int edge, float density = 0.0f);

/// Cells of twice the edge: 1 where any of the eight is.
Cells coarserCells(const Cells& cells);

/// 1 where the cell, or one of its neighbours from `low` to `high` along each axis, is.
Cells spread(const Cells& cells, int low, int high);

/// Groups of slices, from a position in a cell or its next neighbours on, in which no cell of `met` is met, at most 8; 0
/// where `met` is 1. Such a ray moves by a cell a group and is in two at first.
Cells groupsToSkip(const Cells& met);

}  // namespace freevoxels
