// Arrays as volumes: what files say of themselves is told by the values.

#include "engine/volume/volume_of_scalars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/volume/scan.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

Volume volumeOf(glm::ivec3 size, const std::function<float(glm::ivec3)>& value, const glm::dmat4& indexToWorld = glm::dmat4(1.0),
                bool knowsNoData = false) {
  return volumeOfScalars(ScalarBricks::make(size, value), indexToWorld, knowsNoData ? std::optional(NoData{}) : std::nullopt);
}

/// From 0 on the sides of a box of `size` to 1 in its middle.
float lump(glm::ivec3 size, glm::ivec3 voxel) {
  const glm::vec3 middle = glm::vec3(size - 1) / 2.0f;
  return std::max(0.0f, 1.0f - 1.2f * glm::length((glm::vec3(voxel) - middle) / glm::max(middle, 1.0f)));
}

TEST(VolumeOfScalars, SmokeInABoxOfNothingIsFogAsInAFile) {
  for (const glm::ivec3 size : {glm::ivec3(9, 12, 20), glm::ivec3(40), glm::ivec3(17, 64, 8)}) {
    const Volume volume = volumeOf(size, [&](glm::ivec3 voxel) { return lump(size, voxel); });
    EXPECT_TRUE(volume.isFog);
    EXPECT_FALSE(looksLikeScan(volume));
    EXPECT_LT(volume.activeVoxels, volume.voxelCount());
    ASSERT_EQ(volume.remarks.size(), 1u);
    EXPECT_NE(volume.remarks[0].find("densities"), std::string::npos);
  }
}

TEST(VolumeOfScalars, WhatIsMeasuredIsAScan) {
  const glm::ivec3 size(20, 24, 16);
  for (const float factor : {1000.0f, 255.0f}) {
    const Volume volume = volumeOf(size, [&](glm::ivec3 voxel) { return std::round(factor * lump(size, voxel)); });
    EXPECT_FALSE(volume.isFog) << factor;
    EXPECT_TRUE(looksLikeScan(volume)) << factor;
  }
}

TEST(VolumeOfScalars, PaddingIsNoDataUnlessTheCallerKnowsWhatIs) {
  const glm::ivec3 size(24, 20, 18);
  const auto value = [&](glm::ivec3 voxel) {
    return lump(size, voxel) == 0.0f ? -3024.0f : -1000.0f + 1500.0f * lump(size, voxel) + float((voxel.x * 7 + voxel.y * 5 + voxel.z) % 9);
  };
  const Volume volume = volumeOf(size, value);
  EXPECT_EQ(volume.padding, -3024.0f);
  EXPECT_GE(volume.minimum, -1000.0f);
  ASSERT_EQ(volume.remarks.size(), 1u);
  EXPECT_NE(volume.remarks[0].find("-3024"), std::string::npos);
  EXPECT_TRUE(looksLikeScan(volume));
  const Volume kept = volumeOf(size, value, glm::dmat4(1.0), true);
  EXPECT_EQ(kept.minimum, -3024.0f);
  EXPECT_EQ(kept.activeVoxels, kept.voxelCount());
}

TEST(VolumeOfScalars, UnitsBeyondSinglePrecisionAreScaled) {
  const glm::ivec3 size(9, 10, 11);
  const auto value = [&](glm::ivec3 voxel) { return lump(size, voxel); };
  for (const double spacing : {1e-20, 1e-15, 1e-9, 1.0, 1e8, 1e18, 3e21}) {
    const Volume volume = volumeOf(size, value, latticeTransform(glm::dvec3(spacing, 2.0 * spacing, spacing), glm::dvec3(spacing)));
    EXPECT_GE(volume.voxelSize(), 1e-18) << spacing;
    EXPECT_LE(volume.voxelSize(), 1e9) << spacing;
    EXPECT_NEAR(volume.indexToWorld[1].y / volume.indexToWorld[0].x, 2.0, 1e-9);
    EXPECT_EQ(volume.warnings.empty(), spacing >= 1e-15 && spacing <= 1e8) << spacing;
  }
  const Volume far = volumeOf(size, value, latticeTransform(glm::dvec3(1.0), glm::dvec3(1e15)));
  EXPECT_LT(glm::length(glm::dvec3(far.indexToWorld[3])), 100.0);
  EXPECT_EQ(far.warnings.size(), 1u);
}

TEST(VolumeOfScalars, WhatHasNoExtentOrNoNumbersIsRefused) {
  const auto one = [](glm::ivec3) { return 1.0f; };
  for (const glm::dvec3 spacing : {glm::dvec3(0.0, 1.0, 1.0), glm::dvec3(INFINITY), glm::dvec3(NAN)})
    test::expectRefusal([&] { volumeOf({2, 2, 2}, one, latticeTransform(spacing, glm::dvec3(0.0))); }, ErrorKind::Input, {"no extent"});
  test::expectRefusal([&] { volumeOf({2, 2, 2}, [](glm::ivec3) { return NAN; }); }, ErrorKind::Input, {"2 x 2 x 2", "no data"});
}

}  // namespace
}  // namespace freevoxels
