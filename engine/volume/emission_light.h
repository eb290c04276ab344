#pragma once
// The light of a volume's own emission on its medium, such as the smoke around a flame. The emission of all
// voxels is joined to few sources. Each lights a grid of cells through the extinction between source and
// cell. Cells do not light each other.

#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// What a volume's voxels emit and absorb, in cubes of voxels of which there are few, summed up part by part.
class EmissionCells {
 public:
  struct Cell {
    double extinction = 0.0;  ///< mean
    glm::dvec3 power{0.0};    ///< emission times the cell's volume
  };

  EmissionCells(glm::ivec3 dimensions, const glm::dmat4& indexToWorld);
  /// Adds the voxels of a box of the volume, which begins at voxel `first` of it.
  void add(const Volume& part, glm::ivec3 first, const Classification& classification);

  glm::ivec3 size() const { return size_; }
  /// Edge of a cube with a cell's volume, world units.
  double cellEdge() const;
  glm::dmat4 cellsToWorld() const;
  std::size_t index(glm::ivec3 cell) const {
    return std::size_t(cell.x) + std::size_t(size_.x) * (std::size_t(cell.y) + std::size_t(size_.y) * std::size_t(cell.z));
  }
  const Cell& at(glm::ivec3 cell) const { return values_[index(cell)]; }

 private:
  glm::dmat4 indexToWorld_;
  int edge_;  ///< voxels
  glm::ivec3 size_;
  std::vector<Cell> values_;  ///< x fastest
};

class EmissionLight {
 public:
  /// Computes the light of all cells; 0 if nothing is emitted. `classification.emissionLight` is ignored.
  /// This is slow: it reads all voxels and marches from every cell with extinction to every source.
  EmissionLight(const Volume& volume, const Classification& classification);
  explicit EmissionLight(const EmissionCells& cells);

  /// The radiance that arrives at a position in world space, averaged over all directions, linear Rec.709,
  /// interpolated between cells.
  glm::dvec3 at(const glm::dvec3& world) const;
  /// The largest component of the radiance of any cell.
  double brightest() const { return brightest_; }

 private:
  glm::dmat4 worldToCells_{1.0};
  glm::ivec3 cells_{0};
  std::vector<glm::vec3> radiance_;  ///< x fastest
  double brightest_ = 0.0;
};

}  // namespace freevoxels
