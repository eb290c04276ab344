#pragma once
// The levels of the octree above the voxels, each from the one below: Subr et al. 2007, Section 3.2.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/hierarchy/level_data.h"
#include "engine/splatting/visible_voxels.h"
#include "engine/volume/device_volume.h"

namespace freevoxels {

/// The blocks of every level that hold anything; level 0 is somebody else's, the list of visible voxels.
struct LevelLists {
  std::vector<VisibleVoxels> coarse;  ///< of levels 1, 2, ...
  std::vector<std::uint64_t> counts;  ///< of levels 0, 1, 2, ...

  const VisibleVoxels& of(int level, const VisibleVoxels& voxels) const {
    return level == 0 ? voxels : coarse[std::size_t(level) - 1];
  }
};

/// COMPUTE medium_level.comp: extinction, and colours where there is more than one; a dispatch a level.
class MediumLevels {
 public:
  MediumLevels(const Device& device, const DeviceVolume& volume);
  void record(Commands& commands, const DeviceVolume& volume) const;

 private:
  std::array<Pipeline, 2> pipelines_;  ///< from blocks, from voxels
};

/// COMPUTE table_level.comp: the attenuation table and its bounds; a dispatch a level and direction.
class TableLevels {
 public:
  TableLevels(const Device& device, const TableSettings& settings);
  void record(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table) const;

 private:
  std::array<Pipeline, 2> pipelines_;  ///< from blocks, from voxels
};

/// Runs MediumLevels and lists the blocks; waits. The times are added to `times`.
LevelLists makeMediumLevels(const Device& device, const DeviceVolume& volume, const VisibleVoxels& voxels,
                            std::vector<StageTime>& times);

/// Extinction and colours of a level, without its table. Waits.
LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level);

}  // namespace freevoxels
