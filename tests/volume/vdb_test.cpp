#include "engine/volume/vdb.h"

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "engine/core/error.h"
#include "engine/volume/procedural.h"
#include "tests/limited_disk.h"
#include "tests/temporary_folder.h"

/// For the leak sanitizer: OpenVDB drops the nodes it was reading when a truncated stream throws.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:readTopology\nleak:readBuffers\n";
}

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using test::readBytes;
using test::TemporaryFolder;
using test::writeBytes;

constexpr std::uint64_t kPlenty = 1u << 28;

template <typename Action>
Error errorOf(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ExitCode::Success, ""};
}

/// One sentence on one line that contains all of `parts`.
template <typename Action>
void expectRefusal(Action&& action, ExitCode code, std::initializer_list<std::string> parts) {
  const Error error = errorOf(action);
  const std::string sentence = error.what();
  EXPECT_EQ(error.code(), code) << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
  for (const std::string& part : parts)
    EXPECT_NE(sentence.find(part), std::string::npos) << part << " in: " << sentence;
}

class Vdb : public testing::Test {
 protected:
  void SetUp() override { openvdb::initialize(); }

  void write(const openvdb::GridPtrVec& grids) const { openvdb::io::File(file.string()).write(grids); }
  Volume read(const std::string& name = "") const { return readVdb(file, name, kPlenty); }
  void expectReadRefused(std::initializer_list<std::string> parts, const std::string& name = "") const {
    expectRefusal([&] { read(name); }, ExitCode::Input, parts);
  }

  const TemporaryFolder folder;
  const fs::path file = folder / "test.vdb";
};

FloatGrid::Ptr makeGrid(const std::string& name, const CoordBBox& box, float value) {
  const FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->denseFill(box, value, true);
  return grid;
}

FloatGrid::Ptr makeGrid(const std::string& name, float value = 0.5f) {
  return makeGrid(name, CoordBBox(Coord(0), Coord(1, 2, 3)), value);
}

template <typename Grid>
typename Grid::Ptr named(typename Grid::Ptr grid, const std::string& name) {
  grid->setName(name);
  return grid;
}

/// Active voxels of every value, negative and zero included, and inactive ones between them.
Volume patchyVolume(glm::ivec3 dimensions, const glm::dmat4& indexToWorld) {
  Volume volume = makeVolume(dimensions, indexToWorld, [](int x, int y, int z) {
    const int number = (x * 7 + y * 13 + z * 29) % 11;
    return number == 0 ? kInactiveVoxel : 0.25f * float(number - 3);
  });
  volume.values.front() = volume.values.back() =
      1.0f;  // so that the box of the active voxels is the whole box
  summariseValues(volume);
  return volume;
}

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
      EXPECT_EQ(back.values, volume.values);
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
  EXPECT_EQ(read().values, cube.values);
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
  EXPECT_EQ(volume.values[volume.at(0, 0, 0)], 0.25f);
  EXPECT_EQ(volume.values[volume.at(9, 1, 1)], 0.5f);
  EXPECT_EQ(volume.values[volume.at(16, 8, 8)], 0.5f);
  EXPECT_EQ(volume.values[volume.at(17, 8, 8)], kInactiveVoxel);
  EXPECT_EQ(volume.values[volume.at(1, 1, 129)], 0.75f);
  EXPECT_EQ(volume.values[volume.at(128, 128, 256)], 0.75f);
  EXPECT_EQ(volume.values[volume.at(1, 66, 1)], kInactiveVoxel);
}

TEST_F(Vdb, ALevelSetBecomesFogOfTheSameVolume) {
  constexpr float kVoxelSize = 0.05f;
  for (const double radius : {0.31, 1.0, 4.0}) {  // the largest has inactive interior tiles of two levels
    write({openvdb::tools::createLevelSetSphere<FloatGrid>(float(radius), {0.3f, 0.2f, -0.1f}, kVoxelSize)});
    const Volume volume = read();
    double sum = 0.0;
    for (const float value : volume.values)
      if (value != kInactiveVoxel) sum += value;
    const double expected = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    EXPECT_NEAR(sum * std::pow(kVoxelSize, 3) / expected, 1.0, radius < 0.5 ? 2e-2 : 2e-3) << radius;
    EXPECT_GT(volume.minimum, 0.0f);
    EXPECT_EQ(volume.maximum, 1.0f);
    const glm::ivec3 middle = volume.dimensions / 2;
    EXPECT_EQ(volume.values[volume.at(middle.x, middle.y, middle.z)], 1.0f);
    const double diameter = 2.0 * radius / kVoxelSize;
    EXPECT_NEAR(volume.dimensions.x, diameter, 2.0) << "the box ends where the density does";
  }
}

