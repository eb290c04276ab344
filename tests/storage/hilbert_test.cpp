#include "engine/octree/hilbert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

namespace freevoxels {
namespace {

int distance(glm::uvec3 a, glm::uvec3 b) {
  const glm::ivec3 d = glm::abs(glm::ivec3(a) - glm::ivec3(b));
  return d.x + d.y + d.z;
}

TEST(Hilbert, IndexAndCellAreInverseForAllCellsOfACube) {
  for (const int bits : {1, 2, 3, 5}) {
    const std::uint64_t count = std::uint64_t(1) << 3 * bits;
    std::vector<bool> seen(count, false);
    for (std::uint64_t index = 0; index < count; ++index) {
      const glm::uvec3 cell = hilbertCell(index, bits);
      ASSERT_LT(std::max({cell.x, cell.y, cell.z}), 1u << bits);
      ASSERT_EQ(hilbertIndex(cell, bits), index) << "bits " << bits;
      const std::size_t place = cell.x | std::size_t(cell.y) << bits | std::size_t(cell.z) << 2 * bits;
      ASSERT_FALSE(seen[place]);
      seen[place] = true;
    }
  }
}

TEST(Hilbert, IndexAndCellAreInverseForTheMostBits) {
  constexpr std::uint32_t kLast = (1u << kMaxHilbertBits) - 1;
  for (const glm::uvec3 cell : {glm::uvec3(0), glm::uvec3(kLast), glm::uvec3(kLast, 0, 1), glm::uvec3(123456, 2000000, 765432)})
    EXPECT_EQ(hilbertCell(hilbertIndex(cell, kMaxHilbertBits), kMaxHilbertBits), cell);
}

TEST(Hilbert, ConsecutiveIndicesAreNeighbouringCells) {
  for (const int bits : {1, 2, 3, 5})
    for (std::uint64_t index = 1; index < std::uint64_t(1) << 3 * bits; ++index)
      ASSERT_EQ(distance(hilbertCell(index - 1, bits), hilbertCell(index, bits)), 1) << "bits " << bits << " index " << index;
}

TEST(Hilbert, FirstEightToTheKIndicesFillACube) {
  constexpr int kBits = 5;
  for (int k = 1; k <= kBits; ++k) {
    glm::uvec3 highest(0);
    for (std::uint64_t index = 0; index < std::uint64_t(1) << 3 * k; ++index)
      highest = glm::max(highest, hilbertCell(index, kBits));
    EXPECT_EQ(highest, glm::uvec3((1u << k) - 1)) << "k " << k;
  }
}

TEST(Hilbert, OrderOfABoxHasEveryCellOnceAlongTheCurve) {
  const glm::ivec3 box(5, 9, 2);
  const std::vector<glm::ivec3> order = hilbertOrder(box);
  ASSERT_EQ(order.size(), 90u);
  EXPECT_EQ(hilbertBits(box), 4);
  std::set<std::array<int, 3>> distinct;
  for (std::size_t i = 0; i < order.size(); ++i) {
    distinct.insert({order[i].x, order[i].y, order[i].z});
    if (i == 0) continue;
    EXPECT_LT(hilbertIndex(glm::uvec3(order[i - 1]), 4), hilbertIndex(glm::uvec3(order[i]), 4));
  }
  EXPECT_EQ(distinct.size(), order.size());
}

TEST(Hilbert, BitsAreTheLeastWhoseCubeHoldsTheBox) {
  EXPECT_EQ(hilbertBits({1, 1, 1}), 1);
  EXPECT_EQ(hilbertBits({2, 1, 2}), 1);
  EXPECT_EQ(hilbertBits({3, 1, 1}), 2);
  EXPECT_EQ(hilbertBits({1, 64, 65}), 7);
}

TEST(Hilbert, SharesDifferByAtMostOneChunk) {
  std::array<int, kShares> counts{};
  for (std::uint64_t position = 0; position < 1000; ++position) ++counts[std::size_t(shareOf(position))];
  const auto [least, most] = std::ranges::minmax(counts);
  EXPECT_EQ(least, 3);
  EXPECT_EQ(most, 4);
}

}  // namespace
}  // namespace freevoxels
