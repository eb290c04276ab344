#include "engine/hierarchy/hierarchy_layout.h"

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

std::vector<std::uint64_t> countStored(const HierarchyLayout& hierarchy, std::vector<bool> holding) {
  std::vector<std::uint64_t> counts;
  for (std::size_t level = 0;; ++level) {
    counts.push_back(std::uint64_t(std::ranges::count(holding, true)));
    if (level + 1 == hierarchy.levels.size()) return counts;
    const glm::ivec3 n = hierarchy.levels[level].dimensions, parents = hierarchy.levels[level + 1].dimensions;
    const auto index = [](glm::ivec3 cell, glm::ivec3 size) {
      return std::size_t(cell.x) +
             std::size_t(size.x) * (std::size_t(cell.y) + std::size_t(size.y) * std::size_t(cell.z));
    };
    std::vector<bool> above(std::size_t(hierarchy.levels[level + 1].voxels()), false);
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x)
          if (holding[index({x, y, z}, n)]) above[index(glm::ivec3(x, y, z) / 2, parents)] = true;
    holding = std::move(above);
  }
}

std::uint64_t HierarchyLayout::words(int level) const {
  return (levels[std::size_t(level)].paddedVoxels() + shader::kBlocksPerWord - 1) / shader::kBlocksPerWord;
}

}  // namespace freevoxels
