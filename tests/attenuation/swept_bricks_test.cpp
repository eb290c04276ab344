// Which bricks and rays the sweep of a light through some planes of a box has to look at.

#include "engine/attenuation/swept_bricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "shaders/gather_interface.h"

namespace freevoxels {
namespace {

constexpr int kEdge = ScalarBricks::kEdge;

/// A box that ends inside of bricks, and begins at brick (2,3,1) of its level.
const VoxelRange kBox{.first = {16, 24, 8}, .end = {16 + 61, 24 + 45, 8 + 77}};

SparseGrid<std::uint8_t> someBricks() {
  SparseGrid<std::uint8_t> bricks(glm::ivec3(16));
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) bricks[glm::ivec3(random() % 16, random() % 16, random() % 16)] = 1;
  return bricks;
}

/// The rays of a plane that a position reads, as rayPlace() of ray_lookup.glsl has it.
std::vector<std::int64_t> raysAround(const FaceRays& fan, glm::dvec3 position, int plane) {
  const double up = fan.firstPlane + fan.direction * plane - fan.farthest;
  const glm::dvec2 side(position[(fan.axis + 1) % 3], position[(fan.axis + 2) % 3]);
  const glm::dvec2 ray = (side - fan.origin - fan.slope * up) / (fan.spacing * (1.0 + fan.convergence * up));
  const glm::ivec2 low = glm::clamp(glm::ivec2(glm::floor(ray)), glm::ivec2(1), fan.rayCount - 3);
  std::vector<std::int64_t> rays;
  for (int j = -1; j < 3; ++j)
    for (int i = -1; i < 3; ++i) rays.push_back(std::int64_t(low.x + i) + std::int64_t(low.y + j) * fan.rayCount.x);
  return rays;
}

void expectRaysAreMarched(const RaySource& source) {
  const SparseGrid<std::uint8_t> bricks = someBricks();
  constexpr int kPlanes = 8;
  for (const FaceRays& fan : faceRays(kBox.extent(), source)) {
    if (fan.planeCount == 0) continue;
    const SweptBricks swept(bricks, kBox, fan);
    for (int begin = 0; begin < fan.planeCount; begin += kPlanes) {
      const int end = std::min(begin + kPlanes, fan.planeCount);
      const std::vector<std::uint32_t> groups = swept.groupsOf(begin, end);
      int planes = 0;
      for (const SweptBricks::Stretch& stretch : swept.stretchesOf(begin, end)) {
        planes += stretch.end - stretch.begin;
        for (const glm::ivec2 brick : stretch.bricks)
          for (int plane = stretch.begin; plane < stretch.end; ++plane)
            for (const glm::ivec2 corner : {glm::ivec2(0), glm::ivec2(7, 0), glm::ivec2(3, 5), glm::ivec2(7)}) {
              glm::dvec3 position;
              position[fan.axis] = fan.firstPlane + fan.direction * plane;
              position[(fan.axis + 1) % 3] = brick.x * kEdge + corner.x;
              position[(fan.axis + 2) % 3] = brick.y * kEdge + corner.y;
              for (const std::int64_t ray : raysAround(fan, position, plane))
                ASSERT_TRUE(std::ranges::binary_search(groups, std::uint32_t(ray / shader::kRaySweepThreads)));
            }
      }
      EXPECT_EQ(planes, end - begin);
    }
  }
}

TEST(SweptBricks, RaysThatPositionsReadAreMarched) {
  expectRaysAreMarched({.place = {0.3, 0.8, 0.5}, .atInfinity = true});
  expectRaysAreMarched({.place = {-1.0, 0.0, 0.0}, .atInfinity = true});
  expectRaysAreMarched({.place = {300.0, -50.0, 20.0}, .atInfinity = false});
  expectRaysAreMarched({.place = {30.2, 20.1, 40.7}, .atInfinity = false});
}

TEST(SweptBricks, WithoutBricksNothingIsMarched) {
  const FaceRays fan = faceRays(kBox.extent(), {.place = {0.0, 0.0, 1.0}, .atInfinity = true})[4];
  ASSERT_GT(fan.planeCount, 0);
  const SweptBricks swept(SparseGrid<std::uint8_t>(glm::ivec3(16)), kBox, fan);
  EXPECT_EQ(swept.mostInALayer(), 0u);
  EXPECT_TRUE(swept.groupsOf(0, 8).empty());
}

TEST(SweptBricks, CellsAreThoseOfTheBricksInTheBox) {
  const SparseGrid<std::uint8_t> bricks = someBricks();
  const Cells cells = cellsOfBricks(bricks, kBox);
  for (glm::ivec3 cell(0); cell.z < cells.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < cells.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < cells.dimensions.x; ++cell.x) {
        const glm::ivec3 brick = (kBox.first + cell * shader::kSkipGroup) / kEdge;
        ASSERT_EQ(cells.at(cell), bricks.at(brick));
      }
  SparseGrid<std::uint8_t> one(glm::ivec3(4));
  one[glm::ivec3(0, 2, 3)] = 1;
  int marked = 0;
  withNeighbours(one).forEach([&](glm::ivec3, std::uint8_t) { ++marked; });
  EXPECT_EQ(marked, 2 * 3 * 2) << "not beyond the grid";
}

}  // namespace
}  // namespace freevoxels
