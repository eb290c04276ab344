#pragma once
// The blocks that a cut has to look at where it does not draw all of a volume.

#include <cstdint>
#include <vector>

#include "engine/vulkan/buffer.h"

namespace freevoxels {

/// A closed set: with a block it has all blocks above it. The block of the coarsest level is always in it.
struct CutCandidates {
  struct Level {
    Buffer parents;   ///< uint: the blocks of the level above that have children in the set, ascending
    Buffer children;  ///< uint: for each parent, a bit for each child that is in the set (cut_frame.glsl has their order)
    std::uint32_t parentCount = 0;
    std::uint64_t mostBlocks = 0;  ///< at least the number of occupied blocks of the level in the set
  };
  std::vector<Level> levels;  ///< by level, without the coarsest
};

}  // namespace freevoxels
