#include "engine/volume/vdb.h"

#include <gtest/gtest.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "engine/core/error.h"
#include "engine/volume/procedural.h"
#include "tests/limited_disk.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using test::expectRefusal;
using test::kPlenty;
using test::makeGrid;
using test::named;
using test::patchyVolume;
using test::required;
using test::Vdb;

void expectNear(const glm::dmat4& a, const glm::dmat4& b, double tolerance) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance) << "column " << i << " row " << j;
}

TEST_F(Vdb, WhatIsWrittenIsReadBack) {
  glm::dmat4 sheared = glm::rotate(glm::translate(glm::dmat4(1.0), {3.0, -2.0, 7.0}), 0.6, {0.3, 1.0, -0.2});
  sheared = glm::scale(sheared, {0.1, 0.25, 0.4});
  sheared[1] += 0.3 * sheared[0];
  for (const glm::ivec3 dimensions : {glm::ivec3(1), glm::ivec3(13, 7, 17), glm::ivec3(1, 40, 1)})
    for (const glm::ivec3 origin : {glm::ivec3(0), glm::ivec3(-21, 5, -130)}) {
      Volume volume = patchyVolume(dimensions, sheared);
      volume.indexOrigin = origin;
      writeVdb(file, volume, "smoke");
      const Volume back = read();
      EXPECT_EQ(back.source, "test.vdb smoke");
      EXPECT_EQ(back.dimensions, dimensions);
      EXPECT_EQ(back.indexOrigin, origin);
      EXPECT_EQ(denseScalars(back), denseScalars(volume));
      EXPECT_EQ(back.activeVoxels, volume.activeVoxels);
      EXPECT_EQ(back.negativeVoxels, volume.negativeVoxels);
      EXPECT_EQ(back.minimum, volume.minimum);
      EXPECT_EQ(back.maximum, volume.maximum);
      expectNear(back.indexToWorld, sheared, 1e-9);
      EXPECT_NEAR(back.voxelSize(), std::cbrt(0.1 * 0.25 * 0.4), 1e-9);
    }
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST_F(Vdb, AUniformCubeIsWrittenAsTiles) {
  const Volume cube = makeProcedural("cube", 64);
  writeVdb(file, cube, "density");
  EXPECT_LT(fs::file_size(file), 16384u);
  EXPECT_EQ(denseScalars(read()), denseScalars(cube));
}

TEST_F(Vdb, AFieldIsWrittenLeafByLeafAsItsVolumeIs) {
  const glm::ivec3 size(37, 24, 20);
  const auto readBack = [&] { return readVdb(file, "density", kPlenty, {.temperature = required("temperature")}); };
  writeVdb(file, makeProcedural("fire", size), "density");
  const Volume expected = readBack();
  writeVdb(file, ProceduralField("fire", size), "density");
  const Volume back = readBack();
  EXPECT_EQ(back.dimensions, expected.dimensions);
  EXPECT_EQ(back.indexOrigin, expected.indexOrigin);
  EXPECT_EQ(back.indexToWorld, expected.indexToWorld);
  EXPECT_GT(back.activeVoxels, 0u);
  EXPECT_EQ(denseScalars(back), denseScalars(expected));
  ASSERT_TRUE(back.temperature && expected.temperature);
  for (glm::ivec3 v(0); v.z < back.dimensions.z; ++v.z)
    for (v.y = 0; v.y < back.dimensions.y; ++v.y)
      for (v.x = 0; v.x < back.dimensions.x; ++v.x) ASSERT_EQ(back.temperature->values.at(v), expected.temperature->values.at(v));
}

TEST_F(Vdb, VoxelsStandWhereOpenVdbSays) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(-5, 3, 9), Coord(2, 30, 12)), 1.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.12));
  grid->transform().postRotate(0.7, openvdb::math::Y_AXIS);
  grid->transform().postShear(0.2, openvdb::math::X_AXIS, openvdb::math::Z_AXIS);
  grid->transform().postTranslate({10.0, -20.0, 30.0});
  write({grid});
  const Volume volume = read();
  ASSERT_EQ(volume.indexOrigin, glm::ivec3(-5, 3, 9));
  for (const glm::ivec3 voxel : {glm::ivec3(0), glm::ivec3(7, 27, 3), glm::ivec3(2, 0, 1)}) {
    const glm::ivec3 inFile = volume.indexOrigin + voxel;
    const openvdb::Vec3d expected = grid->indexToWorld(Coord(inFile.x, inFile.y, inFile.z));
    const glm::dvec4 world = volume.indexToWorld * glm::dvec4(glm::dvec3(voxel), 1.0);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(world[axis], expected[axis], 1e-9);
  }
}

