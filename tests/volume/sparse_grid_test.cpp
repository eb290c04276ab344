// Values of cells, of which only some neighbourhoods take memory.
#include "engine/volume/sparse_grid.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace freevoxels {
namespace {

constexpr int kLongest = 1 << 27;

/// A box with a table of its nodes, one at a node's border, and one whose nodes are hashed.
const std::array<glm::ivec3, 3> kBoxes{glm::ivec3(19, 8, 33), glm::ivec3(8, 16, 64), glm::ivec3(kLongest - 3, 11, kLongest)};

TEST(SparseGrid, KeepsWhatIsSetAtBordersOfNodesAndOfTheBox) {
  for (const glm::ivec3 size : kBoxes) {
    SparseGrid<int> grid(size, -1);
    std::map<std::tuple<int, int, int>, int> expected;
    std::mt19937 generator(1);
    const auto place = [&](int n) {
      const int near = int(generator() % 3) - 1 + 8 * int(generator() % 3);
      return std::clamp(generator() % 2 == 0 ? near : n - 1 - near, 0, n - 1);
    };
    for (int i = 0; i < 300; ++i) {
      const glm::ivec3 cell(place(size.x), place(size.y), place(size.z));
      grid[cell] = expected[{cell.x, cell.y, cell.z}] = i;
    }
    for (int i = 0; i < 3000; ++i) {
      const glm::ivec3 cell(place(size.x), place(size.y), place(size.z));
      const auto found = expected.find({cell.x, cell.y, cell.z});
      ASSERT_EQ(grid.at(cell), found == expected.end() ? -1 : found->second);
    }
    std::size_t visited = 0;
    grid.forEach([&](glm::ivec3 cell, int value) {
      ++visited;
      EXPECT_EQ(value, expected.at({cell.x, cell.y, cell.z}));
    });
    EXPECT_EQ(visited, expected.size());
    EXPECT_EQ(grid.nodes().size(), grid.places().size());
    EXPECT_LT(grid.bytes(), 1u << 20);
  }
}

TEST(SparseGrid, AnEmptyGridHasNoNodes) {
  const SparseGrid<std::uint8_t> grid{glm::ivec3(kLongest)};
  EXPECT_EQ(grid.at(glm::ivec3(kLongest - 1)), 0);
  EXPECT_TRUE(grid.nodes().empty());
  EXPECT_EQ(SparseGrid<int>().dimensions(), glm::ivec3(0));
}

}  // namespace
}  // namespace freevoxels
