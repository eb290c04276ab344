#pragma once
// Pieces of a volume that are drawn one after the other, in an order in which each ray meets them.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene/source_rays.h"
#include "engine/volume/sparse_grid.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

/// Boxes of whole bricks, disjoint and small, that contain all bricks of a volume. Planes that part them make a tree, by which no box is in
/// front of another one that comes before it, wherever the eye is. Islands of data that are far apart have a box each, and dense data are
/// cut every kCubeEdge voxels.
class PieceTree {
 public:
  static constexpr int kCubeEdge = SparseGrid<std::uint8_t>::kNodeEdge * ScalarBricks::kEdge;
  static constexpr int kLongestEdge = kCubeEdge + kCubeEdge / 2;  ///< of a box, in voxels
  static constexpr int kMostBricks = 1400;                        ///< in a box that is longer than kCubeEdge

  /// `bricks` are those with another value than 0, in a volume of `dimensions` voxels.
  PieceTree(const SparseGrid<std::uint8_t>& bricks, glm::ivec3 dimensions);

  std::span<const VoxelRange> pieces() const { return pieces_; }
  /// The pieces from front to back. `eye` is in voxels.
  std::vector<VoxelRange> inOrder(const RaySource& eye) const;

 private:
  struct Part;
  /// A plane with the nodes in front of it and behind it, or a piece.
  struct Node {
    int axis = 0, at = 0;     ///< the first voxel behind the plane
    int low = -1, high = -1;  ///< numbers of nodes
    std::size_t piece = 0;    ///< where there are no nodes
  };

  int add(std::span<Part> parts, glm::ivec3 dimensions);

  std::vector<VoxelRange> pieces_;
  std::vector<Node> nodes_;
};

}  // namespace freevoxels
