#include "engine/volume/vdb_density.h"

#include <openvdb/tools/Count.h>

#include "engine/volume/grid_names.h"

namespace freevoxels {

namespace {

/// Whether the values are on both sides of 0, up to the background, and no farther.
template <typename Grid>
bool areDistances(const Grid& grid) {
  constexpr double kRounding = 1e-3, kMinOfBand = 0.5;
  const double band = grid.background();
  if (!(band > 0.0) || grid.empty()) return false;
  const auto range = openvdb::tools::minMax(grid.tree());
  const double least = range.min(), most = range.max();
  return least < 0.0 && most > 0.0 && std::max(-least, most) <= band * (1.0 + kRounding) && std::max(-least, most) >= kMinOfBand * band;
}

}  // namespace

bool isFog(const openvdb::GridBase& grid) {
  return grid.getGridClass() == openvdb::GRID_FOG_VOLUME && roleOfName(grid.getName()).role == GridRole::Density;
}

bool isLevelSet(const openvdb::GridBase& grid) {
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return true;
  if (grid.isType<openvdb::FloatGrid>()) return areDistances(static_cast<const openvdb::FloatGrid&>(grid));
  return grid.isType<openvdb::DoubleGrid>() && areDistances(static_cast<const openvdb::DoubleGrid&>(grid));
}

bool hasEmptyZeros(const openvdb::GridBase& grid) {
  constexpr double kMostVoxels = std::numeric_limits<std::int32_t>::max();
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return false;
  const glm::i64vec3 extent = extentOf(box);
  return double(extent.x) * double(extent.y) * double(extent.z) > kMostVoxels;
}

bool isInverted(const openvdb::GridBase& grid) {
  if (grid.isType<openvdb::FloatGrid>()) return static_cast<const openvdb::FloatGrid&>(grid).background() < 0.0f;
  return grid.isType<openvdb::DoubleGrid>() && static_cast<const openvdb::DoubleGrid&>(grid).background() < 0.0;
}

}  // namespace freevoxels
