// What the values of OpenVDB files are as densities: numbers, no numbers, marks of no data, distances.

#include <gtest/gtest.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/core/error.h"
#include "engine/volume/scan.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_parts.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using test::kPlenty;
using test::makeGrid;
using test::named;
using test::Vdb;

/// A cylinder of air with a body in it, in a box that is filled up; for boxes that end at bricks, and elsewhere.
FloatGrid::Ptr paddedScan(const Coord& size, float padding) {
  const FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  grid->setName("ct");
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const double distance = std::hypot(2.0 * x / size.x() - 1.0, 2.0 * y / size.y() - 1.0);
        const float measured = (distance < 0.5 ? 1100.0f : 10.0f) + float((7 * x + 13 * y + 29 * z) % 83);
        grid->tree().setValueOn(Coord(x, y, z), distance < 0.9 ? measured : padding);
      }
  return grid;
}

TEST_F(Vdb, APaddedScanStaysOneWhateverSaysThatItsPaddingIsNoData) {
  for (const Coord& size : {Coord(24, 32, 16), Coord(21, 19, 9)}) {
    for (const float padding : {65535.0f, std::nanf("")}) {
      write({paddedScan(size, padding)});
      for (const std::optional<NoData>& noData : {std::optional<NoData>(), std::optional(NoData{65535.0})}) {
        const Volume volume = readVdb(file, {.maximumVoxels = kPlenty, .noData = noData});
        EXPECT_TRUE(looksLikeScan(volume)) << padding;
        EXPECT_LT(volume.maximum, 1200.0f);
        EXPECT_EQ(volume.activeVoxels + volume.missingVoxels, volume.voxelCount());
        EXPECT_EQ(volume.padding, std::isnan(padding) && !noData ? std::nullopt : std::optional(65535.0f));
        const std::unique_ptr<const VdbParts> parts = VdbParts::open(file, {.noData = noData}, 0);
        if (parts == nullptr) continue;  // this OpenVDB cannot leave values in the file
        EXPECT_TRUE(looksLikeScan(parts->sample()));
        EXPECT_EQ(parts->sample().padding, volume.padding);
        EXPECT_EQ(parts->sample().remarks, volume.remarks);
        EXPECT_EQ(denseScalars(parts->sample()), denseScalars(volume));
      }
    }
    write({paddedScan(size, 65535.0f)});
    EXPECT_EQ(readVdb(file, {.maximumVoxels = kPlenty, .noData = NoData{}}).maximum, 65535.0f);
  }
}

TEST_F(Vdb, ALevelSetBecomesFogOfTheSameVolume) {
  constexpr float kVoxelSize = 0.05f;
  for (const double radius : {0.31, 1.0, 4.0}) {  // the largest has inactive interior tiles of two levels
    write({openvdb::tools::createLevelSetSphere<FloatGrid>(float(radius), {0.3f, 0.2f, -0.1f}, kVoxelSize)});
    const Volume volume = read();
    EXPECT_TRUE(volume.isSolid);
    double sum = 0.0;
    for (const float value : denseScalars(volume))
      if (value != kInactiveVoxel) sum += value;
    // The mean volume of spheres, over radii whose distribution is the derivative of the transition of four voxels.
    constexpr double kVariance = 16.0 / 20.0 * kVoxelSize * kVoxelSize;
    const double expected = 4.0 / 3.0 * std::numbers::pi * (radius * radius * radius + 3.0 * radius * kVariance);
    EXPECT_NEAR(sum * std::pow(kVoxelSize, 3) / expected, 1.0, radius < 0.5 ? 2e-2 : 2e-3) << radius;
    EXPECT_GT(volume.minimum, 0.0f);
    EXPECT_EQ(volume.maximum, 1.0f);
    const glm::ivec3 middle = volume.dimensions / 2;
    EXPECT_EQ(volume.scalar(middle.x, middle.y, middle.z), 1.0f);
    const double diameter = 2.0 * radius / kVoxelSize;
    EXPECT_NEAR(volume.dimensions.x, diameter + 4.0 + 2.0 * 2.0, 2.0) << "the box ends two voxels beyond the density";
  }
}

