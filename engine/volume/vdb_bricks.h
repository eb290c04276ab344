#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: the values of a tree as bricks of a box.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "engine/volume/openvdb_trees.h"
#include "engine/volume/vdb_density.h"
#include "engine/volume/volume.h"

namespace freevoxels {

using VdbLeaf = openvdb::FloatTree::LeafNodeType;

/// Bricks are on the lattice of the leaves: a leaf is a brick, and a tile is several.
static_assert(ScalarBricks::kEdge == int(VdbLeaf::DIM));

/// A box without data; `origin` is its first voxel in the file's index space.
inline ScalarBricks emptyBricks(glm::ivec3 dimensions, glm::ivec3 origin) {
  return ScalarBricks(dimensions, origin & (ScalarBricks::kEdge - 1));
}

/// The cell of the brick at a leaf's position.
inline glm::ivec3 brickCell(glm::ivec3 origin, const openvdb::Coord& corner) {
  constexpr int shift = VdbLeaf::LOG2DIM;
  return (glm::ivec3(corner.x(), corner.y(), corner.z()) >> shift) - (origin >> shift);
}

/// Calls `visit(corner)` for each position of a leaf that a box touches.
template <typename Visit>
void forEachLeafIn(const openvdb::CoordBBox& box, const Visit& visit) {
  const openvdb::Coord first = box.min() >> VdbLeaf::LOG2DIM, last = box.max() >> VdbLeaf::LOG2DIM;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) visit(openvdb::Coord(x, y, z) << VdbLeaf::LOG2DIM);
}

template <typename ToDensity>
void fillBrick(ScalarBricks::Brick& brick, const VdbLeaf& leaf, const ToDensity& toDensity) {
  for (auto voxel = leaf.cbeginValueAll(); voxel; ++voxel) {
    const openvdb::Coord place = VdbLeaf::offsetToLocalCoord(voxel.pos());
    brick[ScalarBricks::indexInBrick({place.x(), place.y(), place.z()})] =
        toDensity(*voxel, voxel.isValueOn());
  }
}

/// The bricks of the voxels of a tree that `toDensity` keeps, all of which are inside the box. Leaves without
/// such voxels make no brick.
template <typename ToDensity>
ScalarBricks bricksOf(const openvdb::FloatTree& tree, std::vector<const VdbLeaf*> leaves,
                      glm::ivec3 dimensions, glm::ivec3 origin, const ToDensity& toDensity, const Progress& progress = {}) {
  constexpr std::size_t kBatch = 1 << 14;  // leaves
  const auto report = [&](double fraction) {
    if (progress) progress("making bricks", fraction);
  };
  ScalarBricks result = emptyBricks(dimensions, origin);
  visitTiles(tree, toDensity, [&](const openvdb::CoordBBox& box, float density) {
    report(0.0);
    forEachLeafIn(box, [&](const openvdb::Coord& corner) {
      result.makeBrick(brickCell(origin, corner)).fill(density);
    });
  });
  std::erase_if(leaves, [&](const VdbLeaf* leaf) { return !holdsData(*leaf, toDensity); });
  result.reserve(result.count() + leaves.size());
  std::vector<ScalarBricks::Brick*> bricks;
  for (const VdbLeaf* leaf : leaves) bricks.push_back(&result.makeBrick(brickCell(origin, leaf->origin())));
  for (std::size_t first = 0; first < leaves.size(); first += kBatch) {
    report(double(first) / double(leaves.size()));
    tbb::parallel_for(first, std::min(first + kBatch, leaves.size()), [&](std::size_t i) { fillBrick(*bricks[i], *leaves[i], toDensity); });
  }
  return result;
}

}  // namespace freevoxels
