// Which bricks a part of a gathered frame marches.

#include <gtest/gtest.h>

#include "engine/gathering/gather_part.h"

namespace freevoxels {
namespace {

/// A level of bricks, every third of which is empty.
struct Bricks {
  GatherVolume::BrickCells cells;
  std::vector<shader::GatherLevel> levels;

  explicit Bricks(glm::ivec3 size) {
    std::uint32_t number = 0;
    const int count = size.x * size.y * size.z;
    for (int i = 0; i < count; ++i) cells.numbers.push_back(i % 3 == 0 ? 0 : ++number);
    Cells met(2 * size);
    std::ranges::fill(met.values, 1);
    cells.met.push_back(std::move(met));
    cells.bricks.push_back(size);
    cells.cellsPerBrick.push_back(2);
    levels.push_back({.dimensions = 8 * size, .firstCell = 0, .cellStrides = {size.x, size.x * size.y}, .firstSkip = 0});
  }
  PartCells of(const SharePart& part) const { return partCells(cells, levels, part); }
};

TEST(PartCells, EveryBrickBelongsToExactlyOnePart) {
  const Bricks bricks({9, 14, 11});
  for (const int count : {1, 2, 7, kShares}) {
    std::vector<int> owners(bricks.cells.numbers.size(), 0);
    for (int index = 0; index < count; ++index) {
      const PartCells part = bricks.of({index, count});
      for (std::size_t i = 0; i < owners.size(); ++i) {
        EXPECT_EQ(part.numbers[i] & ~shader::kOwnBrick, bricks.cells.numbers[i]);
        if ((part.numbers[i] & shader::kOwnBrick) != 0) ++owners[i];
      }
    }
    for (std::size_t i = 0; i < owners.size(); ++i) EXPECT_EQ(owners[i], bricks.cells.numbers[i] != 0 ? 1 : 0) << i;
  }
}

TEST(PartCells, OnlyCellsNearOwnBricksAreMarched) {
  const Bricks bricks({16, 16, 16});
  const PartCells whole = bricks.of({}), share = bricks.of({5, kShares});
  const std::ptrdiff_t marched = std::ranges::count(share.skips, 0);
  EXPECT_GT(std::ranges::count(whole.skips, 0), 10 * marched);
  const auto own = std::ranges::count_if(share.numbers, [](std::uint32_t number) { return (number & shader::kOwnBrick) != 0; });
  EXPECT_GT(own, 0);
  EXPECT_GE(marched, 8 * own);
  EXPECT_LE(marched, 27 * own);  // a brick's 2^3 cells, and those before them
}

}  // namespace
}  // namespace freevoxels