TEST_F(Vdb, DensityFallsLinearlyOverTheSurfaceOfALevelSet) {
  const FloatGrid::Ptr grid = FloatGrid::create(3.0f);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  for (int x = 0; x < 5; ++x) grid->tree().setValueOn(Coord(x, 0, 0), float(x) - 1.5f);
  write({grid});
  const Volume volume = read();
  EXPECT_EQ(volume.values, (std::vector<float>{1.0f, 0.75f, 0.25f}));  // distances -1.5, -0.5, 0.5
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

TEST_F(Vdb, GridsThatShareANameAreToldApartByNumber) {
  write({makeGrid("density", 0.1f), makeGrid("heat", 0.2f), makeGrid("density", 0.3f),
         makeGrid("density", 0.4f)});
  const std::vector<GridInfo> infos = describeVdb(file);
  ASSERT_EQ(infos.size(), 4u);
  const std::vector<std::string> names{"density[0]", "heat", "density[1]", "density[2]"};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(infos[i].name, names[i]);
    EXPECT_FLOAT_EQ(float(infos[i].maximum), 0.1f * float(i + 1));
    EXPECT_EQ(read(names[i]).maximum, float(infos[i].maximum));
    EXPECT_EQ(read(names[i]).source, "test.vdb " + names[i]);
  }
  EXPECT_EQ(read().maximum, 0.1f);
  EXPECT_EQ(read("density").maximum, 0.1f);
  expectReadRefused({"density[3]", "'density[2]' (float)", "'heat' (float)"}, "density[3]");
}

TEST_F(Vdb, TheDefaultGridIsDensityOrTheOnlyFloatGrid) {
  const auto velocity = named<openvdb::Vec3SGrid>(openvdb::Vec3SGrid::create(), "velocity");
  write({makeGrid("a", 0.1f), makeGrid("density", 0.2f), velocity});
  EXPECT_EQ(read().maximum, 0.2f);
  write({velocity, makeGrid("a", 0.3f)});
  EXPECT_EQ(read().maximum, 0.3f);
  write({makeGrid("a"), velocity, makeGrid("b")});
  expectReadRefused({file.string(), "'a' (float)", "'velocity' (vec3s)", "'b' (float)", "--grid"});
  write({velocity, named<openvdb::BoolGrid>(openvdb::BoolGrid::create(), "mask")});
  expectReadRefused({file.string(), "'velocity' (vec3s)", "'mask' (bool)"});
  expectReadRefused({"no grid 'smoke'", "'velocity' (vec3s)"}, "smoke");
}

TEST_F(Vdb, AGridWithoutAClassIsFog) {
  const FloatGrid::Ptr grid = makeGrid("density", -0.5f);
  grid->setGridClass(openvdb::GRID_UNKNOWN);
  write({grid});
  EXPECT_EQ(read().minimum, -0.5f);
  EXPECT_EQ(describeVdb(file)[0].gridClass, "unknown");
}

TEST_F(Vdb, BadValuesAreCountedAndNaNBecomesZero) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(9, 0, 0)), 1.0f);
  grid->tree().setValueOn(Coord(1, 0, 0), std::numeric_limits<float>::quiet_NaN());
  grid->tree().setValueOn(Coord(2, 0, 0), -std::numeric_limits<float>::infinity());
  grid->tree().setValueOn(Coord(3, 0, 0), std::numeric_limits<float>::infinity());
  grid->tree().setValueOn(Coord(4, 0, 0), -2.0f);
  grid->tree().setValueOff(Coord(5, 0, 0), std::numeric_limits<float>::quiet_NaN());
  write({grid});
  const Volume volume = read();
  EXPECT_EQ(volume.activeVoxels, 9u);
  EXPECT_EQ(volume.nanVoxels, 3u);
  EXPECT_EQ(volume.negativeVoxels, 1u);
  EXPECT_EQ(volume.minimum, -2.0f);
  EXPECT_EQ(volume.maximum, 1.0f);
  EXPECT_EQ(volume.values, (std::vector<float>{1, 0, 0, 0, -2, kInactiveVoxel, 1, 1, 1, 1}));
  const GridInfo info = describeVdb(file)[0];
  EXPECT_EQ(info.minimum, -2.0);
  EXPECT_EQ(info.maximum, 1.0);
}

