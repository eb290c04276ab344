#pragma once
// Internal to the vdb_*.cpp files, as it includes OpenVDB: grids beside that of the densities, on its
// lattice.

#include <optional>
#include <string>

#include "engine/volume/vdb.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

class VdbChannels {
 public:
  /// Fails with ExitCode::Input where `file` has not what is asked for, or not on the lattice of `density`.
  VdbChannels(VdbFile& file, const VdbFile::Entry& density, const MoreGrids& more);

  void read();
  /// Of the temperatures: where there is light there may be no density.
  openvdb::CoordBBox bounds() const;
  void addTo(Volume& volume) const;

 private:
  void checkLattice(const VdbFile::Entry& entry, const VdbFile::Entry& density) const;

  VdbFile& file_;
  const VdbFile::Entry *temperature_ = nullptr, *albedo_ = nullptr;
  openvdb::FloatGrid::ConstPtr temperatures_;
  openvdb::Vec3SGrid::ConstPtr albedos_;
};

}  // namespace freevoxels
