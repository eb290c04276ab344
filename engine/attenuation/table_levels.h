#pragma once
// The attenuation table of the octree levels above the voxels, each computed from the level below: Subr et al. 2007, Section 3.2,
// Eq. 7.

#include <cstddef>
#include <cstdint>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/level_steps.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// Directions that one thread of a GPU computes: fewer directions keep more threads busy, more share the look-up of the children's
/// occupancy. A thread of a CPU device computes all directions of a dispatch.
constexpr std::uint32_t kDirectionsPerGpuThread = 4;

/// COMPUTE table_level.comp: the attenuation table and its bounds. A dispatch has up to kDirectionsPerLevelPass directions.
class TableLevels {
 public:
  TableLevels(const Device& device, const TableSettings& settings);
  TableLevels(const Device& device, const TableSettings& settings, std::uint32_t directionsPerThread, LevelDispatches dispatches);
  /// All work that was submitted before must be complete. uploadLevelSteps() has filled `steps` after the blocks were listed.
  void record(Commands& commands, const DeviceVolume& volume, const Buffer& steps, const AttenuationTable& table) const;

 private:
  void recordDirections(Commands& commands, const DeviceVolume& volume, const Buffer& steps, const AttenuationTable& table,
                        shader::LevelRange levels, std::size_t first) const;

  std::uint32_t perThread_;  ///< directions a thread; a dispatch has as many layers of workgroups as it needs
  LevelPipelines pipelines_;
};

}  // namespace freevoxels
