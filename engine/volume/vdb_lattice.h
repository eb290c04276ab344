#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: grids on the lattice of voxels of another grid.

#include <openvdb/tools/GridTransformer.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

/// Whether the voxels of two lattices are in the same places, up to rounding, as far as `box` reaches.
bool isSameLattice(const openvdb::math::Transform& a, const openvdb::math::Transform& b, const openvdb::CoordBBox& box);

/// The grid `entry` of `file`, or a copy that is resampled where its voxels are others than those of `lattice`, which a remark says. Fails
/// with ErrorKind::OutOfMemory where that would have too many voxels.
template <typename Grid>
std::shared_ptr<const Grid> onLattice(std::shared_ptr<const Grid> grid, const openvdb::math::Transform& lattice, const VdbFile& file,
                                      const VdbFile::Entry& entry, std::vector<std::string>& remarks) {
  if (isSameLattice(grid->transform(), lattice, grid->evalActiveVoxelBoundingBox())) return grid;
  const double growth = std::abs(grid->transform().baseMap()->determinant() / lattice.baseMap()->determinant());
  constexpr double kMostVoxels = 1e10;
  if (double(grid->activeVoxelCount()) * growth > kMostVoxels)
    fail(ErrorKind::OutOfMemory, "grid '{}' of '{}' has voxels that are {:.0f} times as large as those of the density: resample it first",
         entry.name, file.path().string(), growth);
  auto resampled = std::make_shared<Grid>(grid->background());
  resampled->setTransform(lattice.copy());
  openvdb::tools::resampleToMatch<openvdb::tools::BoxSampler>(*grid, *resampled);
  remarks.push_back(fmt::format("grid '{}' is resampled to the voxels of the densities", entry.name));
  return resampled;
}

}  // namespace freevoxels
