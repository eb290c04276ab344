#pragma once
// The candidates of the cut of one process: the blocks of its shares and those above them. A process that draws one of n parts looks
// at about one of n blocks.

#include <vector>

#include "engine/octree/volume_builder.h"
#include "engine/splatting/shares.h"
#include "engine/visibility/cut_candidates.h"

namespace freevoxels {

class ShareCandidates {
 public:
  /// Reads back the lists of all blocks above the voxels, and keeps five bytes of host memory for each.
  ShareCandidates(const Device& device, const BuiltVolume& built, const ChunkShares& dealt);

  /// The candidates of a part, valid until the next call. Those of the last part are kept.
  const CutCandidates& of(const SharePart& part);

 private:
  struct Level {
    std::vector<std::uint32_t> blocks;  ///< occupied, ascending
    std::vector<std::uint8_t> shares;   ///< of each block's children, which all have the same
  };
  /// A byte for each of the level's blocks: which of its children are candidates. `below`: blocks with such children one level below.
  std::vector<std::uint8_t> wantedChildren(const Level& level, const SharePart& part, const std::vector<std::uint32_t>& below) const;

  const Device& device_;
  HierarchyLayout hierarchy_;
  std::vector<Level> levels_;  ///< 1, 2, ...
  SharePart part_{0, 0};       ///< that of `candidates_`; none yet
  CutCandidates candidates_;
};

}  // namespace freevoxels
