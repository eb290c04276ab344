#include "engine/octree/hierarchy_layout.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

BlockBox boxOf(const Block& block, glm::ivec3 dimensions) {
  const glm::ivec3 first = block.cell * block.edge();
  return {first, glm::min(dimensions - first, glm::ivec3(block.edge()))};
}

HierarchyLayout::HierarchyLayout(glm::ivec3 dimensions) {
  std::uint64_t blocks = 0;
  for (glm::ivec3 size = dimensions;; size = (size + 1) / 2) {
    levels.emplace_back(size);
    first.push_back(std::uint32_t(blocks));
    blocks += words(int(levels.size()) - 1) * shader::kBlocksPerWord;
    if (glm::all(glm::lessThanEqual(size, glm::ivec3(1)))) break;
  }
  FV_CHECK_LE(levels.size(), std::size_t(shader::kMaximumLevels));
}

std::uint64_t HierarchyLayout::paddedBlocks() const {
  std::uint64_t sum = 0;
  for (int level = 0; level <= top(); ++level) sum += words(level);
  return sum * shader::kBlocksPerWord;
}

std::uint32_t HierarchyLayout::indexOf(const Block& block) const {
  const GridLayout& level = levels[std::size_t(block.level)];
  const glm::uvec3 cell(block.cell);
  return first[std::size_t(block.level)] + cell.x +
         std::uint32_t(level.rowPitch) * (cell.y + std::uint32_t(level.dimensions.y) * cell.z);
}

Block HierarchyLayout::blockAt(std::uint32_t index) const {
  const auto above = std::ranges::upper_bound(first, index);
  const auto level = std::size_t(above - first.begin()) - 1;
  const GridLayout& grid = levels[level];
  const std::uint32_t inLevel = index - first[level], row = inLevel / std::uint32_t(grid.rowPitch);
  return {int(level),
          glm::ivec3(inLevel % std::uint32_t(grid.rowPitch), row % std::uint32_t(grid.dimensions.y),
                     row / std::uint32_t(grid.dimensions.y))};
}

std::uint64_t HierarchyLayout::words(int level) const {
  return (levels[std::size_t(level)].paddedVoxels() + shader::kBlocksPerWord - 1) / shader::kBlocksPerWord;
}

}  // namespace freevoxels
