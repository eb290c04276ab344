#pragma once
// The medium of a volume in cells of several voxels, in which light is followed through all orders of scattering.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "engine/scene/lighting.h"
#include "engine/scene/ray_clip.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Largest numbers of cells of voxels, of which the direct light is computed, and of the cells between which light is scattered.
inline constexpr std::uint64_t kMaxDirectCells = 1u << 21, kMaxScatteringCells = 1u << 17;

/// A grid of cubic cells over a volume. Cell (0,0,0) begins at voxel (0,0,0); the last cells may extend beyond the volume, where they count
/// as empty.
struct CellGrid {
  glm::ivec3 cells{0};
  int edge = 1;  ///< voxels along the edge of a cell

  CellGrid() = default;
  CellGrid(glm::ivec3 dimensions, int voxels) : cells((dimensions + voxels - 1) / voxels), edge(voxels) {}
  std::size_t count() const { return std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z); }
  std::size_t index(glm::ivec3 cell) const {
    return std::size_t(cell.x) + std::size_t(cells.x) * (std::size_t(cell.y) + std::size_t(cells.y) * std::size_t(cell.z));
  }
  bool operator==(const CellGrid&) const = default;
};

/// One of several volumes of a medium.
struct PlacedMedium {
  const Volume* volume;
  const Classification* classification;
};

/// What cells hold on average: sums that are filled part by part, so that a volume need not be in memory as a whole.
class ScatteringMedium {
 public:
  /// The cells of a volume of this size: as small as kMaxScatteringCells allows. The direct cells, with kMaxDirectCells, divide their
  /// edges.
  static CellGrid directGridOf(glm::ivec3 dimensions);
  static CellGrid gridOf(glm::ivec3 dimensions);

  /// Empty cells.
  ScatteringMedium(glm::ivec3 dimensions, const glm::dmat4& indexToWorld);
  /// The cells of a whole volume.
  ScatteringMedium(const Volume& volume, const Classification& classification);

  /// The cells of several volumes, wherever they are: cells of an index space along the axes of the world.
  explicit ScatteringMedium(std::span<const PlacedMedium> volumes);

  /// Adds the voxels of a box of the volume, which begins at voxel `first` of it. Each voxel must be added once.
  void add(const Volume& part, glm::ivec3 first, const Classification& classification);
  /// The same medium in cells of twice the edge, whose direct cells are this one's cells.
  ScatteringMedium coarser() const;
  /// The same medium in a part of the volume's index space. Cells that are partly in it count so far as they are.
  ScatteringMedium clipped(const RayClip& clip) const;

  const glm::dmat4& indexToWorld() const { return indexToWorld_; }
  const CellGrid& grid() const { return grid_; }
  /// The grid of `directExtinction`; its cells divide those of grid().
  const CellGrid& directGrid() const { return directGrid_; }
  /// Mean extinction of each direct cell, per world unit, x fastest.
  std::vector<float> directExtinction() const { return {direct_.begin(), direct_.end()}; }
  /// The means of a cell: extinction, extinction times albedo, and emission, per world unit; linear Rec.709.
  struct Cell {
    double extinction = 0.0;
    glm::dvec3 scattering{0.0};
    glm::dvec3 emission{0.0};
  };
  std::span<const Cell> cells() const { return cells_; }
  /// The fraction in 0..1 of each cell that counts as surfaces where these are shaded: by the relative change of extinction from cell to
  /// cell (surfaceShare). What surfaces reflect is not scattered by the fog.
  std::vector<double> surfaceShares() const;
  /// The mean albedo of the medium, weighted by extinction.
  glm::dvec3 meanAlbedo() const;
  bool emits() const;
  /// Whether scattering and emission have no colour.
  bool isGrey() const;

 private:
  explicit ScatteringMedium(const std::pair<glm::ivec3, glm::dmat4>& space) : ScatteringMedium(space.first, space.second) {}
  void addPlaced(const PlacedMedium& placed);

  glm::dmat4 indexToWorld_;
  CellGrid grid_, directGrid_;
  std::vector<Cell> cells_;
  std::vector<double> direct_;
};

/// The factor of the medium's mean extinction by delta scaling (PhaseSplit), by colour: 1 where nothing is scattered forwards.
glm::dvec3 deltaScaleOf(const Lighting& lighting, const ScatteringMedium& medium);

}  // namespace freevoxels
