#pragma once
// What became of the blocks that a frame of splats considered.

#include <cstdint>
#include <vector>

namespace freevoxels {

/// Numbers of blocks of all levels that were considered: those of the coarsest level, and those whose parent
/// was opened.
struct CutCounts {
  std::uint64_t considered = 0;      ///< the sum of the others
  std::uint64_t empty = 0;           ///< not occupied
  std::uint64_t outside = 0;         ///< left out with all blocks in them: outside of the image
  std::uint64_t hidden = 0;          ///< left out with all blocks in them: hidden, as the table says
  std::uint64_t opened = 0;          ///< replaced by their children
  std::vector<std::uint64_t> drawn;  ///< number of drawn blocks by level, level 0 first
};

}  // namespace freevoxels
