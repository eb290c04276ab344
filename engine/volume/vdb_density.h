#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: the conversion of a grid's values to densities,
// and the box of the voxels that are kept.

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "engine/volume/labels.h"
#include "engine/volume/openvdb_trees.h"
#include "engine/volume/volume.h"

namespace freevoxels {

// Coordinates of voxels may be any of 32 bits: what is beside or beyond the last one, and the extent of a box, may have more.

/// Numbers of voxels along the axes of a box that has any.
inline glm::i64vec3 extentOf(const openvdb::CoordBBox& box) {
  const auto along = [&](int axis) { return std::int64_t(box.max()[axis]) - box.min()[axis] + 1; };
  return {along(0), along(1), along(2)};
}

/// The box with `margin` more voxels on every side, as far as there are coordinates.
inline openvdb::CoordBBox extendedBy(int margin, openvdb::CoordBBox box) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = std::max(box.min()[axis], std::numeric_limits<int>::min() + margin) - margin;
    box.max()[axis] = std::min(box.max()[axis], std::numeric_limits<int>::max() - margin) + margin;
  }
  return box;
}

// The conversions have operator() for voxels and tile() for tiles, of which many files have large ones.

/// The value of any other grid's voxel.
struct FogToDensity {
  static constexpr int kMargin = 0;
  static constexpr bool kKeepsInactive = false;  // whether it keeps any inactive voxel
  bool hasEmptyTiles = false;                    ///< whether active tiles of value 0 hold nothing: those of densities
  bool hasEmptyVoxels = false;                   ///< whether active voxels of value 0 hold nothing
  float operator()(float value, bool active) const { return active && !(hasEmptyVoxels && value == 0.0f) ? value : kInactiveVoxel; }
  float tile(float value, bool active) const { return active && !(hasEmptyTiles && value == 0.0f) ? value : kInactiveVoxel; }
};

/// The density of a level set's voxel: 1 inside, 0 outside, with a smooth transition of four voxels across the surface, so that gradients
/// have its direction: a linear one has bends where the opaque surface is seen, which show as rings. OpenVDB stores voxels deep inside as
/// inactive.
struct LevelSetToDensity {
  static constexpr bool kKeepsInactive = true;
  static constexpr int kMargin = 2;  // voxels around it, from which light reaches its surface
  float voxelSize;
  float sign = 1.0f;  ///< -1 where distances are negative outside
  float operator()(float stored, bool active) const {
    const float distance = sign * stored;
    if (active && std::isnan(distance)) return distance;  // counted later and then set to 0, like every NaN
    constexpr float kRamp = 4.0f;                         // voxels
    const float inwards = active ? std::clamp(0.5f - distance / (kRamp * voxelSize), 0.0f, 1.0f) : distance < 0.0f ? 1.0f : 0.0f;
    const float density = inwards * inwards * (3.0f - 2.0f * inwards);
    return density > 0.0f ? density : kInactiveVoxel;
  }
  float tile(float distance, bool active) const { return (*this)(distance, active); }
};

/// The label of a voxel, where it is shown (labels.h).
struct ShownLabel {
  static constexpr bool kKeepsInactive = false;
  static constexpr int kMargin = 2;  // voxels around it, as of level sets
  const Labels* labels;
  float operator()(float value, bool active) const { return active && labels->shows(labelOf(value)) ? value : kInactiveVoxel; }
  float tile(float value, bool active) const { return (*this)(value, active); }
};

/// Calls `visit(box, density)` for the tiles of a node, each of `edge` voxels along an edge, that `toDensity` keeps.
template <typename Node, typename ToDensity, typename Visit>
void visitTilesOf(const Node& node, int edge, const ToDensity& toDensity, const Visit& visit) {
  const auto visitIfKept = [&](const auto& tile) {
    const float density = toDensity.tile(*tile, tile.isValueOn());
    if (density != kInactiveVoxel) visit(openvdb::CoordBBox::createCube(tile.getCoord(), edge), density);
  };
  if constexpr (ToDensity::kKeepsInactive) {
    for (auto tile = node.cbeginValueAll(); tile; ++tile) visitIfKept(tile);
  } else {  // most nodes have tens of thousands of inactive ones
    for (auto tile = node.cbeginValueOn(); tile; ++tile) visitIfKept(tile);
  }
}

