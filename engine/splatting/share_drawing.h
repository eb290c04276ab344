#pragma once
// A frame that is drawn share by share (engine/splatting/shares.h) into fixed-point sums, whose bits do not depend on how the shares are
// divided among processes: Subr et al. 2007, Section 4.4.

#include "engine/core/stages.h"
#include "engine/splatting/accumulate_pass.h"
#include "engine/splatting/share_list.h"

namespace freevoxels {

class ShareDrawing {
 public:
  /// All frames must be of the same volume.
  ShareDrawing(const Device& device, const BuiltVolume& built, bool withDistance)
      : device_(device), withDistance_(withDistance), list_(device, built), accumulate_(device, withDistance) {}

  struct Inputs {
    SplatPass& splats;
    SplatPass::Inputs drawing;  ///< all blocks of the frame; none may be left out as hidden by others
    std::uint64_t mostBlocks;  ///< an upper bound of their number
    std::optional<int> wholeLevel;  ///< the level, if these are all blocks of a level
    const FrameConstants& frame;
    const FrameTargets& targets;
    FixedSums layout;           ///< the image, the rectangle and the digits; without values
  };
  /// Submits `commands`, which make the list of blocks, together with the commands recorded here. Then draws
  /// the shares of `part` one after the other: each into cleared float targets in the order of the list, from
  /// which it is added to the sums. Blocks until the device is done.
  FixedSums draw(Commands& commands, Inputs inputs, const SharePart& part, std::vector<StageTime>& times, const Progress& progress);

  /// The blocks that a cut of these shares has to look at; null: all.
  const CutCandidates* candidates(const SharePart& part) { return list_.candidates(part); }
  bool hasDistance() const { return withDistance_; }

 private:
  const Device& device_;
  bool withDistance_;
  ShareList list_;
  AccumulatePass accumulate_;
};

}  // namespace freevoxels
