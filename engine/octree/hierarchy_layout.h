#pragma once
// The octree over the voxels and its place in memory: Subr et al. 2007, Section 3.2. The blocks of all levels
// share one index space. A block's index is the position of its occupancy bit; the medium and the table are
// stored by rank.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/grid_layout.h"

namespace freevoxels {

/// A block of the octree. Cell c of level l covers the voxels from c 2^l to (c + 1) 2^l - 1 along each axis.
/// Level 0 are the voxels.
struct Block {
  int level = 0;
  glm::ivec3 cell{0};

  bool operator==(const Block&) const = default;
  /// Number of voxels along an edge.
  int edge() const { return 1 << level; }
  Block parent() const { return {level + 1, cell / 2}; }
};

/// The part of a block that is inside the volume: voxels `first` to `first` + `extent` - 1.
struct BlockBox {
  glm::ivec3 first{0}, extent{1};

  /// In index space.
  glm::dvec3 centre() const { return glm::dvec3(first) + 0.5 * glm::dvec3(extent - 1); }
  double voxels() const { return double(extent.x) * double(extent.y) * double(extent.z); }
};
BlockBox boxOf(const Block& block, glm::ivec3 dimensions);

struct HierarchyLayout {
  /// Level 0 first; each level has half the dimensions of the one below, rounded up, and the last is 1x1x1.
  std::vector<GridLayout> levels;
  std::vector<std::uint32_t> first;  ///< index of each level's first block, a multiple of kBlocksPerWord

  explicit HierarchyLayout(glm::ivec3 dimensions);
  HierarchyLayout() = default;
  int top() const { return int(levels.size()) - 1; }
  /// Number of blocks of all levels, including the padding.
  std::uint64_t paddedBlocks() const;
  /// Number of occupancy words of a level.
  std::uint64_t words(int level) const;

  /// The index of a block. Only this function and shaders/blocks.glsl compute it.
  std::uint32_t indexOf(const Block& block) const;
  /// The block at an index, which must not be that of padding.
  Block blockAt(std::uint32_t index) const;
};

/// Bytes of the bounds of `storedBlocks` blocks of a level above the voxels, for each direction of the
/// attenuation table.
inline std::uint64_t boundBytes(std::uint64_t storedBlocks) {
  return (storedBlocks + shader::kBoundBlocks - 1) / shader::kBoundBlocks;
}

}  // namespace freevoxels
