#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <new>

#include "engine/core/error.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_density.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using Leaf = openvdb::FloatTree::LeafNodeType;

/// The bricks lie on the lattice of the leaves: a leaf is a brick, and a tile is several.
static_assert(ScalarBricks::kEdge == int(Leaf::DIM));

ScalarBricks::Brick& makeBrickAt(Volume& volume, const Coord& corner) {
  constexpr int shift = Leaf::LOG2DIM;
  return volume.scalars.makeBrick((glm::ivec3(corner.x(), corner.y(), corner.z()) >> shift) -
                                  (volume.indexOrigin >> shift));
}

void fillTile(Volume& volume, const CoordBBox& tile, float value) {
  for (int z = tile.min().z(); z <= tile.max().z(); z += int(Leaf::DIM))
    for (int y = tile.min().y(); y <= tile.max().y(); y += int(Leaf::DIM))
      for (int x = tile.min().x(); x <= tile.max().x(); x += int(Leaf::DIM))
        makeBrickAt(volume, Coord(x, y, z)).fill(value);
}

template <typename ToDensity>
void fillBrick(ScalarBricks::Brick& brick, const Leaf& leaf, const ToDensity& toDensity) {
  for (auto voxel = leaf.cbeginValueAll(); voxel; ++voxel) {
    const Coord place = Leaf::offsetToLocalCoord(voxel.pos());
    brick[ScalarBricks::indexInBrick({place.x(), place.y(), place.z()})] =
        toDensity(*voxel, voxel.isValueOn());
  }
}

/// Leaves that hold nothing make no brick.
template <typename ToDensity>
void fillLeaves(Volume& volume, std::vector<const Leaf*> leaves, const ToDensity& toDensity) {
  std::erase_if(leaves, [&](const Leaf* leaf) { return !holdsData(*leaf, toDensity); });
  volume.scalars.reserve(volume.scalars.bricks().size() + leaves.size());
  std::vector<ScalarBricks::Brick*> bricks;
  for (const Leaf* leaf : leaves) bricks.push_back(&makeBrickAt(volume, leaf->origin()));
  tbb::parallel_for(std::size_t(0), leaves.size(),
                    [&](std::size_t i) { fillBrick(*bricks[i], *leaves[i], toDensity); });
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
  std::vector<const Leaf*> leaves;
  grid.tree().getNodes(leaves);
  const CoordBBox bounds = boundsOf(grid.tree(), leaves, toDensity);
  if (bounds.empty()) fail(ExitCode::Input, "{} cannot be rendered: {}", source, kNothingInsideClause);
  checkSize(bounds, maximumVoxels, source);

  Volume volume;
  volume.source = source;
  volume.dimensions = {bounds.dim().x(), bounds.dim().y(), bounds.dim().z()};
  volume.indexOrigin = {bounds.min().x(), bounds.min().y(), bounds.min().z()};
  volume.indexToWorld = indexToWorldOf(grid, volume.indexOrigin);
  volume.scalars = ScalarBricks(volume.dimensions, volume.indexOrigin & (ScalarBricks::kEdge - 1));
  visitTiles(grid.tree(), [&](const CoordBBox& box, float value, bool active) {
    const float density = toDensity(value, active);
    if (density != kInactiveVoxel) fillTile(volume, box, density);
  });
  fillLeaves(volume, std::move(leaves), toDensity);
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
    return withDensity(
        *grid, [&](const auto& toDensity) { return toVolume(*floats, toDensity, source, maximumVoxels); });
  } catch (const std::bad_alloc&) {
    fail(ExitCode::OutOfMemory, "not enough memory for {}; free some, or resample or crop the volume",
         source);
  }
}

}  // namespace freevoxels