TEST_F(Vdb, ActiveTilesCountAsVoxelsAtEveryLevel) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(-1), Coord(-1)), 0.25f);
  grid->tree().addTile(1, Coord(8, 0, 0), 0.5f, true);     // 8³
  grid->tree().addTile(2, Coord(0, 0, 128), 0.75f, true);  // 128³
  grid->tree().addTile(1, Coord(0, 64, 0), 0.9f, false);   // inactive: not there
  write({grid});
  const Volume volume = read();
  EXPECT_EQ(volume.activeVoxels, 1u + 512u + 128u * 128u * 128u);
  EXPECT_EQ(volume.dimensions, glm::ivec3(129, 129, 257));
  EXPECT_EQ(volume.scalar(0, 0, 0), 0.25f);
  EXPECT_EQ(volume.scalar(9, 1, 1), 0.5f);
  EXPECT_EQ(volume.scalar(16, 8, 8), 0.5f);
  EXPECT_EQ(volume.scalar(17, 8, 8), kInactiveVoxel);
  EXPECT_EQ(volume.scalar(1, 1, 129), 0.75f);
  EXPECT_EQ(volume.scalar(128, 128, 256), 0.75f);
  EXPECT_EQ(volume.scalar(1, 66, 1), kInactiveVoxel);
}

TEST_F(Vdb, HalfAndDoubleGridsAreRead) {
  const FloatGrid::Ptr half = makeGrid("half", 0.1f);
  half->setSaveFloatAsHalf(true);
  const openvdb::DoubleGrid::Ptr doubles =
      named<openvdb::DoubleGrid>(openvdb::DoubleGrid::create(0.0), "double");
  doubles->tree().setValueOn(Coord(4, 5, 6), 0.3);
  write({half, doubles});
  EXPECT_NEAR(read("half").maximum, 0.1f, 1e-4f);
  EXPECT_NE(read("half").maximum, 0.1f);
  EXPECT_EQ(read("double").maximum, 0.3f);
  EXPECT_EQ(describeVdb(file)[0].valueType, "half");
  EXPECT_EQ(describeVdb(file)[1].valueType, "double");
}

TEST_F(Vdb, AGridWithoutAClassIsFog) {
  const FloatGrid::Ptr grid = makeGrid("density", -0.5f);
  grid->setGridClass(openvdb::GRID_UNKNOWN);
  write({grid});
  EXPECT_EQ(read().minimum, -0.5f);
  EXPECT_EQ(describeVdb(file)[0].gridClass, "unknown");
}

