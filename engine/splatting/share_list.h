#pragma once
// The blocks that a frame draws, grouped by the share that each belongs to (engine/splatting/shares.h).

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/octree/volume_builder.h"
#include "engine/splatting/shares.h"
#include "engine/splatting/radix_sort.h"
#include "engine/octree/block_list.h"

namespace freevoxels {

/// COMPUTE share_key.comp and those of RadixSort
class ShareList {
 public:
  /// Deals the volume's chunks to the shares. Reads back the lists of blocks that cover chunks.
  ShareList(const Device& device, const BuiltVolume& built);

  /// Groups the first `chunkCount` draw chunks of `drawn`. Within a share blocks keep their order. Where they are all blocks of a
  /// level, `wholeLevel`, they stay grouped for the frames that follow.
  void record(Commands& commands, const DeviceVolume& volume, const BlockList& drawn, std::uint32_t chunkCount,
              std::optional<int> wholeLevel);

  /// When the recorded commands are done: makes the draw chunks of these shares, which chunks() has afterwards. Waits.
  void select(const SharePart& part);
  /// The draw chunks of the selected shares, one share behind the other.
  const BlockList& chunks() const { return selected_; }
  /// uint: the indices of all blocks, grouped by share, to which the draw chunks refer.
  const Buffer& blocks() const { return pairs_.values; }
  /// Of each selected share that has blocks, in ascending order of the shares: how many draw chunks it has.
  const std::vector<std::uint32_t>& chunksOfShares() const { return chunksOfShares_; }

 private:
  void makeRoom(std::uint64_t blocks);

  const Device& device_;
  Pipeline keys_;
  RadixSort sort_;
  SortPairs pairs_;
  Buffer frame_;        ///< shader::ShareFrame
  Buffer shares_;       ///< uint: the share of each chunk, ChunkShares::shares
  Buffer counts_;       ///< uint [kShares]: drawn blocks
  std::optional<int> recordedLevel_, groupedLevel_;  ///< whose blocks are grouped, where they are a level's
  BlockList selected_;  ///< draw chunks alone
  std::vector<std::uint32_t> chunksOfShares_;
};

}  // namespace freevoxels
