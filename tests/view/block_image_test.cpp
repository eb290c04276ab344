// Blocks as squares, and what is left out.

#include "apps/view/diagnosis.h"

#include <gtest/gtest.h>

#include <vector>

namespace freevoxels {
namespace {

constexpr glm::vec3 kRed(1.0f, 0.0f, 0.0f), kGreen(0.0f, 1.0f, 0.0f);

/// Looks along -z at a box of 4x4x4 voxels of edge 1, a voxel 10 pixels wide.
Camera camera() {
  return {.position = {1.5, 1.5, 20.0},
          .lookAt = {1.5, 1.5, 1.5},
          .up = {0.0, 1.0, 0.0},
          .orthographic = true,
          .orthographicHeight = 4.0};
}

glm::vec4 pixelAt(const Image& image, int x, int y) {
  return image.pixels[std::size_t(x) + std::size_t(image.size.x) * std::size_t(y)];
}

TEST(BlockImage, TheNearestBlockIsInFrontWhateverTheOrder) {
  const PaintedBlock near{{0, {0, 0, 3}}, kRed}, far{{1, {0, 0, 0}}, kGreen};
  for (const std::vector<PaintedBlock>& blocks : {std::vector{near, far}, std::vector{far, near}}) {
    const Image image = paintBlocks(blocks, glm::ivec3(4), glm::dmat4(1.0), camera(), {40, 40});
    // y is up in the world: cell 0 is at the bottom.
    EXPECT_EQ(pixelAt(image, 5, 35), glm::vec4(kRed, 1.0f));
    EXPECT_GT(pixelAt(image, 15, 35).g, 0.0f);
    EXPECT_GT(pixelAt(image, 5, 25).g, 0.0f);
    EXPECT_EQ(pixelAt(image, 15, 35).r, 0.0f);
    EXPECT_EQ(pixelAt(image, 25, 5), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }
}

TEST(BlockImage, WhatIsBehindTheEyeIsNotThere) {
  Camera inside = camera();
  inside.position.z = 2.0;
  inside.lookAt.z = 0.0;
  const std::vector<PaintedBlock> behind{{{0, {1, 1, 3}}, kRed}};
  const Image image = paintBlocks(behind, glm::ivec3(4), glm::dmat4(1.0), inside, {40, 40});
  for (const glm::vec4& pixel : image.pixels) EXPECT_EQ(pixel, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
}

TEST(BlockImage, AVoxelIsLeftOutWhereNoBlockAroundItIsDrawn) {
  const std::vector<Block> drawn{{0, {5, 5, 5}}, {2, {0, 0, 0}}};
  const std::vector<Block> voxels{{0, {5, 5, 5}}, {0, {5, 5, 4}}, {0, {3, 3, 3}}, {0, {4, 0, 0}}};
  const std::vector<Block> expected{{0, {5, 5, 4}}, {0, {4, 0, 0}}};
  EXPECT_EQ(leftOut(drawn, voxels), expected);
  EXPECT_EQ(leftOut({}, voxels).size(), voxels.size());
}

}  // namespace
}  // namespace freevoxels