TEST_F(Vdb, UpIsPlusZWhereTheMetadataAreThoseOfBlender) {
  const auto upOf = [&](const std::function<void(openvdb::FloatGrid&)>& mark) {
    const openvdb::FloatGrid::Ptr grid = makeGrid("density");
    mark(*grid);
    write({grid});
    const Volume volume = read();
    EXPECT_EQ(volume.upReason.empty(), volume.up == glm::dvec3(0, 1, 0));
    return volume.up;
  };
  const glm::dvec3 y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(upOf([](openvdb::FloatGrid&) {}), y);
  EXPECT_EQ(upOf([](openvdb::FloatGrid& grid) { grid.setCreator("Houdini 19.5/GEO_VDBTranslator"); }), y);
  EXPECT_EQ(upOf([](openvdb::FloatGrid& grid) { grid.setIsInWorldSpace(true); }), y);
  EXPECT_EQ(upOf([](openvdb::FloatGrid& grid) { grid.setCreator("Blender/Smoke"); }), z);
  EXPECT_EQ(upOf([](openvdb::FloatGrid& grid) { grid.setIsInWorldSpace(false); }), z);
  EXPECT_EQ(upOf([](openvdb::FloatGrid& grid) {
              grid.insertMeta("file_base_resolution", openvdb::Vec3IMetadata(openvdb::Vec3i(27, 21, 32)));
            }),
            z);
  openvdb::MetaMap ofFile;
  ofFile.insertMeta("creator", openvdb::StringMetadata("Blender/Smoke"));
  openvdb::io::File(file.string()).write({makeGrid("density")}, ofFile);
  EXPECT_EQ(read().up, z);
}

TEST_F(Vdb, APartOfATooLargeVolumeIsRead) {
  constexpr std::uint64_t kOneBrick = 512;
  const FloatGrid::Ptr far = makeGrid("density", CoordBBox(Coord(0), Coord(6)), 1.0f);
  far->tree().setValueOn(Coord(1 << 22), 0.25f);
  write({far, makeGrid("heat", CoordBBox(Coord(0), Coord(6)), 0.5f)});
  EXPECT_THROW(readVdb(file, "", kOneBrick), Error);
  const ReadRequest part{
      .maximumVoxels = kOneBrick, .more = {.temperature = GridRequest{}}, .clipBox = VoxelBox{.first = {2, 1, 0}, .last = {11, 12, 13}}};
  const Volume volume = readVdb(file, part);
  EXPECT_TRUE(volume.isPart);
  EXPECT_EQ(volume.dimensions, glm::ivec3(10, 12, 14));
  EXPECT_EQ(volume.indexOrigin, glm::ivec3(2, 1, 0));
  EXPECT_EQ(volume.activeVoxels, 5u * 6u * 7u);
  EXPECT_EQ(volume.temperature->activeVoxels, 5u * 6u * 7u);
}

TEST_F(Vdb, TheHeaderTellsWhereTheVoxelsAre) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(-2, 0, 5), Coord(7, 3, 9)), 1.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  write({grid});
  const auto extent = extentOfVdb(file, "", {});
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->voxels, 10u * 4u * 5u);
  ASSERT_EQ(extent->corners.size(), 8u);
  glm::dvec3 low(1e9), high(-1e9);
  for (const glm::dvec3& corner : extent->corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  EXPECT_EQ(low, glm::dvec3(-1.25, -0.25, 2.25));
  EXPECT_EQ(high, glm::dvec3(3.75, 1.75, 4.75));
  write({makeGrid("density", CoordBBox(), 1.0f)});
  EXPECT_EQ(extentOfVdb(file, "", {})->voxels, 0u);
}

TEST_F(Vdb, GridsOfOtherTypesAreRefusedByName) {
  const auto fill = [](auto grid, const auto& value) {
    grid->tree().setValueOn(Coord(0), value);
    return grid;
  };
  write({named<openvdb::Vec3SGrid>(fill(openvdb::Vec3SGrid::create(), openvdb::Vec3s(1.0f)), "velocity"),
         named<openvdb::Vec3IGrid>(fill(openvdb::Vec3IGrid::create(), openvdb::Vec3i(1)), "index"),
         named<openvdb::points::PointDataGrid>(openvdb::points::PointDataGrid::create(), "points")});
  expectReadRefused({"'velocity'", file.string(), "vec3s"}, "velocity");
  expectReadRefused({"'index'", file.string(), "vec3i"}, "index");
  expectReadRefused({"'points'", file.string(), "points, not a density field"}, "points");
  for (const GridInfo& info : describeVdb(file)) {
    EXPECT_FALSE(info.unusable.empty()) << info.name;
    EXPECT_FALSE(info.hasRange) << info.name;
  }
}

