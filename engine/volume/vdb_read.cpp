#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "engine/core/error.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;
using Leaves = std::vector<const Leaf*>;

/// What a voxel of a fog volume becomes in the box.
struct FogToDensity {
  float operator()(float value, bool active) const { return active ? value : kInactiveVoxel; }
};

/// What a voxel of a level set becomes: 1 inside, 0 outside, linear over the one voxel at the surface. Inside
/// is inactive in OpenVDB, so the value alone decides.
struct LevelSetToDensity {
  float voxelSize;
  float operator()(float distance, bool active) const {
    if (active && std::isnan(distance)) return distance;  // counted, and then 0, like every NaN
    const float density = std::clamp(0.5f - distance / voxelSize, 0.0f, 1.0f);
    return density > 0.0f ? density : kInactiveVoxel;
  }
};

/// Calls `visit(box, value, active)` for each tile of the tree, at any level above the leaves. The background
/// is no tile: it has no end.
template <typename Visit>
void visitTiles(const FloatTree& tree, const Visit& visit) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) visit(tile.getBoundingBox(), tile.getValue(), tile.isValueOn());
}

/// The smallest box around the voxels that `toDensity` keeps.
template <typename ToDensity>
CoordBBox boundsOf(const FloatTree& tree, const Leaves& leaves, const ToDensity& toDensity) {
  using Range = tbb::blocked_range<std::size_t>;
  const auto join = [](CoordBBox a, const CoordBBox& b) {
    a.expand(b);
    return a;
  };
  const auto expandByLeaves = [&](const Range& range, CoordBBox box) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (box.isInside(leaves[i]->getNodeBoundingBox())) continue;
      for (auto voxel = leaves[i]->cbeginValueAll(); voxel; ++voxel)
        if (toDensity(*voxel, voxel.isValueOn()) != kInactiveVoxel) box.expand(voxel.getCoord());
    }
    return box;
  };
  CoordBBox bounds = tbb::parallel_reduce(Range(0, leaves.size()), CoordBBox(), expandByLeaves, join);
  visitTiles(tree, [&](const CoordBBox& box, float value, bool active) {
    if (toDensity(value, active) != kInactiveVoxel) bounds.expand(box);
  });
  return bounds;
}

void fillBox(Volume& volume, const CoordBBox& box, float value) {
  const Coord size = box.dim();
  const int x = box.min().x() - volume.indexOrigin.x;
  const int y = box.min().y() - volume.indexOrigin.y;
  const int z = box.min().z() - volume.indexOrigin.z;
  tbb::parallel_for(z, z + size.z(), [&, x, y](int slice) {
    for (int row = y; row < y + size.y(); ++row)
      std::fill_n(&volume.values[volume.at(x, row, slice)], size.x(), value);
  });
}

template <typename ToDensity>
void fillLeaf(Volume& volume, const Leaf& leaf, const ToDensity& toDensity) {
  for (auto voxel = leaf.cbeginValueAll(); voxel; ++voxel) {
    const float density = toDensity(*voxel, voxel.isValueOn());
    if (density == kInactiveVoxel) continue;
    const Coord at = voxel.getCoord();
    volume.values[volume.at(at.x() - volume.indexOrigin.x, at.y() - volume.indexOrigin.y,
                            at.z() - volume.indexOrigin.z)] = density;
  }
}

void checkSize(const CoordBBox& bounds, std::uint64_t maximumVoxels, const std::string& source) {
  const auto extent = [&](int axis) { return double(bounds.max()[axis]) - double(bounds.min()[axis]) + 1.0; };
  const double voxels = extent(0) * extent(1) * extent(2);
  const double longest = std::max({extent(0), extent(1), extent(2)});
  if (voxels <= double(maximumVoxels) && longest <= double(std::numeric_limits<int>::max())) return;
  fail(ExitCode::OutOfMemory,
       "{} is too large: its {:.0f} x {:.0f} x {:.0f} box needs {:.0f} voxels and at most {} are possible "
       "here; "
       "resample or crop the volume, for example with vdb_tool or Houdini",
       source, extent(0), extent(1), extent(2), voxels, maximumVoxels);
}

glm::dmat4 indexToWorldOf(const FloatGrid& grid, glm::ivec3 indexOrigin) {
  const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  glm::dmat4 indexToWorld;  // OpenVDB multiplies row vectors from the left, so its rows are glm's columns
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) indexToWorld[i][j] = matrix(i, j);
  indexToWorld[3] = indexToWorld * glm::dvec4(glm::dvec3(indexOrigin), 1.0);
  return indexToWorld;
}

template <typename ToDensity>
Volume toVolume(const FloatGrid& grid, const ToDensity& toDensity, const std::string& source,
                std::uint64_t maximumVoxels) {
  Leaves leaves;
  grid.tree().getNodes(leaves);
  const CoordBBox bounds = boundsOf(grid.tree(), leaves, toDensity);
  if (bounds.empty())
    fail(ExitCode::Input, "{} cannot be rendered: no voxel is inside the level set", source);
  checkSize(bounds, maximumVoxels, source);

  Volume volume;
  volume.source = source;
  volume.dimensions = {bounds.dim().x(), bounds.dim().y(), bounds.dim().z()};
  volume.indexOrigin = {bounds.min().x(), bounds.min().y(), bounds.min().z()};
  volume.indexToWorld = indexToWorldOf(grid, volume.indexOrigin);
  volume.values.assign(volume.voxelCount(), kInactiveVoxel);
  visitTiles(grid.tree(), [&](const CoordBBox& box, float value, bool active) {
    const float density = toDensity(value, active);
    if (density != kInactiveVoxel) fillBox(volume, box, density);
  });
  tbb::parallel_for(std::size_t(0), leaves.size(),
                    [&](std::size_t i) { fillLeaf(volume, *leaves[i], toDensity); });
  summariseValues(volume);
  return volume;
}

[[noreturn]] void failUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why) {
  fail(ExitCode::Input, "grid '{}' of '{}' cannot be rendered: {}", entry.name, file.path().string(), why);
}

}  // namespace

Volume readVdb(const std::filesystem::path& path, const std::string& gridName, std::uint64_t maximumVoxels) {
  VdbFile file(path);
  const VdbFile::Entry& entry = file.choose(gridName);
  if (const std::string why = whyTypeUnusable(entry.treeType, entry.valueType); !why.empty())
    failUnusable(file, entry, why);
  if (const std::string why = whyTransformUnusable(file.readMetadata(entry)->transform()); !why.empty())
    failUnusable(file, entry, why);

  const openvdb::GridBase::Ptr grid = file.read(entry);
  if (grid->activeVoxelCount() == 0) failUnusable(file, entry, kEmptyGridClause);
  const FloatGrid::ConstPtr floats = asFloatGrid(grid);
  const std::string source = fmt::format("{} {}", path.filename().string(), entry.name);
  try {
    if (grid->getGridClass() != openvdb::GRID_LEVEL_SET)
      return toVolume(*floats, FogToDensity{}, source, maximumVoxels);
    const double voxelSize = std::cbrt(std::abs(floats->transform().baseMap()->determinant()));
    return toVolume(*floats, LevelSetToDensity{float(voxelSize)}, source, maximumVoxels);
  } catch (const std::bad_alloc&) {
    fail(ExitCode::OutOfMemory, "not enough memory for {}; free some, or resample or crop the volume",
         source);
  }
}

}  // namespace freevoxels
