#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/volume/occupied_count.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_density.h"
#include "engine/volume/vdb_grids.h"
#include "engine/volume/vdb_volume.h"

namespace freevoxels {

namespace {

using openvdb::FloatTree;

struct ValueRange {
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();

  void include(float value) {
    if (!std::isfinite(value)) return;
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
  }
};

ValueRange joinRanges(const ValueRange& a, const ValueRange& b) {
  return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
}

/// The range of the finite active values.
ValueRange rangeOf(const FloatTree& tree) {
  std::vector<const FloatTree::LeafNodeType*> leaves;
  tree.getNodes(leaves);
  using Range = tbb::blocked_range<std::size_t>;
  ValueRange values = tbb::parallel_reduce(
      Range(0, leaves.size()), ValueRange{},
      [&](const Range& range, ValueRange partial) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel) partial.include(*voxel);
        return partial;
      },
      joinRanges);
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) values.include(*tile);
  return values;
}

std::string gridClassName(openvdb::GridClass gridClass) {
  switch (gridClass) {
    case openvdb::GRID_LEVEL_SET:
      return "level set";
    case openvdb::GRID_FOG_VOLUME:
      return "fog volume";
    case openvdb::GRID_STAGGERED:
      return "staggered";
    case openvdb::GRID_UNKNOWN:
      break;
  }
  return "unknown";
}

void describeVoxels(const openvdb::GridBase::ConstPtr& grid, GridInfo& info) {
  info.memoryBytes = grid->memUsage();
  info.activeVoxels = grid->activeVoxelCount();
  if (info.activeVoxels == 0) return;
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  info.boundsMinimum = {box.min().x(), box.min().y(), box.min().z()};
  info.boundsMaximum = {box.max().x(), box.max().y(), box.max().z()};
  info.dimensions = extentOf(box);
  const openvdb::FloatGrid::ConstPtr floats = asFloatGrid(grid);
  if (!floats) return;
  const ValueRange values = rangeOf(floats->tree());
  info.hasRange = values.minimum <= values.maximum;
  if (!info.hasRange) return;
  info.minimum = values.minimum;
  info.maximum = values.maximum;
}

/// Boxes of more voxels are not counted: it would take too long.
constexpr double kMaxCounted = 1 << 29;

template <typename ToDensity>
std::vector<std::uint64_t> storedBlocks(const FloatTree& tree,
                                        const std::vector<const FloatTree::LeafNodeType*>& leaves,
                                        const openvdb::CoordBBox& bounds, const ToDensity& toDensity) {
  const glm::u64vec3 size(extentOf(bounds));
  if (voxelsIn(size) > kMaxCounted) return {};
  std::vector<bool> holding(size.x * size.y * size.z, false);
  const auto indexOf = [&](const openvdb::Coord& voxel) {
    const openvdb::Coord place = voxel - bounds.min();
    return std::size_t(place.x()) + size.x * (std::size_t(place.y()) + size.y * std::size_t(place.z()));
  };
  for (const FloatTree::LeafNodeType* leaf : leaves)
    for (auto voxel = leaf->cbeginValueAll(); voxel; ++voxel)
      if (toDensity(*voxel, voxel.isValueOn()) > 0.0f) holding[indexOf(voxel.getCoord())] = true;
  visitTiles(tree, toDensity, [&](const openvdb::CoordBBox& box, float density) {
    if (!(density > 0.0f)) return;
    const glm::i64vec3 n = extentOf(box);
    const std::size_t first = indexOf(box.min());
    for (std::int64_t z = 0; z < n.z; ++z)
      for (std::int64_t y = 0; y < n.y; ++y)
        std::fill_n(holding.begin() + std::ptrdiff_t(first + size.x * (std::size_t(y) + size.y * std::size_t(z))), n.x, true);
  });
  return countOccupiedBlocks(glm::ivec3(size), std::move(holding));
}

template <typename ToDensity>
std::uint64_t hostBytes(const FloatTree& tree, const std::vector<const FloatTree::LeafNodeType*>& leaves, const ToDensity& toDensity) {
  auto bricks = std::uint64_t(
      std::ranges::count_if(leaves, [&](const auto* leaf) { return holdsData(*leaf, toDensity); }));
  visitTiles(tree, toDensity, [&](const openvdb::CoordBBox& box, float) {
    const glm::u64vec3 n(extentOf(box));
    bricks += n.x * n.y * n.z / std::tuple_size_v<ScalarBricks::Brick>;
  });
  return ScalarBricks::bytesOf(bricks);
}

