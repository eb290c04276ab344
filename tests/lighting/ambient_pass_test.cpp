// The cells that ambient light is found in.
#include "engine/lighting/ambient_pass.h"

#include <gtest/gtest.h>

#include "engine/volume/cell_extinctions.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

TEST(AmbientCells, AreNoMoreThanThereMayBe) {
  EXPECT_EQ(ambientCellEdge({100, 100, 100}, false), 1);
  EXPECT_EQ(ambientCellEdge({128, 128, 128}, false), 2);
  EXPECT_EQ(ambientCellEdge({200, 200, 200}, false), 2);
  EXPECT_EQ(ambientCellEdge({100, 100, 100}, true), 2);
  EXPECT_EQ(ambientCellEdge({512, 512, 512}, false), 8);
  EXPECT_EQ(ambientCellEdge({455, 602, 493}, false), 8);
  EXPECT_EQ(ambientCellEdge({2, 3, 4'000'000}, false), 4);
}

/// Beyond the box, and where there is no data, cells are empty.
TEST(AmbientCells, HaveTheMeanExtinctionOfTheirVoxels) {
  const auto ramp = [](int x, int y, int z) { return x == 2 ? double(kInactiveVoxel) : x + 10.0 * y + 100.0 * z; };
  const Volume volume = makeVolume(glm::ivec3(3, 2, 2), glm::dmat4(1.0), ramp);
  const std::vector<float> cells = cellExtinctions(volume, {.densityScale = 2.0}, 2);
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_FLOAT_EQ(cells[0], 2.0f * (0.5f + 5.0f + 50.0f));
  EXPECT_EQ(cells[1], 0.0f);
}

TEST(AmbientCells, OfATransferFunctionHaveItsExtinctions) {
  const Volume volume = makeVolume(glm::ivec3(4, 1, 1), glm::dmat4(1.0), [](int x, int, int) { return double(x); });
  Classification classification;
  classification.transferFunction = TransferFunction{.opacity = {{1.0f, 0.0f}, {2.0f, 0.5f}}, .color = {{0.0f, glm::vec3(1.0f)}}};
  const std::vector<float> cells = cellExtinctions(volume, classification, 1);
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0], 0.0f);
  EXPECT_EQ(cells[1], 0.0f);
  EXPECT_NEAR(cells[2], std::log(2.0), 1e-3);
  EXPECT_NEAR(cells[3], std::log(2.0), 1e-3);
}

/// As means of coarse levels have them, in which voxels without data count as 0.
TEST(AmbientCells, ScalarsBeyondTheVolumesRangeHaveTheExtinctionOfItsEnd) {
  for (const auto& [low, high] : {std::pair(10000.0f, 10001.0f), std::pair(-1000.0f, -600.0f), std::pair(5.0f, 5.0f)}) {
    Volume volume = makeVolume(glm::ivec3(4, 1, 1), glm::dmat4(1.0), [](int x, int, int) { return x == 0 ? -1e30 : x == 1 ? 1e30 : 0.0; });
    volume.minimum = low;
    volume.maximum = high;
    Classification classification;
    classification.transferFunction = TransferFunction{.opacity = {{low, 0.2f}, {high + 0.5f, 0.5f}}, .color = {{0.0f, glm::vec3(1.0f)}}};
    const auto extinctionOf = [&](float scalar) { return float(classify(classification, scalar).extinction); };
    const std::vector<float> cells = cellExtinctions(volume, classification, 1);
    EXPECT_FLOAT_EQ(cells[0], extinctionOf(low));
    EXPECT_FLOAT_EQ(cells[1], extinctionOf(high));
    EXPECT_FLOAT_EQ(cells[2], extinctionOf(low > 0.0f ? low : high));
  }
}

TEST(AmbientCells, DensitiesOfAnyScaleHaveExtinctionsOfNumbers) {
  const Volume volume = makeVolume(glm::ivec3(3, 1, 1), glm::dmat4(1.0), [](int x, int, int) { return 0.5 * x; });
  for (const double scale : {1e30, 1e40, 1e300}) {
    const std::vector<float> cells = cellExtinctions(volume, {.densityScale = scale}, 1);
    EXPECT_EQ(cells[0], 0.0f);
    EXPECT_FLOAT_EQ(cells[1], scale == 1e30 ? 5e29f : float(kMaximumExtinction));
    EXPECT_EQ(cells[2], float(kMaximumExtinction));
  }
}

TEST(AmbientCells, ScalarsOfTheSmallestAndTheLargestRangesHaveTheirExtinctions) {
  for (const auto& [low, high] : {std::pair(-3e38f, 3e38f), std::pair(-1e38f, 3e38f), std::pair(0.0f, 1e-44f), std::pair(1e-38f, 1.001e-38f)}) {
    SCOPED_TRACE(low);
    const Volume volume = makeVolume(glm::ivec3(3, 1, 1), glm::dmat4(1.0), [&](int x, int, int) { return x == 1 ? high : low; });
    Classification classification;
    classification.transferFunction = TransferFunction{.opacity = {{low, 0.2f}, {high, 0.5f}}, .color = {{0.0f, glm::vec3(1.0f)}}};
    const std::vector<float> cells = cellExtinctions(volume, classification, 1);
    EXPECT_FLOAT_EQ(cells[0], float(classify(classification, low).extinction));
    EXPECT_FLOAT_EQ(cells[1], float(classify(classification, high).extinction));
    EXPECT_FLOAT_EQ(cells[2], cells[0]);
  }
}

}  // namespace
}  // namespace freevoxels