TEST_F(Vdb, DensityFallsSmoothlyOverTheSurfaceOfALevelSet) {
  const FloatGrid::Ptr grid = FloatGrid::create(3.0f);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  for (int x = 0; x < 5; ++x) grid->tree().setValueOn(Coord(x, 0, 0), float(x) - 1.5f);
  write({grid});
  const Volume volume = read();
  ASSERT_EQ(volume.dimensions, glm::ivec3(9, 5, 5)) << "with a margin of two voxels";
  for (int x = 0; x < 5; ++x) {  // distances of -0.75 voxels and on, over four
    const float inwards = 0.5f - (0.5f * float(x) - 0.75f) / 4.0f;
    EXPECT_FLOAT_EQ(volume.scalar(x + 2, 2, 2), inwards * inwards * (3.0f - 2.0f * inwards));
  }
  EXPECT_EQ(volume.scalar(7, 2, 2), kInactiveVoxel);
}

TEST_F(Vdb, BadValuesAreCountedAndNaNIsNoData) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(9, 0, 0)), 1.0f);
  grid->tree().setValueOn(Coord(1, 0, 0), std::numeric_limits<float>::quiet_NaN());
  grid->tree().setValueOn(Coord(2, 0, 0), -std::numeric_limits<float>::infinity());
  grid->tree().setValueOn(Coord(3, 0, 0), std::numeric_limits<float>::infinity());
  grid->tree().setValueOn(Coord(4, 0, 0), -2.0f);
  grid->tree().setValueOff(Coord(5, 0, 0), std::numeric_limits<float>::quiet_NaN());
  write({grid});
  const Volume volume = read();
  EXPECT_EQ(volume.activeVoxels, 6u);
  EXPECT_EQ(volume.nanVoxels, 3u);
  EXPECT_EQ(volume.negativeVoxels, 1u);
  EXPECT_EQ(volume.minimum, -2.0f);
  EXPECT_EQ(volume.maximum, 1.0f);
  EXPECT_EQ(denseScalars(volume), (std::vector<float>{1, kInactiveVoxel, kInactiveVoxel, kInactiveVoxel, -2, kInactiveVoxel, 1, 1, 1, 1}));
  const GridInfo info = describeVdb(file)[0];
  EXPECT_EQ(info.minimum, -2.0);
  EXPECT_EQ(info.maximum, 1.0);
}

TEST_F(Vdb, VoxelsThatMeanNoDataAreNoOutliers) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(19)), 0.5f);
  grid->fill(CoordBBox(Coord(4), Coord(5, 5, 4)), 1e30f);
  write({grid});
  EXPECT_EQ(read().outlierVoxels, 4u);
  const Volume volume = readVdb(file, {.maximumVoxels = kPlenty, .noData = NoData{1e30}});
  EXPECT_EQ(volume.outlierVoxels, 0u);
  EXPECT_EQ(volume.activeVoxels, 8000u - 4u);
  EXPECT_EQ(volume.scalar(4, 4, 4), kInactiveVoxel);
}

TEST_F(Vdb, HalvesBeyondTheirRangeAreTheLargest) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(9, 9, 9)), 60000.0f);
  grid->tree().setValueOn(Coord(4), 2e5f);
  grid->tree().setValueOn(Coord(5), -2e5f);
  grid->setSaveFloatAsHalf(true);
  write({grid});
  const Volume volume = read();
  EXPECT_EQ(volume.overflownVoxels, 2u);
  EXPECT_EQ(volume.nanVoxels, 0u);
  EXPECT_EQ(volume.scalar(4, 4, 4), 65504.0f);
  EXPECT_EQ(volume.scalar(5, 5, 5), -65504.0f);
}

TEST_F(Vdb, AFileWithoutNumbersIsEmpty) {
  write({makeGrid("density", CoordBBox(Coord(0), Coord(3)), std::numeric_limits<float>::quiet_NaN())});
  EXPECT_THROW(read(), EmptyVolumeError);
}