/// Describes the box that readVdb would return, and its occupied blocks.
void describeBox(const VdbFile::Entry& entry, const openvdb::GridBase::ConstPtr& grid, GridInfo& info) {
  const openvdb::FloatGrid::ConstPtr floats = asFloatGrid(grid);
  std::vector<const FloatTree::LeafNodeType*> leaves;
  floats->tree().getNodes(leaves);
  const Labels labels;
  withDensity(*grid, isWhole(entry) ? &labels : nullptr, [&](const auto& toDensity) {
    const openvdb::CoordBBox box = boundsOf(floats->tree(), leaves, toDensity);
    if (box.empty()) {
      info.unusable = isWhole(entry) ? kNoLabelClause : kNothingInsideClause;
      return;
    }
    const glm::i64vec3 extent = extentOf(box);
    if (std::max({extent.x, extent.y, extent.z}) > kLongestReadEdge) {
      info.unusable = fmt::format("its box is too large: it has more than {} voxels along an edge", kLongestReadEdge);
      return;
    }
    info.renderDimensions = glm::ivec3(extent);
    info.storedBlocks = storedBlocks(floats->tree(), leaves, box, toDensity);
    info.hostBytes = hostBytes(floats->tree(), leaves, toDensity);
  });
}

bool hasTemperatures(const VdbFile::Entry& entry) {
  return isScalar(entry) && roleOfName(entry.baseName).role == GridRole::Temperature;
}

/// Whether a grid can hold albedos. Staggered vectors are velocities.
bool hasAlbedos(const VdbFile::Entry& entry, const openvdb::GridBase& grid) {
  return isColor(entry) && grid.getGridClass() != openvdb::GRID_STAGGERED;
}

GridInfo describe(VdbFile& file, const VdbFile::Entry& entry) {
  GridInfo info;
  info.name = entry.name;
  info.valueType = entry.valueType;
  info.gridClass = gridClassName(openvdb::GRID_UNKNOWN);
  info.unusable = whyTypeUnusable(entry.treeType, entry.valueType);
  info.areLabels = isWhole(entry);
  info.isTemperature = hasTemperatures(entry);
  if (!openvdb::GridBase::isRegistered(entry.treeType)) return info;

  const openvdb::GridBase::ConstPtr grid = file.read(entry);
  info.gridClass = gridClassName(grid->getGridClass());
  info.isAlbedo = hasAlbedos(entry, *grid);
  const openvdb::Vec3d size = grid->voxelSize();
  info.voxelSize = {size.x(), size.y(), size.z()};
  if (info.unusable.empty()) info.unusable = whyTransformUnusable(grid->transform());
  describeVoxels(grid, info);
  if (info.unusable.empty() && info.activeVoxels == 0) info.unusable = kEmptyGridClause;
  if (info.unusable.empty()) describeBox(entry, grid, info);
  return info;
}

}  // namespace

std::vector<GridInfo> describeVdb(const std::filesystem::path& path) {
  VdbFile file(path);
  std::vector<GridInfo> infos;
  for (const VdbFile::Entry& entry : file.entries()) infos.push_back(describe(file, entry));
  return infos;
}

bool hasGrid(const std::filesystem::path& file, const std::string& name) {
  return VdbFile(file).has(name);
}

std::vector<GridChoice> listVdb(const std::filesystem::path& path) {
  VdbFile file(path);
  std::vector<GridChoice> choices;
  for (const VdbFile::Entry& entry : file.entries()) {
    GridChoice& choice = choices.emplace_back(GridChoice{.name = entry.name});
    choice.isDensity = whyTypeUnusable(entry.treeType, entry.valueType).empty();
    choice.isScalar = isScalar(entry);
    choice.isTemperature = hasTemperatures(entry);
    if (openvdb::GridBase::isRegistered(entry.treeType))
      choice.isAlbedo = hasAlbedos(entry, *file.readMetadata(entry));
  }
  return choices;
}

}  // namespace freevoxels
