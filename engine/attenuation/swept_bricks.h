#pragma once
// What the sweep of a light through a few planes of a box has to do: the bricks whose light is kept, and the rays that they read. Elsewhere
// nothing is in the way, and depths stay what they are.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/source_rays.h"
#include "engine/volume/coarse_cells.h"
#include "engine/volume/sparse_grid.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

/// Marks bricks and their 26 neighbours.
SparseGrid<std::uint8_t> withNeighbours(SparseGrid<std::uint8_t> bricks);

/// Marks the cells of kSkipGroup³ voxels of a box in which there are bricks.
Cells cellsOfBricks(const SparseGrid<std::uint8_t>& bricks, const VoxelRange& box);

/// The bricks of a box whose light is kept, by layers of bricks across the axis of a face. Planes are counted from the first of the face.
class SweptBricks {
 public:
  static constexpr std::size_t kLayersOfSlab = 2;  ///< that the planes of a slab lie in, at most

  /// `bricks` are marked in the whole level. `box` begins at a brick.
  SweptBricks(const SparseGrid<std::uint8_t>& bricks, const VoxelRange& box, const FaceRays& fan);

  /// The places of the bricks of a layer on the sides of the face, in bricks from the box's first.
  std::span<const glm::ivec2> ofLayer(int layer) const { return layers_[std::size_t(layer)]; }
  std::size_t mostInALayer() const;

  /// Planes in one layer.
  struct Stretch {
    int begin, end;
    std::span<const glm::ivec2> bricks;
  };
  std::vector<Stretch> stretchesOf(int begin, int end) const;

  /// The numbers of the groups of kRaySweepThreads rays that positions in the bricks may read on these planes (rayPlace() of
  /// ray_lookup.glsl).
  std::vector<std::uint32_t> groupsOf(int begin, int end) const;

 private:
  int layerOf(int plane) const;
  glm::dvec2 rayAt(glm::dvec2 side, int plane) const;

  const FaceRays fan_;
  std::vector<std::vector<glm::ivec2>> layers_;
};

}  // namespace freevoxels
