// The grids of a .vdb file: what is said of them, and how they are named and chosen.

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using test::expectRefusal;
using test::kPlenty;
using test::makeGrid;
using test::named;
using VdbInfo = test::Vdb;

TEST_F(VdbInfo, GridsThatShareANameAreToldApartByNumber) {
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

TEST_F(VdbInfo, TheDefaultGridIsDensityOrTheOnlyFloatGrid) {
  const auto velocity = named<openvdb::Vec3SGrid>(openvdb::Vec3SGrid::create(), "velocity");
  write({makeGrid("a", 0.1f), makeGrid("density", 0.2f), velocity});
  EXPECT_EQ(read().maximum, 0.2f);
  write({velocity, makeGrid("a", 0.3f)});
  EXPECT_EQ(read().maximum, 0.3f);
  write({makeGrid("a"), velocity, makeGrid("b")});
  expectReadRefused({file.string(), "'a' (float)", "'velocity' (vec3s)", "'b' (float)", "choose one with grid: "});
  write({velocity, named<openvdb::BoolGrid>(openvdb::BoolGrid::create(), "mask")});
  expectReadRefused({file.string(), "'velocity' (vec3s)", "'mask' (bool)"});
  expectReadRefused({"no grid 'smoke'", "'velocity' (vec3s)"}, "smoke");
}

TEST_F(VdbInfo, InfoGivesTheFigures) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(-2, 3, 4), Coord(7, 13, 15)), 0.5f);
  grid->tree().setValueOn(Coord(0, 5, 5), 2.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  write({grid});
  const GridInfo info = describeVdb(file).at(0);
  EXPECT_EQ(info.name, "density");
  EXPECT_EQ(info.valueType, "float");
  EXPECT_EQ(info.gridClass, "fog volume");
  EXPECT_EQ(info.activeVoxels, 10u * 11u * 12u);
  EXPECT_EQ(info.dimensions, glm::i64vec3(10, 11, 12));
  EXPECT_EQ(info.boundsMinimum, glm::ivec3(-2, 3, 4));
  EXPECT_EQ(info.boundsMaximum, glm::ivec3(7, 13, 15));
  EXPECT_EQ(info.voxelSize, glm::dvec3(0.25));
  EXPECT_TRUE(info.hasRange);
  EXPECT_EQ(info.minimum, 0.5);
  EXPECT_EQ(info.maximum, 2.0);
  EXPECT_GT(info.memoryBytes, 1320u * sizeof(float));
  EXPECT_EQ(info.unusable, "");
}

TEST_F(VdbInfo, InfoGivesTheBoxThatIsRendered) {
  const auto sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(1.0f, {0.0f, 0.0f, 0.0f}, 0.05f);
  const FloatGrid::Ptr outside = named<FloatGrid>(FloatGrid::create(3.0f), "outside");
  outside->setGridClass(openvdb::GRID_LEVEL_SET);
  outside->tree().setValueOn(Coord(0), 2.0f);
  write({named<FloatGrid>(sphere, "sphere"), makeGrid("fog"), outside});
  const std::vector<GridInfo> infos = describeVdb(file);
  EXPECT_EQ(infos.at(0).renderDimensions, read("sphere").dimensions);
  EXPECT_EQ(infos.at(0).renderDimensions.x, int(infos.at(0).dimensions.x) + 2) << "of the band of three voxels half counts, and a margin";
  EXPECT_EQ(glm::i64vec3(infos.at(1).renderDimensions), infos.at(1).dimensions);
  EXPECT_EQ(infos.at(2).renderDimensions, glm::ivec3(0));
  EXPECT_NE(infos.at(2).unusable.find("no voxel is inside"), std::string::npos);
  expectReadRefused({"outside", "no voxel is inside"}, "outside");
}

TEST_F(VdbInfo, LongNamesAreCutInMessages) {
  write({makeGrid(std::string(60'000, 'n'))});
  const std::string sentence = test::errorOf([&] { read("density"); }).what();
  EXPECT_LT(sentence.size(), 600u);
  EXPECT_NE(sentence.find("nnn...'"), std::string::npos);
}

TEST_F(VdbInfo, TheDefaultGridIsDensityInAnyCaseAndInLowerCaseFirst) {
  write({makeGrid("heat", 0.1f), makeGrid("Density", 0.2f)});
  EXPECT_EQ(read().maximum, 0.2f);
  write({makeGrid("Density", 0.2f), makeGrid("density", 0.3f), makeGrid("DENSITY", 0.4f)});
  EXPECT_EQ(read().maximum, 0.3f);
}

TEST_F(VdbInfo, ControlCharactersOfNamesAreEscapedAndTheEscapedNameIsTaken) {
  write({makeGrid("a\033[31m", 0.1f), makeGrid("b", 0.2f)});
  const std::vector<GridInfo> infos = describeVdb(file);
  ASSERT_EQ(infos[0].name, "a\\x1b[31m");
  EXPECT_EQ(read(infos[0].name).maximum, 0.1f);
  expectReadRefused({"'a\\x1b[31m'"}, "none");
}

TEST_F(VdbInfo, NamesThatInfoPrintsAreTaken) {
  write({makeGrid("a", 0.1f), makeGrid("a", 0.2f), makeGrid("b[1]", 0.3f), makeGrid("c\001", 0.4f), makeGrid("c\002", 0.5f)});
  std::vector<float> maxima;
  for (const GridInfo& info : describeVdb(file)) maxima.push_back(read(info.name).maximum);
  EXPECT_EQ(maxima, (std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f, 0.5f}));
}

TEST_F(VdbInfo, DimensionsBeyond32BitsAreCounted) {
  const FloatGrid::Ptr grid = makeGrid("density");
  grid->tree().setValueOn(Coord(std::numeric_limits<int>::min(), 0, 0), 1.0f);
  grid->tree().setValueOn(Coord(std::numeric_limits<int>::max(), 0, 0), 1.0f);
  write({grid});
  const GridInfo info = describeVdb(file).at(0);
  EXPECT_EQ(info.dimensions.x, std::int64_t(1) << 32);
  EXPECT_NE(info.unusable.find("too large"), std::string::npos);
  expectRefusal([&] { read(); }, ErrorKind::OutOfMemory, {"too large"});
}

}  // namespace
}  // namespace freevoxels
