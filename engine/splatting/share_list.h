#pragma once
// The blocks that a frame draws, grouped by the share that each belongs to (engine/splatting/shares.h).

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/octree/volume_builder.h"
#include "engine/splatting/radix_sort.h"
#include "engine/splatting/share_candidates.h"
#include "engine/octree/block_list.h"

namespace freevoxels {

/// COMPUTE share_key.comp and those of RadixSort
class ShareList {
 public:
  /// Distributes the chunks of the volume, which must outlive the list, to the shares. Reads back the lists of blocks that cover chunks.
  ShareList(const Device& device, const BuiltVolume& built);

  /// The candidates of a cut for these shares; null: all blocks, of which all shares are drawn.
  const CutCandidates* candidates(const SharePart& part);

  /// Groups the blocks of `drawn`, at most `mostBlocks`, by share. Within a share blocks keep their order. If they are all blocks of a
  /// level, `wholeLevel`, they stay grouped for later frames.
  void record(Commands& commands, const DeviceVolume& volume, const BlockList& drawn, std::uint64_t mostBlocks,
              std::optional<int> wholeLevel);

  /// After the recorded commands are complete: makes the draw chunks of these shares, which chunks() then
  /// has. Blocks until the device is done.
  void select(const SharePart& part);
  /// The draw chunks of the selected shares, one share behind the other.
  const BlockList& chunks() const { return selected_; }
  /// uint: the indices of all blocks, grouped by share, to which the draw chunks refer.
  const Buffer& blocks() const { return pairs_.values; }
  /// The number of draw chunks of each selected share that has blocks, in ascending order of the shares.
  const std::vector<std::uint32_t>& chunksOfShares() const { return chunksOfShares_; }

 private:
  void makeRoom(std::uint64_t blocks);

  const Device& device_;
  const BuiltVolume& built_;
  ChunkShares dealt_;
  std::optional<ShareCandidates> candidates_;
  Pipeline keys_;
  RadixSort sort_;
  SortPairs pairs_;
  Buffer frame_;        ///< shader::ShareFrame
  Buffer shares_;       ///< uint: the share of each chunk, ChunkShares::shares
  Buffer counts_;       ///< uint [kShares]: number of drawn blocks
  std::optional<int> recordedLevel_, groupedLevel_;  ///< the level whose blocks are grouped, if they are those of a level
  BlockList selected_;  ///< draw chunks only
  std::vector<std::uint32_t> chunksOfShares_;
};

}  // namespace freevoxels
