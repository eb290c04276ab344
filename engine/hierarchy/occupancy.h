#pragma once
// Which blocks of the octree hold anything: Subr et al. 2007, Section 3.2, but no more of it than there is.

#include <cstdint>
#include <vector>

#include "engine/volume/device_volume.h"

namespace freevoxels {

/// COMPUTE occupied_voxels.comp and occupied_blocks.comp: the masks of all levels. Their ranks are
/// CompactionPass's.
class OccupancyPass {
 public:
  explicit OccupancyPass(const Device& device);
  void record(Commands& commands, const DeviceVolume& volume, const DenseVoxels& voxels) const;

 private:
  Pipeline voxels_, blocks_;
};

/// COMPUTE expand_voxels.comp: the extinction of all voxels again, for the sweeps.
class ExpandPass {
 public:
  explicit ExpandPass(const Device& device);
  /// Into `extinction`, which has room for a multiple of kBlocksPerWord voxels.
  void record(Commands& commands, const DeviceVolume& volume, const Buffer& extinction) const;

 private:
  Pipeline pipeline_;
};

/// The blocks of a level that hold anything, in the order of their ranks: indices x fastest, without padding.
/// Reads back.
std::vector<std::uint32_t> downloadStored(const Device& device, const DeviceVolume& volume, int level);

/// Values of `count` blocks from those of the listed ones, 0 of the others.
template <typename Value>
std::vector<Value> spreadOut(const std::vector<Value>& byRank, const std::vector<std::uint32_t>& blocks,
                             std::uint64_t count) {
  std::vector<Value> values(count);
  for (std::size_t i = 0; i < blocks.size(); ++i) values[blocks[i]] = byRank[i];
  return values;
}

}  // namespace freevoxels
