#pragma once
// Extinction, colour and emission of the octree levels above the voxels, each computed from the level below: Subr et al. 2007,
// Section 3.2.

#include "engine/octree/device_volume.h"
#include "engine/octree/level_data.h"
#include "engine/octree/level_steps.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// COMPUTE medium_level.comp: extinction, emission, and colours if there is more than one.
class MediumLevels {
 public:
  MediumLevels(const Device& device, const DeviceVolume& volume, LevelDispatches dispatches);
  /// uploadLevelSteps() has filled `steps` after the blocks were listed.
  void record(Commands& commands, const DeviceVolume& volume, const Buffer& steps) const;

 private:
  LevelPipelines pipelines_;
};

/// Extinction, colours and emission of a level, without its table. Reads back.
LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level);

}  // namespace freevoxels
