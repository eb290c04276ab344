#include "engine/splatting/shares.h"

#include <numeric>

namespace freevoxels {

namespace {

/// Appends the shares of one level's chunks, which are covered by these blocks.
void dealLevel(const HierarchyLayout& hierarchy, int level, std::span<const std::uint32_t> covering, std::vector<std::uint32_t>& shares) {
  const int bits = hilbertBits(hierarchy.levels[std::size_t(level)].dimensions);
  std::vector<std::uint64_t> positions;
  positions.reserve(covering.size());
  for (const std::uint32_t block : covering) positions.push_back(hilbertIndex(glm::uvec3(hierarchy.blockAt(block).cell), bits));
  std::vector<std::size_t> order(covering.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::sort(order, {}, [&](std::size_t i) { return positions[i]; });
  const std::size_t first = shares.size();
  shares.resize(first + covering.size());
  for (std::size_t i = 0; i < order.size(); ++i) shares[first + order[i]] = std::uint32_t(shareOf(i));
}

}  // namespace

ChunkShares dealChunks(const HierarchyLayout& hierarchy, std::span<const std::vector<std::uint32_t>> occupied) {
  ChunkShares result;
  for (int level = 0; level <= hierarchy.top(); ++level) {
    result.first.push_back(std::uint32_t(result.shares.size()));
    const int covering = chunkLevel(hierarchy, level);
    dealLevel(hierarchy, covering, occupied[std::size_t(covering)], result.shares);
  }
  return result;
}

}  // namespace freevoxels
