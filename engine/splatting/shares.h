#pragma once
// The static distribution of an octree's blocks among the processes of a distributed render: Subr et al.
// 2007, Section 4.4. Blocks are distributed in chunks, level by level along the Hilbert curve, to a fixed
// number of shares (kShares, engine/octree/hilbert.h), whatever the number of processes. Process I of N
// draws the shares from 256 I / N to 256 (I + 1) / N. Gathered frames are divided by rows of samples instead (gather_rows.h).

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/hilbert.h"

namespace freevoxels {

/// A chunk of level l is the part that a block of level l + kChunkLevels covers: 8 x 8 x 8 blocks of level l.
/// Levels so near to the top that there is no such block have one chunk, which the top block covers.
inline constexpr int kChunkLevels = 3;

/// The level of the blocks that cover the chunks of `level`.
inline int chunkLevel(const HierarchyLayout& hierarchy, int level) {
  return std::min(level + kChunkLevels, hierarchy.top());
}

/// The share of every occupied chunk.
struct ChunkShares {
  std::vector<std::uint32_t> first;   ///< by level: index of the level's first chunk in `shares`
  std::vector<std::uint32_t> shares;  ///< the chunks of a level in ascending order of the indices of the blocks that cover them
};

/// `occupied[level]` has the ascending indices (HierarchyLayout::indexOf) of the level's occupied blocks;
/// only the levels that chunkLevel returns are read.
ChunkShares dealChunks(const HierarchyLayout& hierarchy, std::span<const std::vector<std::uint32_t>> occupied);

/// The shares that one of `count` processes draws, which follow each other. 0 <= index < count <= kShares.
struct SharePart {
  int index = 0, count = 1;

  int first() const { return kShares * index / count; }
  int end() const { return kShares * (index + 1) / count; }
  bool holds(int share) const { return first() <= share && share < end(); }
  bool operator==(const SharePart&) const = default;
};

}  // namespace freevoxels
