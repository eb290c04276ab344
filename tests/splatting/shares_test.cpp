// The static distribution of blocks: every chunk has one share, shares are even, and neighbours on the Hilbert curve are apart.

#include "engine/splatting/shares.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace freevoxels {
namespace {

/// Blocks of every level that hold one of the voxels for which `holds` is true.
template <typename Holds>
std::vector<std::vector<std::uint32_t>> occupiedBlocks(const HierarchyLayout& hierarchy, const Holds& holds) {
  std::vector<std::set<std::uint32_t>> sets(hierarchy.levels.size());
  const glm::ivec3 size = hierarchy.levels.front().dimensions;
  for (glm::ivec3 v(0); v.z < size.z; ++v.z)
    for (v.y = 0; v.y < size.y; ++v.y)
      for (v.x = 0; v.x < size.x; ++v.x)
        if (holds(v))
          for (int level = 0; level <= hierarchy.top(); ++level) sets[std::size_t(level)].insert(hierarchy.indexOf({level, v >> level}));
  std::vector<std::vector<std::uint32_t>> blocks;
  for (const auto& set : sets) blocks.emplace_back(set.begin(), set.end());
  return blocks;
}

TEST(SharesOfChunks, EveryLevelIsDealtEvenly) {
  const HierarchyLayout hierarchy({130, 70, 95});
  const auto blocks = occupiedBlocks(hierarchy, [](glm::ivec3 v) { return (v.x * 7 + v.y * 3 + v.z) % 5 == 0 && v.x > 40; });
  const ChunkShares dealt = dealChunks(hierarchy, blocks);
  ASSERT_EQ(dealt.first.size(), hierarchy.levels.size());
  std::size_t chunks = 0;
  for (int level = 0; level <= hierarchy.top(); ++level) {
    SCOPED_TRACE(level);
    const std::size_t ofLevel = blocks[std::size_t(chunkLevel(hierarchy, level))].size();
    EXPECT_EQ(dealt.first[std::size_t(level)], chunks);
    std::map<std::uint32_t, std::size_t> counts;
    for (std::size_t i = chunks; i < chunks + ofLevel; ++i) {
      ASSERT_LT(dealt.shares[i], std::uint32_t(kShares));
      ++counts[dealt.shares[i]];
    }
    for (const auto& [share, count] : counts) EXPECT_LE(count, (ofLevel + kShares - 1) / kShares);
    EXPECT_EQ(counts.size(), std::min<std::size_t>(ofLevel, kShares));
    chunks += ofLevel;
  }
  EXPECT_EQ(dealt.shares.size(), chunks);
}

TEST(SharesOfChunks, ChunksInHilbertOrderGoToAllPartsInTurn) {
  const HierarchyLayout hierarchy({64, 64, 64});  // 8 x 8 x 8 chunks of voxels, two for each share
  const auto blocks = occupiedBlocks(hierarchy, [](glm::ivec3) { return true; });
  const ChunkShares dealt = dealChunks(hierarchy, blocks);
  const std::vector<glm::ivec3> curve = hilbertOrder({8, 8, 8});
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::uint32_t block = hierarchy.indexOf({kChunkLevels, curve[i]});
    const auto place = std::size_t(std::ranges::find(blocks[kChunkLevels], block) - blocks[kChunkLevels].begin());
    EXPECT_EQ(int(dealt.shares[place]), shareOf(i));
  }
  for (const int count : {2, 8, 128, 256}) {
    std::vector<int> turns(std::size_t(count), 0);
    for (int i = 0; i < count; ++i)
      for (int part = 0; part < count; ++part) turns[std::size_t(part)] += SharePart{part, count}.holds(shareOf(std::uint64_t(i))) ? 1 : 0;
    EXPECT_EQ(turns, std::vector<int>(std::size_t(count), 1)) << count;
  }
}

TEST(SharesOfChunks, PartsHoldEveryShareOnce) {
  for (int count : {1, 2, 3, 7, 100, 256})
    for (int share = 0; share < kShares; ++share) {
      int holders = 0;
      for (int index = 0; index < count; ++index) holders += SharePart{index, count}.holds(share) ? 1 : 0;
      EXPECT_EQ(holders, 1) << share << " of " << count;
    }
}

}  // namespace
}  // namespace freevoxels
