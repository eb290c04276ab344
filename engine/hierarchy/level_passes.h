#pragma once
// The levels of the octree above the voxels, each from the one below: Subr et al. 2007, Section 3.2.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/hierarchy/level_data.h"
#include "engine/splatting/visible_voxels.h"
#include "engine/volume/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// COMPUTE medium_level.comp: extinction, colours where there is more than one, light; a dispatch a level.
class MediumLevels {
 public:
  MediumLevels(const Device& device, const DeviceVolume& volume);
  /// `coarse` lists the blocks of levels 1, 2, ...
  void record(Commands& commands, const DeviceVolume& volume, std::span<const VisibleVoxels> coarse) const;

 private:
  std::array<Pipeline, 2> pipelines_;  ///< from blocks, from voxels
};

/// Of a GPU, which fewer keep busier. All of a dispatch share what they ask of the children's occupancy.
constexpr std::uint32_t kDirectionsPerGpuThread = 4;

/// COMPUTE table_level.comp: the attenuation table and its bounds; a dispatch a level and
/// kDirectionsPerLevelPass directions.
class TableLevels {
 public:
  TableLevels(const Device& device, const TableSettings& settings);
  TableLevels(const Device& device, const TableSettings& settings, std::uint32_t directionsPerThread);
  /// What was recorded before must be done.
  void record(Commands& commands, const DeviceVolume& volume, std::span<const VisibleVoxels> coarse,
              const AttenuationTable& table) const;

 private:
  std::uint32_t perThread_;            ///< directions: as many layers of workgroups as a dispatch needs
  std::array<Pipeline, 2> pipelines_;  ///< from blocks, from voxels
};

/// Extinction, colours and light of a level, without its table. Waits.
LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level);

}  // namespace freevoxels
