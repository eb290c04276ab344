#include "engine/volume/coarse_volume.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

float numbered(int x, int y, int z) {
  return float(1 + x + 10 * y + 100 * z);
}

Volume numberedVolume(glm::ivec3 dimensions, const glm::dmat4& indexToWorld = glm::dmat4(1.0)) {
  return makeVolume(dimensions, indexToWorld, numbered);
}

glm::dmat4 obliqueTransform() {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), {5.0, -2.0, 1.0});
  return glm::scale(glm::rotate(moved, 0.7, glm::dvec3(0.6, 0.0, 0.8)), {0.5, 2.0, 1.5});
}

TEST(CoarseVolume, AVoxelIsTheMeanOfItsBlock) {
  const Volume coarse = coarseVolume(numberedVolume({4, 6, 8}), 2, WithoutData::Zero);
  ASSERT_EQ(coarse.dimensions, glm::ivec3(2, 3, 4));
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 2; ++x)
        EXPECT_FLOAT_EQ(coarse.scalar(x, y, z), numbered(2 * x, 2 * y, 2 * z) + 0.5f * 111.0f);
  EXPECT_EQ(coarse.activeVoxels, 24u);
  EXPECT_FLOAT_EQ(coarse.minimum, 1.0f + 55.5f);
}

TEST(CoarseVolume, UnevenEdgesAreMeansOfWhatIsThere) {
  const Volume coarse = coarseVolume(numberedVolume({5, 4, 3}), 3, WithoutData::Zero);
  ASSERT_EQ(coarse.dimensions, glm::ivec3(2, 2, 1));
  EXPECT_FLOAT_EQ(coarse.scalar(0, 0, 0), numbered(1, 1, 1));
  EXPECT_FLOAT_EQ(coarse.scalar(1, 0, 0), numbered(3, 1, 1) + 0.5f);
  EXPECT_FLOAT_EQ(coarse.scalar(0, 1, 0), numbered(1, 3, 1));
  EXPECT_FLOAT_EQ(coarse.scalar(1, 1, 0), numbered(3, 3, 1) + 0.5f);
}

TEST(CoarseVolume, AVoxelStandsInTheMiddleOfItsBlock) {
  for (const int factor : {2, 3}) {
    const Volume fine = numberedVolume({6, 6, 6}, obliqueTransform());
    const Volume coarse = coarseVolume(fine, factor, WithoutData::Zero);
    const glm::dvec3 cell(1.0, 0.0, 1.0);
    glm::dvec3 middle(0.0);
    for (int z = 0; z < factor; ++z)
      for (int y = 0; y < factor; ++y)
        for (int x = 0; x < factor; ++x)
          middle +=
              glm::dvec3(fine.indexToWorld * glm::dvec4(double(factor) * cell + glm::dvec3(x, y, z), 1.0));
    middle /= double(factor * factor * factor);
    EXPECT_LT(glm::distance(glm::dvec3(coarse.indexToWorld * glm::dvec4(cell, 1.0)), middle), 1e-12);
    EXPECT_NEAR(coarse.voxelSize(), factor * fine.voxelSize(), 1e-12);
  }
}

TEST(CoarseVolume, WithoutDataIsZeroToDensitiesAndNothingToValues) {
  const Volume fine = makeVolume({4, 2, 2}, glm::dmat4(1.0), [](int x, int y, int z) {
    return x < 2 && y == 0 && z == 0 ? 8.0f : kInactiveVoxel;  // two of eight voxels; and a block of none
  });
  const Volume densities = coarseVolume(fine, 2, WithoutData::Zero);
  EXPECT_EQ(densities.scalar(0, 0, 0), 2.0f);
  EXPECT_EQ(densities.scalar(1, 0, 0), kInactiveVoxel);
  EXPECT_EQ(densities.activeVoxels, 1u);
  const Volume values = coarseVolume(fine, 2, WithoutData::Ignored);
  EXPECT_EQ(values.scalar(0, 0, 0), 8.0f);
  EXPECT_EQ(values.scalar(1, 0, 0), kInactiveVoxel);
}

TEST(CoarseVolume, TemperaturesAndAlbedosComeAlong) {
  Volume fine = numberedVolume({2, 2, 2});
  fine.temperature = TemperatureGrid{.name = "heat"};
  fine.temperature->values = ScalarBricks::make({2, 2, 2}, [](glm::ivec3 voxel) {
    return voxel.x == 0 ? 1000.0f + 100.0f * float(voxel.y) : kInactiveVoxel;
  });
  fine.albedo = AlbedoGrid{.name = "Cd"};
  for (std::size_t c = 0; c < 3; ++c)
    fine.albedo->values[c] = ScalarBricks::make(
        {2, 2, 2}, [&](glm::ivec3 voxel) { return voxel.z == 0 ? 0.25f * float(c) : kInactiveVoxel; });
  const Volume coarse = coarseVolume(fine, 2, WithoutData::Zero);
  ASSERT_TRUE(coarse.temperature && coarse.albedo);
  EXPECT_EQ(coarse.temperature->name, "heat");
  EXPECT_EQ(coarse.temperature->values.at(glm::ivec3(0)), 1050.0f);
  EXPECT_EQ(coarse.temperature->activeVoxels, 1u);
  EXPECT_EQ(coarse.albedo->name, "Cd");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(coarse.albedo->values[c].at(glm::ivec3(0)), 0.25f * float(c));
}

