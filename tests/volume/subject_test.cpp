// What of a volume a first view shows.
#include "engine/volume/subject.h"

#include <gtest/gtest.h>

#include "tests/splatting/framed_box.h"

namespace freevoxels {
namespace {

using test::obliqueTransform;
using test::transformed;

struct IndexBox {
  glm::dvec3 low{1e9}, high{-1e9};
};

IndexBox boundsOf(const Subject& subject, const Volume& volume) {
  IndexBox box;
  for (const glm::dvec3& point : subject.points) {
    const glm::dvec3 index = transformed(glm::inverse(volume.indexToWorld), point);
    box.low = glm::min(box.low, index);
    box.high = glm::max(box.high, index);
  }
  return box;
}

/// 128 voxels long, with `inside` in 30 x 20 x 10 of them from (40, 8, 4) on.
Volume withBlock(float outside, float inside) {
  return makeVolume({128, 40, 20}, obliqueTransform(), [&](int x, int y, int z) {
    return x >= 40 && x < 70 && y >= 8 && y < 28 && z >= 4 && z < 14 ? inside : outside;
  });
}

void expectBlock(const Subject& subject, const Volume& volume, double slack) {
  const IndexBox box = boundsOf(subject, volume);
  const glm::dvec3 low(39.5, 7.5, 3.5), high(69.5, 27.5, 13.5);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.low[axis], low[axis] + 1e-9);
    EXPECT_GE(box.low[axis], low[axis] - slack);
    EXPECT_GE(box.high[axis], high[axis] - 1e-9);
    EXPECT_LE(box.high[axis], high[axis] + slack);
  }
  const glm::dvec3 centre = transformed(glm::inverse(volume.indexToWorld), subject.centre);
  EXPECT_LT(glm::length(centre - (box.low + box.high) / 2.0), 1e-9);
}

TEST(Content, OfFogIsWhereItIsMoreThanAHaze) {
  const Volume volume = withBlock(0.001f, 1.0f);
  expectBlock(contentOf(volume, {.densityScale = 1.0}), volume, 2.0);
}

TEST(Content, WithATransferFunctionIsWhatItShows) {
  const Volume volume = withBlock(-500.0f, 80.0f);
  TransferFunction function;
  function.opacity = {{0.0f, 0.0f}, {50.0f, 0.5f}};
  function.color = {{0.0f, glm::vec3(1.0f)}};
  expectBlock(contentOf(volume, {.transferFunction = function}), volume, 4.0);
}

TEST(Content, OfATransferFunctionIsMoreThanAHaze) {
  const Volume volume = withBlock(0.001f, 1.0f);
  const TransferFunction function{.opacity = {{0.0f, 0.0f}, {1.0f, 0.5f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = 1.0};
  expectBlock(contentOf(volume, {.transferFunction = function}), volume, 4.0);
}

TEST(Content, OfNothingVisibleIsTheBox) {
  const Volume volume = makeVolume({5, 6, 7}, obliqueTransform(), [](int, int, int) { return 0.0f; });
  EXPECT_EQ(contentOf(volume, {.densityScale = 1.0}).points, boxOf(volume).points);
}

/// Interpolation draws up to a voxel beyond the faces, which is much of a small volume.
TEST(Content, OfFewVoxelsIsAllThatIsDrawnOfThem) {
  for (const glm::ivec3 size :
       {glm::ivec3(1), glm::ivec3(2, 1, 1), glm::ivec3(4, 4, 4), glm::ivec3(9, 12, 15), glm::ivec3(40, 40, 1), glm::ivec3(3, 90, 200)}) {
    const Volume volume = makeVolume(size, obliqueTransform(), [](int, int, int) { return 1.0f; });
    const IndexBox box = boundsOf(contentOf(volume, {.densityScale = 1.0}), volume);
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = size[axis] < 16 ? 1.0 : 0.0;
      EXPECT_NEAR(box.low[axis], -0.5 - reach, 1e-9);
      EXPECT_NEAR(box.high[axis], size[axis] - 0.5 + reach, 1e-9);
    }
  }
}

TEST(Content, FillsMostOfTheImage) {
  const Volume volume = withBlock(0.0f, 1.0f);
  const Camera camera = framingCamera(contentOf(volume, {.densityScale = 1.0}), 35.0, 25.0, 1.0, {});
  double reach = 0.0;
  for (const glm::dvec3& point : contentOf(volume, {.densityScale = 1.0}).points) {
    const glm::dvec3 ndc = transformed(worldToNdc(camera, 1.0), point);
    reach = std::max({reach, std::abs(ndc.x), std::abs(ndc.y)});
  }
  EXPECT_NEAR(reach, 1.0 / 1.13, 1e-6);
}

TEST(Subject, CellsOfASampleCoverTheVolumeHoweverFlatItIs) {
  for (const glm::ivec3 n : {glm::ivec3(1, 8192, 1), glm::ivec3(1, 1, 5000), glm::ivec3(8192, 2, 40), glm::ivec3(700, 8000, 3)}) {
    const int step = (std::max({n.x, n.y, n.z}) + 255) / 256;
    const Volume sample = makeVolume(glm::max(n / step, 1), glm::dmat4(1.0), [](int, int, int) { return 1.0; });
    const ContentCells content = contentCellsOf(n, sample, {});
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(content.cells.dimensions[axis] * content.edge, n[axis], content.edge + step) << n.x << "," << n.y << "," << n.z;
    Volume volume{.dimensions = n};
    const IndexBox box = boundsOf(subjectOf(content, volume), volume);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(box.high[axis], n[axis] - 0.5, step);
  }
}

}  // namespace
}  // namespace freevoxels
