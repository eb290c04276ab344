#pragma once
// The attenuation table of the octree levels above the voxels, each computed from the level below: Subr et al. 2007, Section 3.2,
// Eq. 7.

#include <array>
#include <cstdint>
#include <span>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// Directions that one thread of a GPU computes: fewer directions keep more threads busy, more share the look-up of the children's
/// occupancy. A thread of a CPU device computes all directions of a dispatch.
constexpr std::uint32_t kDirectionsPerGpuThread = 4;

/// COMPUTE table_level.comp: the attenuation table and its bounds; a dispatch a level and
/// kDirectionsPerLevelPass directions.
class TableLevels {
 public:
  TableLevels(const Device& device, const TableSettings& settings);
  TableLevels(const Device& device, const TableSettings& settings, std::uint32_t directionsPerThread);
  /// All work that was submitted before must be complete.
  void record(Commands& commands, const DeviceVolume& volume, std::span<const BlockList> coarse,
              const AttenuationTable& table) const;

 private:
  std::uint32_t perThread_;            ///< directions a thread; a dispatch has as many layers of workgroups as it needs
  std::array<Pipeline, 2> pipelines_;  ///< for children that are blocks; for children that are voxels
};

}  // namespace freevoxels
