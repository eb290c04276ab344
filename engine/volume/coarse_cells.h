#pragma once
// Coarse cells of a volume, with which rays of the gather skip empty space. Computed on the host from the
// range of the voxels' values.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// A byte for each cell of a box of cells, x fastest.
struct Cells {
  glm::ivec3 dimensions{0};
  std::vector<std::uint8_t> values;

  explicit Cells(glm::ivec3 size)
      : dimensions(size), values(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z)) {}
  /// Distances in `values` between neighbours along y and z.
  glm::ivec2 strides() const { return {dimensions.x, dimensions.x * dimensions.y}; }
  std::size_t index(glm::ivec3 cell) const {
    return std::size_t(cell.x) +
           std::size_t(dimensions.x) * (std::size_t(cell.y) + std::size_t(dimensions.y) * std::size_t(cell.z));
  }
  std::uint8_t at(glm::ivec3 cell) const { return values[index(cell)]; }
};

/// Marks with 1 the cells of `edge` voxels along each axis that contain a voxel with a density above
/// `density` or with emission. With a transfer function, marks the cells in which a scalar interpolated
/// between c * edge and (c + 1) * edge, both included, may have extinction: interpolated scalars lie between
/// those of the voxels. If voxels are classified before interpolation, their extinction depends on their neighbours (VoxelClassifier), so
/// that the interpolated scalars begin one voxel earlier.
Cells metCells(const Volume& volume, const Classification& classification, int edge, float density = 0.0f);

/// The ranges of the scalars in the cells that have some, of the voxels by which metCells() decides for a volume that is classified after
/// interpolation. They do not depend on the transfer function.
struct CellRanges {
  struct Cell {
    std::uint32_t index;  ///< Cells::index()
    float low, high;
  };
  glm::ivec3 dimensions{0};  ///< number of cells along the axes
  std::vector<Cell> cells;
};
CellRanges scalarRanges(const Volume& volume, int edge);
/// metCells() of cells of these ranges, for `volume` classified by the function after interpolation.
Cells metCells(const CellRanges& ranges, const Volume& volume, const TransferFunction& function);

/// Cells of twice the edge, 1 if any of their eight cells is 1.
Cells coarserCells(const Cells& cells);

/// Marks with 1 the cells of which any neighbour at offsets `low` to `high` along each axis is 1; offset 0 is
/// the cell itself.
Cells spread(const Cells& cells, int low, int high);

/// For each cell, the number of groups of slices (at most 8) that a ray can skip from a position in the cell
/// or its next neighbours without entering a cell marked in `met`; 0 where `met` is 1. Such a ray moves by
/// one cell a group and touches two at first.
Cells groupsToSkip(const Cells& met);

}  // namespace freevoxels