TEST_F(Vdb, GridsOfOtherTypesAreRefusedByName) {
  const auto fill = [](auto grid, const auto& value) {
    grid->tree().setValueOn(Coord(0), value);
    return grid;
  };
  write({named<openvdb::Vec3SGrid>(fill(openvdb::Vec3SGrid::create(), openvdb::Vec3s(1.0f)), "velocity"),
         named<openvdb::Int32Grid>(fill(openvdb::Int32Grid::create(), 1), "index"),
         named<openvdb::BoolGrid>(fill(openvdb::BoolGrid::create(), true), "inside"),
         named<openvdb::points::PointDataGrid>(openvdb::points::PointDataGrid::create(), "points")});
  expectReadRefused({"'velocity'", file.string(), "vec3s"}, "velocity");
  expectReadRefused({"'index'", file.string(), "int32"}, "index");
  expectReadRefused({"'inside'", file.string(), "bool"}, "inside");
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

TEST_F(Vdb, WhatIsNoVdbFileIsRefused) {
  expectReadRefused({file.string(), "there is no file"});
  writeBytes(file, "ply\nformat ascii 1.0\n");
  expectReadRefused({file.string(), "not an OpenVDB file", "text"});
  writeBytes(file, std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16));
  expectReadRefused({file.string(), "not an OpenVDB file", "signature"});
  writeBytes(file, "");
  expectReadRefused({file.string(), "not an OpenVDB file", "empty"});
  fs::remove(file);
  fs::create_directory(file);
  expectReadRefused({file.string(), "folder"});
  expectRefusal([] { readVdb("/dev/null", "", kPlenty); }, ExitCode::Input, {"/dev/null"});
}

TEST_F(Vdb, ATruncatedFileIsRefusedWhereverItEnds) {
  const Volume volume = patchyVolume({20, 20, 20}, glm::dmat4(1.0));
  writeVdb(file, volume, "density");
  const std::string bytes = readBytes(file);
  ASSERT_GT(bytes.size(), 1000u);
  for (std::size_t length = 8; length < bytes.size(); length += length < 400 ? 1 : 97) {
    writeBytes(file, bytes.substr(0, length));
    SCOPED_TRACE(length);
    expectReadRefused({file.string(), "incomplete"});
  }
  writeBytes(file, bytes.substr(0, bytes.size() - 1));
  expectReadRefused({file.string(), "incomplete"});
  expectRefusal([&] { describeVdb(file); }, ExitCode::Input, {file.string(), "incomplete"});
}

TEST_F(Vdb, AStreamedFileIsReadAndRefusedWhenTruncated) {
  {
    std::ofstream stream(file, std::ios::binary);
    openvdb::io::Stream(stream).write(openvdb::GridPtrVec{makeGrid("a", 0.1f), makeGrid("density", 0.2f)});
  }
  EXPECT_EQ(read().maximum, 0.2f);
  EXPECT_EQ(read("a").maximum, 0.1f);
  const std::string bytes = readBytes(file);
  for (std::size_t length = 60; length < bytes.size(); length += 211) {
    writeBytes(file, bytes.substr(0, length));
    SCOPED_TRACE(length);
    expectReadRefused({file.string()});
  }
}

TEST_F(Vdb, ANewerFormatIsTriedWithoutNoiseAndAnAncientOneIsRefused) {
  write({makeGrid("density", 0.5f)});
  std::string bytes = readBytes(file);
  bytes[8] = char(openvdb::OPENVDB_FILE_VERSION + 1);  // the format version follows the signature
  writeBytes(file, bytes);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  EXPECT_EQ(read().maximum, 0.5f);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  bytes[8] = char(200);
  writeBytes(file, bytes);
  expectReadRefused({file.string(), "format 200"});
}

TEST_F(Vdb, TooLargeABoxIsRefusedBeforeItIsAllocated) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(0)), 1.0f);
  grid->tree().setValueOn(Coord(999'999, 1'999'999, 2'999'999), 1.0f);
  write({grid});
  expectRefusal([&] { read(); }, ExitCode::OutOfMemory,
                {"test.vdb density", "1000000 x 2000000 x 3000000", "6000000000000000000",
                 std::to_string(kPlenty), "resample or crop"});
  write({makeGrid("density", CoordBBox(Coord(0), Coord(9)), 1.0f)});
  EXPECT_NO_THROW(readVdb(file, "", 1000));
  expectRefusal([&] { readVdb(file, "", 999); }, ExitCode::OutOfMemory, {"10 x 10 x 10", "1000", "999"});
}

TEST_F(Vdb, InfoGivesTheFigures) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(-2, 3, 4), Coord(7, 13, 15)), 0.5f);
  grid->tree().setValueOn(Coord(0, 5, 5), 2.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  write({grid});
  const GridInfo info = describeVdb(file).at(0);
  EXPECT_EQ(info.name, "density");
  EXPECT_EQ(info.valueType, "float");
  EXPECT_EQ(info.gridClass, "fog volume");
  EXPECT_EQ(info.activeVoxels, 10u * 11u * 12u);
  EXPECT_EQ(info.dimensions, glm::ivec3(10, 11, 12));
  EXPECT_EQ(info.boundsMinimum, glm::ivec3(-2, 3, 4));
  EXPECT_EQ(info.boundsMaximum, glm::ivec3(7, 13, 15));
  EXPECT_EQ(info.voxelSize, glm::dvec3(0.25));
  EXPECT_TRUE(info.hasRange);
  EXPECT_EQ(info.minimum, 0.5);
  EXPECT_EQ(info.maximum, 2.0);
  EXPECT_GT(info.memoryBytes, 1320u * sizeof(float));
  EXPECT_EQ(info.unusable, "");
}

