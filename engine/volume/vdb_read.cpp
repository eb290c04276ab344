#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "engine/core/error.h"
#include "engine/volume/scan.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_bricks.h"
#include "engine/volume/vdb_channels.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

void checkSize(const CoordBBox& bounds, std::uint64_t maximumVoxels, const std::string& source) {
  const auto extent = [&](int axis) { return double(bounds.max()[axis]) - double(bounds.min()[axis]) + 1.0; };
  const double voxels = extent(0) * extent(1) * extent(2);
  const double longest = std::max({extent(0), extent(1), extent(2)});
  if (voxels <= double(maximumVoxels) && longest <= double(std::numeric_limits<int>::max())) return;
  fail(ErrorKind::OutOfMemory,
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

/// Moves a volume near to the origin, and scales it, where its coordinates would leave double precision too few digits to tell
/// its voxels apart, or single precision's range when they are squared; warns of it, as cameras and densities then count in other
/// units.
void normaliseWorld(Volume& volume) {
  constexpr double kFarthest = 1e10;  // voxels from the origin
  constexpr double kLargest = 1e9;    // world units of a voxel, and their inverse
  const double voxel = volume.voxelSize();
  const glm::dvec3 centre(volume.indexToWorld * glm::dvec4((glm::dvec3(volume.dimensions) - 1.0) / 2.0, 1.0));
  if (glm::length(centre) > kFarthest * voxel) {
    volume.indexToWorld[3] -= glm::dvec4(centre, 0.0);
    volume.warnings.push_back(
        fmt::format("{} is so far from the origin that its voxels can hardly be told apart: its middle, {:g},{:g},{:g}, becomes the "
                    "origin, from which positions of cameras and lights count",
                    volume.source, centre.x, centre.y, centre.z));
  }
  if (voxel > kLargest || voxel < 1.0 / kLargest) {
    const double scale = std::pow(10.0, -std::floor(std::log10(voxel)));
    for (int column = 0; column < 4; ++column) volume.indexToWorld[column] = glm::dvec4(glm::dvec3(volume.indexToWorld[column]) * scale, column == 3);
    volume.warnings.push_back(
        fmt::format("voxels of {} are {:g} world units large: it is scaled by {:g}, so that the camera, the lights and the scale of "
                    "densities count in units of {:g}",
                    volume.source, voxel, scale, 1.0 / scale));
  }
}

/// Makes the volume of the box around the voxels that `toDensity` keeps and around `more`.
template <typename ToDensity>
Volume toVolume(const FloatGrid& grid, const ToDensity& toDensity, const std::string& source,
                const CoordBBox& more, std::uint64_t maximumVoxels) {
  std::vector<const VdbLeaf*> leaves;
  grid.tree().getNodes(leaves);
  CoordBBox bounds = boundsOf(grid.tree(), leaves, toDensity);
  if (bounds.empty())
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: {}", source, kNothingInsideClause));
  bounds.expand(more);
  checkSize(bounds, maximumVoxels, source);

  Volume volume;
  volume.source = source;
  volume.dimensions = {bounds.dim().x(), bounds.dim().y(), bounds.dim().z()};
  volume.indexOrigin = {bounds.min().x(), bounds.min().y(), bounds.min().z()};
  volume.indexToWorld = indexToWorldOf(grid, volume.indexOrigin);
  normaliseWorld(volume);
  volume.scalars = bricksOf(grid.tree(), std::move(leaves), volume.dimensions, volume.indexOrigin, toDensity);
  summariseValues(volume);
  return volume;
}

std::string whyUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why) {
  return fmt::format("grid '{}' of '{}' cannot be rendered: {}", entry.name, file.path().string(), why);
}

[[noreturn]] void failUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why) {
  throw Error(ErrorKind::Input, whyUnusable(file, entry, why));
}

}  // namespace

Volume readVdb(const std::filesystem::path& path, const std::string& gridName, std::uint64_t maximumVoxels,
               const MoreGrids& more) {
  VdbFile file(path);
  const VdbFile::Entry& entry = file.choose(gridName);
  if (const std::string why = whyTypeUnusable(entry.treeType, entry.valueType); !why.empty())
    failUnusable(file, entry, why);
  if (const std::string why = whyTransformUnusable(file.readMetadata(entry)->transform()); !why.empty())
    failUnusable(file, entry, why);
  VdbChannels channels(file, entry, more);

  const openvdb::GridBase::Ptr grid = file.read(entry);
  if (grid->activeVoxelCount() == 0) throw EmptyVolumeError(ErrorKind::Input, whyUnusable(file, entry, kEmptyGridClause));
  const FloatGrid::ConstPtr floats = asFloatGrid(grid);
  const std::string source = fmt::format("{} {}", path.filename().string(), entry.name);
  try {
    channels.read();
    Volume volume = withDensity(*grid, [&](const auto& toDensity) {
      return toVolume(*floats, toDensity, source, channels.bounds(), maximumVoxels);
    });
    channels.addTo(volume);
    volume.warnings.insert(volume.warnings.begin(), file.warnings().begin(), file.warnings().end());
    volume.isLevelSet = grid->getGridClass() == openvdb::GRID_LEVEL_SET;
    orientScan(volume);
    if (file.isFromBlender(entry)) {
      volume.upReason = "Blender wrote the file";
      volume.up = {0.0, 0.0, 1.0};
    }
    return volume;
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory for {}; free some, or resample or crop the volume",
         source);
  }
}

}  // namespace freevoxels
