#pragma once
// The list of voxels, or blocks of a level of the octree, that have something to draw, in ascending order,
// made on the device.

#include <cstdint>
#include <vector>

#include "engine/octree/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

struct BlockList {
  Buffer groupOffsets;  ///< uint: counts, then offsets, of each workgroup's stretch of blocks, and the total
  Buffer indices;       ///< uint: as of HierarchyLayout::indexOf, ascending
  Buffer chunks;        ///< shader::ChunkArguments of each draw chunk
  std::uint32_t chunkCount = 0;
};

/// Room for all blocks of a level (hierarchy_layout.h) that can hold anything.
BlockList makeBlockList(const Device& device, const DeviceVolume& volume, int level = 0);

/// COMPUTE compact_count.comp, compact_scan.comp, compact_write.comp: lists what OccupancyPass found, and
/// ranks it.
class CompactionPass {
 public:
  explicit CompactionPass(const Device& device);
  void record(Commands& commands, const DeviceVolume& volume, const BlockList& visible,
              int level = 0) const;

 private:
  Pipeline count_, scan_, write_;
};

/// Sum of the chunks' splat counts. Reads back.
std::uint64_t downloadBlockCount(const Device& device, const BlockList& visible);

/// The list: padded indices. Reads back.
std::vector<std::uint32_t> downloadBlockList(const Device& device, const BlockList& visible);

}  // namespace freevoxels
