#pragma once
// Lists of the occupied blocks of a level of the octree, in ascending order, made on the device. Level 0 has the voxels.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/octree/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

struct BlockList {
  Buffer groupOffsets;  ///< uint: for each workgroup's stretch of blocks how many occupied ones come before it, then the total
  Buffer indices;       ///< uint: of blocks as HierarchyLayout::indexOf counts them, ascending
  Buffer chunks;        ///< shader::ChunkArguments of each chunk that is drawn at once
  std::uint32_t chunkCount = 0;
};

/// Arguments of the dispatch and the draws of `count` blocks of a list from `first` on, as compact_scan.comp writes them.
shader::ChunkArguments drawArguments(std::uint32_t first, std::uint32_t count);

/// COMPUTE compact_count.comp, compact_scan.comp, compact_write.comp: counts, lists and ranks the blocks that
/// OccupancyPass marked as occupied. The count is read back in between, so that a list takes memory for the
/// occupied blocks only.
class CompactionPass {
 public:
  explicit CompactionPass(const Device& device);

  /// Records counting the occupied blocks of the levels 0, 1, ... Their lists get groupOffsets, and `totals` the counts, by level.
  void recordCounts(Commands& commands, const DeviceVolume& volume, std::span<BlockList* const> levels, const Buffer& totals) const;
  /// Allocates a list of `count` blocks, with the arguments of its draw chunks. Fails with ErrorKind::OutOfMemory.
  void allocate(BlockList& list, std::uint64_t count) const;
  /// Records listing and ranking the blocks that recordCounts() counted, after allocate().
  void recordLists(Commands& commands, const DeviceVolume& volume, std::span<BlockList* const> levels) const;

 private:
  const Device& device_;
  Pipeline count_, scan_, write_;
};

/// Sum of the chunks' block counts. Reads back.
std::uint64_t downloadBlockCount(const Device& device, const BlockList& list);

/// The padded indices of the blocks in a list. Reads back.
std::vector<std::uint32_t> downloadBlockList(const Device& device, const BlockList& list);

}  // namespace freevoxels
