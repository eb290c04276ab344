#pragma once
// Extinction, colour and emission of the octree levels above the voxels, each computed from the level below: Subr et al. 2007,
// Section 3.2.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/level_data.h"
#include "engine/octree/level_steps.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// COMPUTE medium_level.comp: extinction, emission, and colours if there is more than one.
class MediumLevels {
 public:
  MediumLevels(const Device& device, const DeviceVolume& volume, LevelDispatches dispatches);
  /// `steps` is of uploadLevelSteps(), with the lists.
  void record(Commands& commands, const DeviceVolume& volume, const Buffer& steps) const;

 private:
  LevelDispatches dispatches_;
  Pipeline fromVoxels_, fromBlocks_;
  Pipeline several_;  ///< for several levels, if they are joined
};

/// Extinction, colours and emission of a level, without its table. Reads back.
LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level);

}  // namespace freevoxels
