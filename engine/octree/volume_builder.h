#pragma once
// A volume to what every frame needs of it but the attenuation table: extinction and colours of all blocks of
// the octree that hold anything, and their lists.

#include <vector>

#include "engine/core/stages.h"
#include "engine/octree/medium_levels.h"

namespace freevoxels {

/// The blocks of every level that hold anything; of level 0 they are BuiltVolume::visible.
struct LevelLists {
  std::vector<BlockList> coarse;  ///< of levels 1, 2, ...

  const BlockList& of(int level, const BlockList& voxels) const {
    return level == 0 ? voxels : coarse[std::size_t(level) - 1];
  }
};

struct BuiltVolume {
  DeviceVolume volume;
  BlockList visible;  ///< the voxels
  LevelLists lists;

  /// Whether there is anything but the scalars for classification after interpolation: see buildBlocks.
  bool hasBlocks() const { return !volume.stored.empty(); }
};

/// Scalars, if voxels are classified after interpolation, else blocks too. Waits. Adds the times of its passes to `times`.
/// Fails with ExitCode::OutOfMemory, where the box is too large before allocating.
BuiltVolume buildVolume(const Device& device, const Volume& volume, const Classification& classification,
                        std::vector<StageTime>& times, const Progress& progress = {});

/// What lights, levels of detail, splats and the table need of a volume that has scalars: its classified voxels and blocks,
/// their ranks and lists. Waits. Fails with ExitCode::OutOfMemory.
void buildBlocks(const Device& device, const Volume& volume, const Classification& classification, BuiltVolume& built,
                 std::vector<StageTime>& times, const Progress& progress = {});

}  // namespace freevoxels
