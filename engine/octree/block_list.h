#pragma once
// Lists of the occupied voxels, or of the occupied blocks of a level of the octree, in ascending order, made
// on the device.

#include <cstdint>
#include <vector>

#include "engine/octree/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

struct BlockList {
  Buffer groupOffsets;  ///< uint: first the counts, then the offsets of each workgroup's blocks in the list, and the total
  Buffer indices;       ///< uint: indices as of HierarchyLayout::indexOf, ascending
  Buffer chunks;        ///< shader::ChunkArguments of each chunk that is drawn at once
  std::uint32_t chunkCount = 0;
};

/// Allocates a list for all blocks of a level that can be occupied.
BlockList makeBlockList(const Device& device, const DeviceVolume& volume, int level = 0);

/// COMPUTE compact_count.comp, compact_scan.comp, compact_write.comp: lists the blocks that OccupancyPass
/// marked as occupied, and writes their ranks.
class CompactionPass {
 public:
  explicit CompactionPass(const Device& device);
  void record(Commands& commands, const DeviceVolume& volume, const BlockList& visible,
              int level = 0) const;

 private:
  Pipeline count_, scan_, write_;
};

/// The number of blocks in a list. Reads back, so it blocks until the device is idle.
std::uint64_t downloadBlockCount(const Device& device, const BlockList& visible);

/// The padded indices of the blocks in a list. Reads back.
std::vector<std::uint32_t> downloadBlockList(const Device& device, const BlockList& visible);

}  // namespace freevoxels
