// Integrals of transfer functions, and the voxels that are averaged with them.
#include "engine/volume/transfer_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/volume/packed_light.h"
#include "engine/volume/procedural.h"
#include "engine/volume/voxel_classifier.h"
#include "shaders/gather_interface.h"

namespace freevoxels {
namespace {

/// Extinction 0 but for a tent of this height between scalars 0.4 and 0.6; colour (s, 0, 1 - s).
TransferFunction tent(float opacity) {
  return {.opacity = {{0.4f, 0.0f}, {0.5f, opacity}, {0.6f, 0.0f}}, .color = {{0.0f, {0, 0, 1}}, {1.0f, {1, 0, 0}}}, .unitDistance = 1.0};
}

TEST(TransferIntegral, MeanIsTheAreaOverTheChangeOfTheScalar) {
  const float opacity = 1e-3f;  // so small that extinction is as linear as opacity
  const TransferIntegral integral(tent(opacity), 0.0f, 1.0f);
  const double area = 0.1 * opacity;
  EXPECT_NEAR(integral.mean(0.0, 1.0).a, area, 1e-3 * area);
  EXPECT_NEAR(integral.mean(1.0, 0.0).a, area, 1e-3 * area);
  EXPECT_NEAR(integral.mean(0.3, 0.5).a, 0.5 * area / 0.2, 1e-3 * area);
  EXPECT_NEAR(integral.mean(0.0, 1.0).r, 0.5 * area, 1e-3 * area);
  EXPECT_EQ(integral.mean(0.7, 0.9), glm::dvec4(0.0));
  EXPECT_NEAR(integral.mean(0.5, 0.5).a, opacity, 1e-2 * opacity);
}

TEST(TransferIntegral, KnowsWhereThereIsNothing) {
  const TransferIntegral integral(tent(0.5f), 0.0f, 1.0f);
  EXPECT_FALSE(integral.isOccupied(0.0, 0.39));
  EXPECT_FALSE(integral.isOccupied(0.61, 1.0));
  EXPECT_TRUE(integral.isOccupied(0.0, 1.0));
  EXPECT_TRUE(integral.isOccupied(0.5, 0.5));
}

TEST(TransferTable, CodesAreEquallySpacedAndZeroHasNoData) {
  const TransferTable table(tent(0.5f), 0.0f, 2.0f);
  EXPECT_EQ(table.code(kInactiveVoxel), 0);
  EXPECT_EQ(table.code(0.0f), 1);
  EXPECT_EQ(table.code(2.0f), 65535);
  EXPECT_EQ(table.code(-1.0f), 1);
  EXPECT_NEAR(table.code(1.0f), 32768, 1);
}

TEST(TransferTable, FewOutliersDoNotTakeThePrecisionOfTheRest) {
  const TransferTable table(tent(0.5f), -1e9f, 1e9f);
  EXPECT_GT(table.code(0.5f) - table.code(0.45f), 300);
}

TEST(TransferTable, TexelsAreTheIntegralAndItsChange) {
  const std::vector<glm::vec4> texels = TransferTable(tent(0.5f), 0.0f, 1.0f).texels(64.0);
  ASSERT_EQ(texels.size(), 2u * shader::kTransferIntervals);
  for (std::size_t i = 0; i + 2 < texels.size(); i += 2)
    EXPECT_NEAR(texels[i].a + texels[i + 1].a, texels[i + 2].a, 1e-3f * (1.0f + texels[i + 2].a)) << i;
}

TEST(VoxelClassifier, AThinPeakBetweenTwoVoxelsIsInBoth) {
  const Volume volume = makeVolume({2, 1, 1}, glm::dmat4(1.0), [](int x, int, int) { return double(x); });
  Classification classification;
  classification.transferFunction = tent(1e-3f);
  const VoxelClassifier classifier(classification, volume);
  // One of six lines reaches half of the peak.
  const double expected = 0.5 * 0.1 * 1e-3 / 0.5 / 6.0;
  EXPECT_NEAR(classifier.at({0, 0, 0}).extinction, expected, 1e-2 * expected);
  EXPECT_NEAR(classifier.at({1, 0, 0}).extinction, expected, 1e-2 * expected);
}

TEST(VoxelClassifier, OneScalarAllOverIsWhatTheFunctionSays) {
  const Volume volume = makeVolume({3, 3, 3}, glm::dmat4(1.0), [](int, int, int) { return 0.47; });
  Classification classification;
  classification.transferFunction = tent(0.5f);
  EXPECT_EQ(VoxelClassifier(classification, volume).at({1, 1, 1}).extinction, classify(classification, 0.47f).extinction);
}

TEST(VoxelClassifier, BricksAreTheSameAsSingleVoxels) {
  const glm::ivec3 size(19, 10, 9);
  const Volume volume = makeVolume(size, glm::dmat4(1.0), [](int x, int y, int z) {
    return (x * 7 + y * 3 + z * 5) % 11 == 0 ? kInactiveVoxel : std::sin(0.3 * x) * std::cos(0.5 * y + 0.2 * z);
  });
  Classification classification;
  classification.transferFunction = tent(0.5f);
  const VoxelClassifier classifier(classification, volume);
  constexpr std::size_t kVoxels = std::tuple_size_v<ScalarBricks::Brick>;
  std::size_t held = 0;
  for (std::size_t brick = 0; brick < volume.scalars.count(); ++brick) {
    std::vector<float> extinction(kVoxels);
    std::vector<std::uint32_t> colors(kVoxels);
    classifier.classifyBrick(brick, extinction, colors);
    for (std::size_t i = 0; i < kVoxels; ++i) {
      const glm::ivec3 voxel = volume.scalars.firstVoxel(brick) + glm::ivec3(int(i) % 8, int(i) / 8 % 8, int(i) / 64);
      if (glm::any(glm::greaterThanEqual(voxel, size))) continue;
      const ClassifiedVoxel expected = classifier.at(voxel);
      ASSERT_EQ(extinction[i], float(expected.extinction));
      if (expected.extinction > 0.0) {
        ASSERT_EQ(unpackColor(colors[i]), expected.color);
        ++held;
      }
    }
  }
  EXPECT_GT(held, 100u);
}

}  // namespace
}  // namespace freevoxels