/// Calls `visit(box, density)` for each tile of the tree, at any level above the leaves, that `toDensity` keeps. The background
/// is no tile: it has no end.
template <typename ToDensity, typename Visit>
void visitTiles(const openvdb::FloatTree& tree, const ToDensity& toDensity, const Visit& visit) {
  using Upper = openvdb::FloatTree::RootNodeType::ChildNodeType;
  using Lower = Upper::ChildNodeType;
  visitTilesOf(tree.root(), int(Upper::DIM), toDensity, visit);
  std::vector<const Upper*> upper;
  tree.getNodes(upper);
  for (const Upper* node : upper) visitTilesOf(*node, int(Lower::DIM), toDensity, visit);
  std::vector<const Lower*> lower;
  tree.getNodes(lower);
  for (const Lower* node : lower) visitTilesOf(*node, int(Lower::ChildNodeType::DIM), toDensity, visit);
}

/// Whether `toDensity` keeps any voxel of the leaf.
template <typename ToDensity>
bool holdsData(const openvdb::FloatTree::LeafNodeType& leaf, const ToDensity& toDensity) {
  for (auto voxel = leaf.cbeginValueAll(); voxel; ++voxel)
    if (toDensity(*voxel, voxel.isValueOn()) != kInactiveVoxel) return true;
  return false;
}

/// The smallest box around the voxels that `toDensity` keeps, extended by its margin; empty if it keeps none.
template <typename ToDensity>
openvdb::CoordBBox boundsOf(const openvdb::FloatTree& tree,
                            const std::vector<const openvdb::FloatTree::LeafNodeType*>& leaves,
                            const ToDensity& toDensity) {
  using Range = tbb::blocked_range<std::size_t>;
  const auto join = [](openvdb::CoordBBox a, const openvdb::CoordBBox& b) {
    a.expand(b);
    return a;
  };
  const auto expandByLeaves = [&](const Range& range, openvdb::CoordBBox box) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (box.isInside(leaves[i]->getNodeBoundingBox())) continue;
      for (auto voxel = leaves[i]->cbeginValueAll(); voxel; ++voxel)
        if (toDensity(*voxel, voxel.isValueOn()) != kInactiveVoxel) box.expand(voxel.getCoord());
    }
    return box;
  };
  openvdb::CoordBBox bounds =
      tbb::parallel_reduce(Range(0, leaves.size()), openvdb::CoordBBox(), expandByLeaves, join);
  visitTiles(tree, toDensity, [&](const openvdb::CoordBBox& box, float) { bounds.expand(box); });
  return bounds.empty() ? bounds : extendedBy(ToDensity::kMargin, bounds);
}

/// Whether a grid says that it has densities: it is called a fog volume, and its name is usual for them.
bool isFog(const openvdb::GridBase& grid);

/// How many voxels the bricks have that `toDensity` keeps something of.
template <typename ToDensity>
double occupiedVoxels(const openvdb::FloatTree& tree, const std::vector<const openvdb::FloatTree::LeafNodeType*>& leaves,
                      const ToDensity& toDensity) {
  using Leaf = openvdb::FloatTree::LeafNodeType;
  double voxels =
      double(Leaf::NUM_VOXELS) * double(std::ranges::count_if(leaves, [&](const Leaf* leaf) { return holdsData(*leaf, toDensity); }));
  visitTiles(tree, toDensity, [&](const openvdb::CoordBBox& box, float) {
    const glm::i64vec3 extent = extentOf(box);
    voxels += double(extent.x) * double(extent.y) * double(extent.z);
  });
  return voxels;
}

/// Whether a grid has signed distances: it is called a level set or, where the program that wrote it does not say so, its background is
/// the largest distance from a surface, on both sides of which it has voxels.
bool isLevelSet(const openvdb::GridBase& grid);

/// Whether the distances of a level set are negative outside, as its background says.
bool isInverted(const openvdb::GridBase& grid);

/// Whether active voxels of value 0 hold nothing: those of a grid around which a box has more voxels than can be numbered, where zeros far
/// away would make it so large. In a smaller box they are values like others, with which their neighbours are interpolated.
bool hasEmptyZeros(const openvdb::GridBase& grid);

/// Calls `action(toDensity)` with the conversion for the grid's class, or for labels, unless these are null.
template <typename Action>
auto withDensity(const openvdb::GridBase& grid, const Labels* labels, const Action& action) {
  if (labels != nullptr) return action(ShownLabel{labels});
  if (!isLevelSet(grid)) {
    const bool empty = hasEmptyZeros(grid);
    return action(FogToDensity{.hasEmptyTiles = empty || isFog(grid), .hasEmptyVoxels = empty});
  }
  const double voxelSize = std::cbrt(std::abs(grid.transform().baseMap()->determinant()));
  return action(LevelSetToDensity{float(voxelSize), isInverted(grid) ? -1.0f : 1.0f});
}

}  // namespace freevoxels