TEST_F(Vdb, FrustumsAreRefused) {
  const FloatGrid::Ptr grid = makeGrid("density");
  const openvdb::BBoxd box(openvdb::Vec3d(0.0), openvdb::Vec3d(100.0));
  grid->setTransform(std::make_shared<openvdb::math::Transform>(
      openvdb::math::MapBase::Ptr(new openvdb::math::NonlinearFrustumMap(box, 0.5, 10.0))));
  write({grid});
  expectReadRefused({"'density'", file.string(), "frustum"});
  EXPECT_NE(describeVdb(file)[0].unusable.find("frustum"), std::string::npos);
}

TEST_F(Vdb, SingularAndInfiniteTransformsAreRefused) {
  using openvdb::math::MapBase;
  const openvdb::Mat4d flat(1.0, 0.0, 0.0, 0.0, 1.0, 1e-10, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
  for (const MapBase::Ptr& map : {MapBase::Ptr(new openvdb::math::AffineMap(flat)),
                                  MapBase::Ptr(new openvdb::math::ScaleMap(openvdb::Vec3d(1e140)))}) {
    const FloatGrid::Ptr grid = makeGrid("density");
    grid->setTransform(std::make_shared<openvdb::math::Transform>(map));
    write({grid});
    expectReadRefused({"'density'", file.string(), "singular or not finite"});
  }
}

TEST_F(Vdb, EmptyGridsAndFilesAreRefused) {
  write({named<FloatGrid>(FloatGrid::create(), "density")});
  expectReadRefused({"'density'", file.string(), "empty"});
  EXPECT_NE(describeVdb(file)[0].unusable.find("empty"), std::string::npos);
  write({});
  expectReadRefused({file.string(), "no grids"});
  EXPECT_TRUE(describeVdb(file).empty());
}

TEST_F(Vdb, WhatIsOccupiedCountsAndNotTheBox) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(0)), 1.0f);
  const Coord far(999'999, 1'999'999, 2'999'999);
  grid->tree().setValueOn(far, 0.5f);
  write({grid});
  const Volume volume = readVdb(file, "", 1024);
  EXPECT_EQ(volume.dimensions, glm::ivec3(1'000'000, 2'000'000, 3'000'000));
  EXPECT_EQ(volume.activeVoxels, 2u);
  EXPECT_EQ(volume.scalar(far.x(), far.y(), far.z()), 0.5f);
  expectRefusal([&] { readVdb(file, "", 1023); }, ErrorKind::OutOfMemory,
                {"test.vdb density", "1024 voxels", "1000000 x 2000000 x 3000000", "1023", "clip-box"});
  write({makeGrid("density", CoordBBox(Coord(0), Coord(9)), 1.0f)});
  EXPECT_NO_THROW(readVdb(file, "", 1000));
  expectRefusal([&] { readVdb(file, "", 999); }, ErrorKind::OutOfMemory, {"10 x 10 x 10", "1000", "999"});
}

TEST_F(Vdb, ZerosFarAwayAreEmptyAndZerosNearbyAreNot) {
  for (const openvdb::GridClass gridClass : {openvdb::GRID_FOG_VOLUME, openvdb::GRID_UNKNOWN}) {
    const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(1, 2, 3), Coord(20)), 1.0f);
    grid->setGridClass(gridClass);
    grid->tree().setValueOn(Coord(30, 2, 3), 0.0f);
    write({grid});
    EXPECT_EQ(read().dimensions, glm::ivec3(30, 19, 18));
    grid->tree().setValueOn(Coord(5, 1 << 20, 5), 0.0f);
    grid->tree().addTile(1, Coord(1 << 20, 8, 0), 0.0f, true);
    grid->tree().addTile(2, Coord(0, 0, 1 << 24), 0.0f, true);
    write({grid});
    EXPECT_EQ(read().dimensions, glm::ivec3(20, 19, 18));
    EXPECT_EQ(read().activeVoxels, 20u * 19u * 18u);
    EXPECT_TRUE(read().warnings.empty());
  }
}

