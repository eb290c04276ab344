#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: grids in addition to the densities, on their lattice of voxels.

#include <optional>
#include <string>

#include "engine/volume/vdb.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

class VdbChannels {
 public:
  /// Fails with ErrorKind::Input if `file` lacks a required grid of `more`. `density` may be null.
  VdbChannels(VdbFile& file, const VdbFile::Entry* density, const MoreGrids& more);

  const VdbFile::Entry* temperature() const { return temperature_; }
  const VdbFile::Entry* albedo() const { return albedo_; }

  /// Reads the grids, and resamples them where their voxels are others than those of `lattice`.
  void read(const openvdb::math::Transform& lattice);
  /// The box of the active temperatures, where there may be emission without density.
  openvdb::CoordBBox bounds() const;
  /// Drops the voxels beyond a box.
  void clip(const openvdb::CoordBBox& box);
  void addTo(Volume& volume);

 private:
  /// The grid of flames of a fire that does not burn: it has no voxels. Null if there is none.
  const VdbFile::Entry* emptyFlames() const;

  VdbFile& file_;
  bool isTemperatureFound_ = false;                            ///< by the usual names
  bool isTemperatureChosen_ = false, isAlbedoChosen_ = false;  ///< by the usual names, of the reader's own accord
  std::vector<std::string> remarks_;
  const VdbFile::Entry *temperature_ = nullptr, *albedo_ = nullptr;
  openvdb::FloatGrid::ConstPtr temperatures_;
  openvdb::Vec3SGrid::ConstPtr albedos_;
};

}  // namespace freevoxels
