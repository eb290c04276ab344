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

/// OpenVDB's own names of grids can be those that it gives to the second of several.
TEST_F(VdbInfo, GridsWhoseNamesLookLikeNumberedOnesAreAllDescribedAndRead) {
  struct Case {
    std::vector<std::string> written, shown;
  };
  const std::vector<Case> cases{
      {{"density", "density", "density[1]"}, {"density[0]", "density[1][0]", "density[1][1]"}},
      {{"density[1]", "density", "density"}, {"density[1][0]", "density[0]", "density[1][1]"}},
      {{"density[1]", "density[1]"}, {"density[1][0]", "density[1][1]"}},
      {{"density[1]", "density[1]", "density", "density", "heat"}, {"density[1][0]", "density[1][1]", "density[0]", "density[1]", "heat"}},
      {{"density[1]", "density", "density", "density[1][0]"}, {"density[1][1]", "density[0]", "density[1][2]", "density[1][0]"}},
      {{"[1]", "", ""}, {"[1][0]", "[0]", "[1][1]"}},
      {{"a[b", "a[b", "a]", "a]", "[]", "[]"}, {"a[b[0]", "a[b[1]", "a][0]", "a][1]", "[][0]", "[][1]"}}};
  for (const Case& one : cases) {
    openvdb::GridPtrVec grids;
    for (const std::string& name : one.written) grids.push_back(makeGrid(name, 0.125f * float(grids.size() + 1)));
    write(grids);
    const std::vector<GridInfo> infos = describeVdb(file);
    const std::vector<GridChoice> choices = listVdb(file);
    ASSERT_EQ(infos.size(), grids.size());
    for (std::size_t i = 0; i < infos.size(); ++i) {
      SCOPED_TRACE(one.shown[i]);
      EXPECT_EQ(infos[i].name, one.shown[i]);
      EXPECT_EQ(choices[i].name, one.shown[i]);
      EXPECT_EQ(infos[i].maximum, 0.125 * double(i + 1));
      EXPECT_EQ(read(one.shown[i]).maximum, 0.125f * float(i + 1));
    }
  }
}

TEST_F(VdbInfo, TheNameOfSeveralGridsChoosesTheFirstAndSaysHowToNameTheOthers) {
  write({makeGrid("density", 0.1f), makeGrid("density", 0.2f), makeGrid("density[1]", 0.3f), makeGrid("heat", 0.4f)});
  const Volume volume = read("density[1]");
  EXPECT_EQ(volume.maximum, 0.2f);
  ASSERT_EQ(volume.warnings.size(), 1u);
  EXPECT_NE(volume.warnings[0].find("2 grids named 'density[1]': using 'density[1][0]'"), std::string::npos) << volume.warnings[0];
  EXPECT_NE(volume.warnings[0].find("chooses 'density[1][1]'"), std::string::npos) << volume.warnings[0];
  EXPECT_EQ(read("heat").maximum, 0.4f);
  EXPECT_TRUE(read("density[1][1]").warnings.empty());
}

TEST_F(VdbInfo, GridsUnderTheSameNameInTheFileAreAllDescribedAndRead) {
  write({makeGrid("density", 0.25f), makeGrid("density", 0.5f), makeGrid("heat", 1.0f)});
  std::string bytes = test::readBytes(file);
  const std::string second = std::string("density\x1e") + "1";
  std::size_t places = 0;
  for (std::size_t at = bytes.find(second); at != std::string::npos; at = bytes.find(second, at + 1), ++places) bytes[at + second.size() - 1] = '0';
  ASSERT_GE(places, 1u);
  test::writeBytes(file, bytes);
  const std::vector<GridInfo> infos = describeVdb(file);
  ASSERT_EQ(infos.size(), 3u);
  for (const auto& [place, name, value] : {std::tuple(0, "density[0][0]", 0.25f), std::tuple(1, "density[0][1]", 0.5f), std::tuple(2, "heat", 1.0f)}) {
    EXPECT_EQ(infos[std::size_t(place)].name, name);
    EXPECT_EQ(infos[std::size_t(place)].maximum, double(value));
    EXPECT_EQ(read(name).maximum, value);
  }
  EXPECT_EQ(read().maximum, 0.25f);
}

/// The tree of an instance is that of the grid with its parent's name, not of one that OpenVDB confuses with it.
TEST_F(VdbInfo, AnInstanceOfAGridWithAConfusingNameHasItsTree) {
  const FloatGrid::Ptr parent = makeGrid("density", 0.25f), instance = FloatGrid::create(parent->treePtr());
  instance->setName("instance");
  write({makeGrid("density", 0.5f), parent, makeGrid("density[1]", 0.75f), instance});
  EXPECT_EQ(read("instance").maximum, 0.25f);
  EXPECT_EQ(describeVdb(file).at(3).maximum, 0.25);
}

TEST_F(VdbInfo, TheDefaultGridIsDensityOrTheOnlyFloatGrid) {
  const auto velocity = named<openvdb::Vec3SGrid>(openvdb::Vec3SGrid::create(), "velocity");
  write({makeGrid("a", 0.1f), makeGrid("density", 0.2f), velocity});
  EXPECT_EQ(read().maximum, 0.2f);
  write({velocity, makeGrid("a", 0.3f)});
  EXPECT_EQ(read().maximum, 0.3f);
  write({makeGrid("a"), velocity, makeGrid("b")});
  expectReadRefused({file.string(), "'a' (float)", "'velocity' (vec3s)", "'b' (float)", "choose one with grid: "});
  write({velocity, named<openvdb::Vec3IGrid>(openvdb::Vec3IGrid::create(), "ids")});
  expectReadRefused({file.string(), "'velocity' (vec3s)", "'ids' (vec3i)"});
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
