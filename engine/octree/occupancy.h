#pragma once
// Which blocks of the octree are occupied: Subr et al. 2007, Section 3.2, for sparse volumes.

#include <cstdint>
#include <vector>

#include "engine/octree/device_bricks.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/level_steps.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// COMPUTE occupied_voxels.comp and occupied_blocks.comp: the occupancy masks of all levels. CompactionPass
/// makes their ranks.
class OccupancyPass {
 public:
  /// `emission` says whether the volume emits light.
  OccupancyPass(const Device& device, bool emission, LevelDispatches dispatches);
  /// Marks the voxels of a batch of bricks; the first batch clears the masks.
  void recordVoxels(Commands& commands, const DeviceVolume& volume, const DeviceBricks& bricks,
                    bool first) const;
  /// Marks the blocks, after the voxels of all batches. uploadLevelSteps() has filled `steps`; lists are not needed.
  void recordBlocks(Commands& commands, const DeviceVolume& volume, const Buffer& steps) const;

 private:
  Pipeline voxels_;
  LevelPipelines blocks_;
};

/// COMPUTE expand_voxels.comp: expands the extinction of the occupied voxels of a slab or a box to a dense
/// grid, for the sweeps.
class ExpandPass {
 public:
  explicit ExpandPass(const Device& device);
  /// Expands `planes` planes across z, starting at plane `first`, including the padding, into `extinction`.
  /// Returns the padded index of the first voxel of that buffer.
  std::uint32_t record(Commands& commands, const DeviceVolume& volume, int first, int planes,
                       const Buffer& extinction) const;
  /// Expands a box, x fastest, with 0 beyond the volume. The x of `first` and of `extent` must be multiples
  /// of 4.
  void recordBox(Commands& commands, const DeviceVolume& volume, glm::ivec3 first, glm::ivec3 extent,
                 const Buffer& extinction) const;

 private:
  Pipeline pipeline_;
};

/// The indices (x fastest, without padding) of the occupied blocks of a level, in the order of their ranks.
/// Reads back.
std::vector<std::uint32_t> downloadStored(const Device& device, const DeviceVolume& volume, int level);

/// Values of `count` blocks: those of the listed blocks, 0 for the others.
template <typename Value>
std::vector<Value> scatterToDense(const std::vector<Value>& byRank, const std::vector<std::uint32_t>& blocks,
                             std::uint64_t count) {
  std::vector<Value> values(count);
  for (std::size_t i = 0; i < blocks.size(); ++i) values[blocks[i]] = byRank[i];
  return values;
}

}  // namespace freevoxels