TEST(ClippedVolume, VoxelsInTheBoxKeepValueAndPlaceAndOthersAreGone) {
  Volume volume = makeVolume({20, 13, 9}, glm::dmat4(2.0), [](int x, int y, int z) { return float(x + 100 * y + 10000 * z); });
  volume.albedo = AlbedoGrid{.name = "albedo", .values = {volume.scalars, volume.scalars, volume.scalars}};
  const Volume part = clippedVolume(volume, VoxelBox{{3, 5, 2}, {100, 9, 4}});
  EXPECT_EQ(part.dimensions, glm::ivec3(17, 5, 3)) << "the box is cut to that of the volume";
  EXPECT_EQ(part.activeVoxels, 17u * 5u * 3u);
  for (const glm::ivec3 voxel : {glm::ivec3(0), glm::ivec3(16, 4, 2), glm::ivec3(7, 1, 1)}) {
    const glm::ivec3 whole = voxel + glm::ivec3(3, 5, 2);
    EXPECT_EQ(part.scalars.at(voxel), volume.scalars.at(whole));
    EXPECT_EQ(part.albedo->values[1].at(voxel), volume.scalars.at(whole));
    EXPECT_EQ(part.indexToWorld * glm::dvec4(voxel, 1.0), volume.indexToWorld * glm::dvec4(whole, 1.0));
  }
  EXPECT_EQ(part.minimum, volume.minimum);
  EXPECT_EQ(part.maximum, volume.maximum) << "a transfer function means the same";
}

TEST(CoarseVolume, KeepsTheOpticalDepthOfAColumn) {
  const Volume fine = numberedVolume({4, 4, 6});
  const Volume coarse = coarseVolume(fine, 2, WithoutData::Zero);
  double whole = 0.0, inBlocks = 0.0;
  for (int z = 0; z < 6; ++z)
    whole += 0.25 * double(fine.scalar(0, 0, z) + fine.scalar(1, 0, z) + fine.scalar(0, 1, z) +
                           fine.scalar(1, 1, z));
  for (int z = 0; z < 3; ++z) inBlocks += coarse.voxelSize() * double(coarse.scalar(0, 0, z));
  EXPECT_NEAR(inBlocks, whole, 1e-9 * whole);
}

TEST(ClippedVolume, APlaneRemovesTheVoxelsWhoseCentresAreInFrontOfIt) {
  const ClipPlane plane{.point = {6.0, 5.0, 9.0}, .normal = {1.0, -2.0, 0.5}};
  const auto isKept = [&](const Volume& volume, glm::ivec3 v) {
    return glm::dot(plane.normal, glm::dvec3(volume.indexToWorld * glm::dvec4(v, 1.0)) - plane.point) <= 0.0;
  };
  Volume whole = numberedVolume({19, 20, 21}, obliqueTransform());
  whole.temperature = TemperatureGrid{.name = "heat", .values = whole.scalars};
  summariseValues(*whole.temperature);
  const Volume inBox = clippedVolume(whole, VoxelBox{{3, 2, 1}, {18, 17, 20}});  // whose bricks begin before the box
  for (const Volume* volume : std::initializer_list<const Volume*>{&whole, &inBox}) {
    const Volume part = clippedVolume(*volume, plane);
    ASSERT_EQ(part.dimensions, volume->dimensions);
    EXPECT_EQ(part.maximum, whole.maximum) << "the range of a transfer function stays";
    std::uint64_t kept = 0;
    for (glm::ivec3 v(0); v.z < part.dimensions.z; ++v.z)
      for (v.y = 0; v.y < part.dimensions.y; ++v.y)
        for (v.x = 0; v.x < part.dimensions.x; ++v.x) {
          const float expected = isKept(part, v) ? volume->scalars.at(v) : kInactiveVoxel;
          ASSERT_EQ(part.scalars.at(v), expected) << v.x << "," << v.y << "," << v.z;
          ASSERT_EQ(part.temperature->values.at(v), expected);
          kept += isKept(part, v) ? 1 : 0;
        }
    EXPECT_EQ(part.activeVoxels, kept);
    EXPECT_GT(kept, part.voxelCount() / 10);
    EXPECT_LT(kept, part.voxelCount() / 10 * 9);
  }
}

}  // namespace
}  // namespace freevoxels