TEST_F(Vdb, AFullDiskIsReportedAndLeavesNothing) {
  FV_REQUIRE_LIMITED_DISK(folder.path());
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto writeLarge = [](const fs::path& disk) {
    Volume volume = makeProcedural("cloud", 64);
    writeVdb(disk / "cloud.vdb", volume, "density");
  };
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536, writeLarge),
              testing::ExitedWithCode(int(ExitCode::Output)), "cloud.vdb");
}

// ----- Real files, where they are.

const fs::path kData = FREEVOXELS_DATA_DIR;

struct RealFile {
  const char* name;
  glm::ivec3 dimensions;
  std::uint64_t activeVoxels;
};

TEST(RealVdb, FilesHaveTheirPublishedFigures) {
  const std::vector<RealFile> files{{"wdas_cloud_sixteenth.vdb", {126, 86, 154}, 415'642},
                                    {"smoke1.vdb", {111, 222, 112}, 1'049'275},
                                    {"dragon_with_xform.vdb", {141, 99, 63}, 156'161},
                                    {"usd_densityAndHeat.vdb", {23, 23, 42}, 0},
                                    {"usd_smoke_000003.vdb", {51, 49, 96}, 90'197},
                                    {"blender_fluid_0050.vdb", {25, 19, 29}, 0},
                                    {"scivis_grid0.vdb", {81, 81, 81}, 0}};
  if (!fs::exists(kData)) GTEST_SKIP() << "no real volumes in " << kData;
  for (const RealFile& expected : files) {
    if (!fs::exists(kData / expected.name)) continue;
    SCOPED_TRACE(expected.name);
    const Volume volume = readVdb(kData / expected.name, "", kPlenty);
    EXPECT_EQ(volume.dimensions, expected.dimensions);
    EXPECT_TRUE(expected.activeVoxels == 0 || volume.activeVoxels == expected.activeVoxels)
        << volume.activeVoxels;
  }
}

TEST(RealVdb, TheRotatedDragonStaysRotated) {
  const fs::path file = kData / "dragon_with_xform.vdb";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const Volume volume = readVdb(file, "", kPlenty);
  int offDiagonal = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) offDiagonal += i != j && std::abs(volume.indexToWorld[i][j]) > 1e-3;
  EXPECT_GT(offDiagonal, 0);
}

TEST(RealVdb, TheLevelSetSphereHasItsVolume) {
  const fs::path file = kData / "sphere_ls.vdb";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const Volume volume = readVdb(file, "", kPlenty);
  double sum = 0.0;
  for (const float value : volume.values)
    if (value != kInactiveVoxel) sum += value;
  // 125 voxels with a narrow band of 3 outside: the radius is 60 voxels up to the rounding of the box.
  EXPECT_NEAR(std::cbrt(sum * 3.0 / (4.0 * std::numbers::pi)), 60.0, 0.5);
}

TEST(RealVdb, EveryFileIsReadOrRefusedInOneSentence) {
  if (!fs::exists(kData)) GTEST_SKIP() << "no real volumes in " << kData;
  for (const auto& entry : fs::recursive_directory_iterator(kData)) {
    SCOPED_TRACE(entry.path().string());
    try {
      EXPECT_GT(readVdb(entry.path(), "", kPlenty).activeVoxels, 0u);
      EXPECT_EQ(entry.path().extension(), ".vdb");
    } catch (const Error& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(error.code(), ExitCode::Input);
      EXPECT_EQ(sentence.find('\n'), std::string::npos);
      EXPECT_NE(sentence.find(entry.path().string()), std::string::npos) << sentence;
    }
  }
}

}  // namespace
}  // namespace freevoxels
