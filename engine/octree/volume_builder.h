#pragma once
// Builds everything that frames need of a volume except the attenuation table: extinction, colours and
// emission of all occupied blocks of the octree, and their lists.

#include <vector>

#include "engine/core/stages.h"
#include "engine/octree/medium_levels.h"

namespace freevoxels {

/// The occupied blocks of every level. Those of level 0 are BuiltVolume::visible.
struct LevelLists {
  std::vector<BlockList> coarse;  ///< of levels 1, 2, ...
  Buffer steps;                   ///< filled by uploadLevelSteps(); none if there is only level 0

  const BlockList& of(int level, const BlockList& voxels) const {
    return level == 0 ? voxels : coarse[std::size_t(level) - 1];
  }
};

struct BuiltVolume {
  DeviceVolume volume;
  BlockList visible;  ///< the occupied voxels
  LevelLists lists;

  /// Whether the blocks are built, or only the scalars for classification after interpolation (buildBlocks).
  bool hasBlocks() const { return !volume.stored.empty(); }
};

/// Which levels of the octree have blocks. With Voxels the levels above them are empty.
enum class BuiltLevels { All, Voxels };

/// Uploads the scalars if they are classified after interpolation, otherwise builds the blocks. Blocks until
/// the device is done, and adds the times of its passes to `times`. Fails with ErrorKind::OutOfMemory, before
/// allocating if the box is too large.
BuiltVolume buildVolume(const Device& device, const Volume& volume, const Classification& classification,
                        std::vector<StageTime>& times, const Progress& progress = {}, BuiltLevels levels = BuiltLevels::All);

/// Builds the classified voxels and blocks, their ranks and lists for a volume of which there are only
/// scalars: lights, levels of detail, splats and the table need them. Blocks until the device is done. Fails
/// with ErrorKind::OutOfMemory.
void buildBlocks(const Device& device, const Volume& volume, const Classification& classification, BuiltVolume& built,
                 std::vector<StageTime>& times, const Progress& progress = {}, BuiltLevels levels = BuiltLevels::All);

}  // namespace freevoxels