TEST_F(Vdb, ActiveTilesOfNoDensityHoldNothing) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(6)), 1.0f);
  grid->tree().addTile(1, Coord(512), 0.0f, true);
  write({grid});
  EXPECT_EQ(read().dimensions, glm::ivec3(7));
  grid->setGridClass(openvdb::GRID_UNKNOWN);  // which may be a scan, whose 0 is a value
  write({grid});
  EXPECT_EQ(read().dimensions, glm::ivec3(520));
}

TEST_F(Vdb, ALevelSetThatIsNegativeOutsideIsTurned) {
  for (const float sign : {1.0f, -1.0f}) {
    const FloatGrid::Ptr grid = FloatGrid::create(3.0f * sign);
    grid->setName("surface");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    for (int x = -4; x <= 4; ++x)
      for (int y = -4; y <= 4; ++y) grid->tree().setValueOn(Coord(x, y, 0), sign * (float(std::max(std::abs(x), std::abs(y))) - 1.5f));
    write({grid});
    const Volume volume = read();
    EXPECT_EQ(volume.activeVoxels, 49u) << sign;
    EXPECT_EQ(volume.remarks.empty(), sign > 0.0f);
  }
}

/// A sphere of distances as OpenVDB makes it, with all of the inside active where `isFilled`.
FloatGrid::Ptr sphereOfDistances(float voxel, float halfWidth, bool isFilled) {
  const float band = halfWidth * voxel;
  const FloatGrid::Ptr grid = FloatGrid::create(band);
  grid->setName("surface");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(double(voxel)));
  for (int z = -12; z <= 12; ++z)
    for (int y = -12; y <= 12; ++y)
      for (int x = -12; x <= 12; ++x) {
        const float distance = voxel * (std::sqrt(float(x * x + y * y + z * z)) - 7.5f);
        const float stored = std::clamp(distance, -band, band);
        if (std::abs(distance) < band || isFilled)
          grid->tree().setValueOn(Coord(x, y, z), stored);
        else if (distance < 0.0f)
          grid->tree().setValueOff(Coord(x, y, z), stored);
      }
  return grid;
}

TEST_F(Vdb, DistancesAreALevelSetWhateverTheClass) {
  for (const float voxel : {0.1f, 1.0f, 25.0f})
    for (const float halfWidth : {2.0f, 3.0f, 10.0f})
      for (const bool isFilled : {false, true}) {
        SCOPED_TRACE(fmt::format("voxel {}, half width {}, filled {}", voxel, halfWidth, isFilled));
        const FloatGrid::Ptr grid = sphereOfDistances(voxel, halfWidth, isFilled);
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
        write({grid});
        const Volume wanted = read();
        for (const openvdb::GridClass other : {openvdb::GRID_UNKNOWN, openvdb::GRID_FOG_VOLUME}) {
          grid->setGridClass(other);
          write({grid});
          const Volume volume = read();
          EXPECT_TRUE(volume.isSolid);
          EXPECT_EQ(denseScalars(volume), denseScalars(wanted));
          ASSERT_EQ(volume.remarks.size(), 1u);
          EXPECT_NE(volume.remarks[0].find("level set"), std::string::npos);
        }
      }
}

TEST_F(Vdb, ValuesOfBothSignsAloneAreNoLevelSet) {
  for (const float background : {0.0f, -1000.0f, 50.0f, 9.97e36f}) {
    const FloatGrid::Ptr grid = FloatGrid::create(background);
    grid->setName("values");
    for (int i = 0; i < 100; ++i) grid->tree().setValueOn(Coord(i % 5, i / 5 % 5, i / 25), float(i) * 11.0f - 500.0f);
    write({grid});
    const Volume volume = read();
    EXPECT_FALSE(volume.isSolid) << background;
    EXPECT_EQ(volume.activeVoxels, 100u);
  }
}

TEST_F(Vdb, ALevelSetIsTheSameWithABackgroundOf0) {
  const FloatGrid::Ptr sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(20.0f, openvdb::Vec3f(0.0f), 1.0f);
  write({sphere});
  const Volume before = read();
  openvdb::tools::changeBackground(sphere->tree(), 0.0f);
  write({sphere});
  EXPECT_EQ(read().dimensions, before.dimensions);
  EXPECT_EQ(describeVdb(file).at(0).renderDimensions, before.dimensions);
}

}  // namespace
}  // namespace freevoxels
