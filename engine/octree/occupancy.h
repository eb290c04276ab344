#pragma once
// Which blocks of the octree hold anything: Subr et al. 2007, Section 3.2, but no more of it than there is.

#include <cstdint>
#include <vector>

#include "engine/octree/device_bricks.h"
#include "engine/octree/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// COMPUTE occupied_voxels.comp and occupied_blocks.comp: the masks of all levels. Their ranks are
/// CompactionPass's.
class OccupancyPass {
 public:
  /// Of volumes that send out light, or of others.
  OccupancyPass(const Device& device, bool emission);
  /// The voxels of a batch of bricks, of which the first begins with none.
  void recordVoxels(Commands& commands, const DeviceVolume& volume, const DeviceBricks& bricks,
                    bool first) const;
  /// After those of all batches.
  void recordBlocks(Commands& commands, const DeviceVolume& volume) const;

 private:
  Pipeline voxels_, blocks_;
};

/// COMPUTE expand_voxels.comp: the extinction of all voxels of a slab or a box again, for the sweeps.
class ExpandPass {
 public:
  explicit ExpandPass(const Device& device);
  /// Of `planes` planes across z from `first` on, with the padding: into `extinction`, which begins with the
  /// voxel whose index is returned.
  std::uint32_t record(Commands& commands, const DeviceVolume& volume, int first, int planes,
                       const Buffer& extinction) const;
  /// Of a box, x fastest, 0 beyond the volume. The x of `first` and of `extent` are multiples of 4.
  void recordBox(Commands& commands, const DeviceVolume& volume, glm::ivec3 first, glm::ivec3 extent,
                 const Buffer& extinction) const;

 private:
  Pipeline pipeline_;
};

/// The blocks of a level that hold anything, in the order of their ranks: indices x fastest, without padding.
/// Reads back.
std::vector<std::uint32_t> downloadStored(const Device& device, const DeviceVolume& volume, int level);

/// Values of `count` blocks from those of the listed ones, 0 of the others.
template <typename Value>
std::vector<Value> scatterToDense(const std::vector<Value>& byRank, const std::vector<std::uint32_t>& blocks,
                             std::uint64_t count) {
  std::vector<Value> values(count);
  for (std::size_t i = 0; i < blocks.size(); ++i) values[blocks[i]] = byRank[i];
  return values;
}

}  // namespace freevoxels
