#pragma once
// The bricks of a gathered volume: which cells of its octree are bricks, how bricks are numbered, and which cells rays skip.

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/octree/hierarchy_layout.h"
#include "engine/volume/coarse_cells.h"
#include "engine/vulkan/buffer.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

class GatherBricks {
 public:
  /// Bricks of one level with successive numbers.
  struct Range {
    int level;
    std::uint32_t first, end;
    std::uint32_t count() const { return end - first; }
  };
  /// What was made of the bricks.
  struct Made {
    std::uint32_t levels = 0;  ///< a bit for each level
    std::uint32_t bricks = 0;  ///< in these levels, all bricks with lower numbers
  };

  /// Without bricks but the empty one. `scalars`: whether voxels are classified after interpolation.
  GatherBricks(const Device& device, const HierarchyLayout& hierarchy, bool scalars);
  /// Finds the bricks around the cells `met` of 1 << shader::kSkipLevels voxels, and the cells to skip. Bricks that are there keep their
  /// numbers, whether they are still needed or not.
  void include(const Cells& met);

  /// The number of bricks with the empty one, whose number is 0.
  std::uint32_t count() const { return std::uint32_t(places_.size()); }
  const std::vector<shader::GatherLevel>& levels() const { return levels_; }
  /// Number of cells that may be bricks, along the axes.
  glm::ivec3 cells(int level) const { return cells_[std::size_t(level)]; }
  /// Numbers by level and cell (GatherLevel).
  const std::vector<std::uint32_t>& numbers() const { return numbers_; }

  /// Whether of the levels `wanted`, a bit for each, or of those that were made, some brick was not.
  bool lack(const Made& made, std::uint32_t wanted) const {
    return (wanted & ~made.levels) != 0 || (made.levels != 0 && made.bricks < count());
  }
  /// Calls record(range) for all such bricks but the empty one, which then count as made.
  template <typename Record>
  void forEachMissing(Made& made, std::uint32_t wanted, const Record& record) const {
    for (const Range& range : ranges_) {
      const bool hasLevel = (made.levels >> range.level & 1u) != 0;
      if (!hasLevel && (wanted >> range.level & 1u) == 0) continue;
      const std::uint32_t first = hasLevel ? std::max(range.first, made.bricks) : range.first;
      if (first < range.end) record(Range{range.level, first, range.end});
    }
    made = {.levels = made.levels | wanted, .bricks = count()};
  }

  // On the device:
  const TexelView& numberTexels() const { return numberTexels_; }
  const Buffer& numberBuffer() const { return numberBuffer_; }
  const TexelView& placeTexels() const { return placeTexels_; }  ///< ivec4: each brick's first block
  const TexelView& skips() const { return skipTexels_; }         ///< bytes by level and cell: number of groups of slices to skip

 private:
  const Device& device_;
  const HierarchyLayout& hierarchy_;
  const bool scalars_;
  std::vector<shader::GatherLevel> levels_;
  std::vector<glm::ivec3> cells_;       ///< by level
  std::vector<std::uint32_t> numbers_;  ///< 0 where a cell is no brick
  std::vector<glm::ivec4> places_;      ///< by brick
  std::vector<Range> ranges_;
  Buffer numberBuffer_, placeBuffer_, skipBuffer_;
  TexelView numberTexels_, placeTexels_, skipTexels_;
};

}  // namespace freevoxels
