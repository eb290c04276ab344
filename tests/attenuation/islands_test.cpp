// Boxes around what lies apart, and what these have between them and a light.
#include "engine/attenuation/islands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/attenuation/island_shadows.h"

namespace freevoxels {
namespace {

SparseGrid<std::uint8_t> marked(glm::ivec3 bricks, const std::vector<glm::ivec3>& cells) {
  SparseGrid<std::uint8_t> grid(bricks);
  for (const glm::ivec3 cell : cells) grid[cell] = 1;
  return grid;
}

TEST(Islands, NeighbouringNodesHaveOneBoxAndOthersTheirOwn) {
  const glm::ivec3 size(100'003, 1'000, 800'000);
  const SparseGrid<std::uint8_t> bricks = marked((size + 7) / 8, {{7, 0, 0}, {8, 9, 0}, {12'500, 124, 99'999}});
  std::vector<VoxelRange> islands = islandsOf(bricks, size);
  ASSERT_EQ(islands.size(), 2u);
  std::ranges::sort(islands, {}, [](const VoxelRange& box) { return box.first.x; });
  EXPECT_EQ(islands[0], (VoxelRange{{56, 0, 0}, {72, 80, 8}}));
  EXPECT_EQ(islands[1], (VoxelRange{{100'000, 992, 799'992}, {100'003, 1'000, 800'000}}));
}

TEST(Islands, BoxesThatOverlapAreJoined) {
  // A ring of nodes, and a brick in its middle, two nodes from it.
  std::vector<glm::ivec3> cells{{20, 20, 0}};
  for (int i = 0; i < 40; ++i)
    for (const glm::ivec3 cell : {glm::ivec3(i, 0, 0), {i, 39, 0}, {0, i, 0}, {39, i, 0}}) cells.push_back(cell);
  const std::vector<VoxelRange> islands = islandsOf(marked(glm::ivec3(40), cells), glm::ivec3(320));
  ASSERT_EQ(islands.size(), 1u);
  EXPECT_EQ(islands[0], (VoxelRange{glm::ivec3(0), {320, 320, 8}}));
}

TEST(Islands, ManyBecomeFewer) {
  std::vector<glm::ivec3> cells;
  for (int i = 0; i < 3000; ++i) cells.emplace_back(16 * i, 0, 0);
  const std::vector<VoxelRange> islands = islandsOf(marked({48'000, 1, 1}, cells), {384'000, 8, 8});
  EXPECT_LE(islands.size(), kMaxIslands);
  EXPECT_EQ(islands.front().first.y, 0);
}

TEST(Islands, AnIslandBehindAnotherHasItsDepthInFront) {
  const std::vector<VoxelRange> boxes{{glm::ivec3(0), glm::ivec3(16)}, {{0, 0, 5000}, {16, 16, 5016}}, {{9000, 0, 5000}, {9016, 16, 5016}}};
  for (const RaySource source : {RaySource{.place = {0.0, 0.0, -1.0}, .atInfinity = true}, RaySource{.place = {7.5, 7.5, -40.0}}}) {
    std::vector<IslandRays> islands;
    for (const VoxelRange& box : boxes) {
      const glm::dvec3 place = source.atInfinity ? source.place : source.place - glm::dvec3(box.first);
      IslandRays& rays = islands.emplace_back(IslandRays{.box = box, .fans = faceRays(box.extent(), {place, source.atInfinity})});
      for (std::size_t face = 0; face < 6; ++face) rays.depths[face].assign(rays.fans[face].rays(), 0.25f);
    }
    const IslandShadows shadows(source, islands);
    constexpr int kAscendingZ = 5;
    EXPECT_TRUE(shadows.before(0, kAscendingZ).empty());
    EXPECT_TRUE(shadows.before(2, kAscendingZ).empty());
    const std::vector<float> before = shadows.before(1, kAscendingZ);
    const glm::ivec2 count = islands[1].fans[kAscendingZ].rayCount;
    ASSERT_EQ(before.size(), std::size_t(count.x) * std::size_t(count.y));
    EXPECT_FLOAT_EQ(before[std::size_t(count.x / 2 + count.x * (count.y / 2))], 0.25f);
  }
}

}  // namespace
}  // namespace freevoxels
