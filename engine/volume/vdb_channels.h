#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: grids in addition to the densities, on the same
// lattice.

#include <optional>
#include <string>

#include "engine/volume/vdb.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

class VdbChannels {
 public:
  /// Fails with ErrorKind::Input if `file` lacks a grid of `more`, or has it on another lattice than
  /// `density`.
  VdbChannels(VdbFile& file, const VdbFile::Entry& density, const MoreGrids& more);

  void read();
  /// The box of the active temperatures, where there may be emission without density.
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