TEST_F(Vdb, AWarningNamesTheBoxWithoutStrayVoxels) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(-4, 0, 0), Coord(35, 39, 39)), 1.0f);
  grid->tree().setValueOn(Coord(20'000'000, 0, 0), 1.0f);
  write({grid});
  const std::vector<std::string> warnings = read().warnings;  // with a box of whole bricks
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings.front().find("1 of the 64001 voxels"), std::string::npos) << warnings.front();
  EXPECT_NE(warnings.front().find("0,0,0,43,39,39"), std::string::npos) << warnings.front();
}

TEST_F(Vdb, AFullDiskIsReportedAndLeavesNothing) {
  FV_REQUIRE_LIMITED_DISK(folder.path());
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto writeLarge = [](const fs::path& disk) {
    Volume volume = makeProcedural("cloud", 64);
    writeVdb(disk / "cloud.vdb", volume, "density");
  };
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536, writeLarge),
              testing::ExitedWithCode(int(ErrorKind::Output)), "cloud.vdb");
}

TEST_F(Vdb, AFullDiskOfAFieldIsReportedAndLeavesNothing) {
  FV_REQUIRE_LIMITED_DISK(folder.path());
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const std::size_t bytes : {65536, 196608}) {  // in the temporary file, and in the file itself
    const auto writeLarge = [](const fs::path& disk) { writeVdb(disk / "cloud.vdb", ProceduralField("cloud", glm::ivec3(64)), "density"); };
    EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), bytes, writeLarge), testing::ExitedWithCode(int(ErrorKind::Output)),
                "cannot write .*cloud.vdb.*No space left");
  }
}

/// As files of instances have them: the second grid has the first one's tree and a transform of its own.
TEST_F(Vdb, GridsThatShareATreeAreRead) {
  const FloatGrid::Ptr first = makeGrid("density", 0.25f);
  const FloatGrid::Ptr second = FloatGrid::create(first->treePtr());
  second->setName("copy");
  second->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  write({first, second});
  EXPECT_EQ(read().maximum, 0.25f);
  const Volume copy = read("copy");
  EXPECT_EQ(denseScalars(copy), denseScalars(read()));
  EXPECT_NEAR(copy.voxelSize(), 0.5, 1e-12);
  EXPECT_EQ(describeVdb(file).size(), 2u);
}

glm::dvec3 centreOf(const Volume& volume) {
  return volume.indexToWorld * glm::dvec4((glm::dvec3(volume.dimensions) - 1.0) / 2.0, 1.0);
}

TEST_F(Vdb, AVolumeTooFarFromTheOriginIsMovedThere) {
  const FloatGrid::Ptr grid = makeGrid("density");
  grid->transform().postTranslate(openvdb::Vec3d(1e15, 0.0, -3.0));
  write({grid});
  EXPECT_LT(glm::length(centreOf(read())), 1.0);
  grid->setTransform(openvdb::math::Transform::createLinearTransform());
  grid->transform().postTranslate(openvdb::Vec3d(1e9, 0.0, 0.0));
  write({grid});
  EXPECT_NEAR(centreOf(read()).x, 1e9, 1.0) << "doubles still tell its voxels apart";
}

TEST_F(Vdb, VoxelsOfAnAbsurdSizeAreScaledByAPowerOfTen) {
  const FloatGrid::Ptr grid = makeGrid("density");
  for (const auto& [size, scaled] : {std::pair(3e11, 3.0), std::pair(3e20, 3.0), std::pair(1e8, 1e8), std::pair(2e-4, 2e-4)}) {
    grid->setTransform(openvdb::math::Transform::createLinearTransform(size));
    write({grid});
    EXPECT_NEAR(read().voxelSize(), scaled, 1e-9 * scaled) << size;
  }
}

}  // namespace
}  // namespace freevoxels
