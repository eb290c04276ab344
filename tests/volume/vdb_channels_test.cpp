// Temperatures and albedos that are read beside the densities.

#include <cmath>
#include <limits>

#include "engine/volume/classification.h"
#include "engine/volume/grid_names.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels::test {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

class VdbChannelsTest : public Vdb {
 protected:
  static GridRequest asked(const std::string& name) { return {.name = name, .isRequired = true}; }
  Volume readWith(const MoreGrids& more) const { return readVdb(file, "density", kPlenty, more); }
  void expectRefused(const MoreGrids& more, std::initializer_list<std::string> parts) const {
    expectRefusal([&] { readWith(more); }, ErrorKind::Input, parts);
  }
  static openvdb::Vec3SGrid::Ptr colours(const CoordBBox& box, const openvdb::Vec3s& value) {
    const auto grid = named<openvdb::Vec3SGrid>(openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f)), "Cd");
    grid->denseFill(box, value, true);
    return grid;
  }
};

TEST_F(VdbChannelsTest, TheBoxIsAroundBothAndEveryTemperatureHasABrick) {
  write({makeGrid("density", {Coord(3), Coord(6)}, 0.5f),
         makeGrid("heat", {Coord(5), Coord(40, 6, 20)}, 0.7f)});
  const Volume volume = readWith({.temperature = asked("")});
  EXPECT_EQ(volume.indexOrigin, glm::ivec3(3));
  EXPECT_EQ(volume.dimensions, glm::ivec3(38, 4, 18));
  ASSERT_TRUE(volume.temperature);
  EXPECT_EQ(volume.temperature->name, "heat");
  EXPECT_EQ(volume.temperature->activeVoxels, 36u * 2u * 16u);
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x) {
        const bool hot = x >= 2 && y >= 2 && z >= 2, dense = x < 4 && y < 4 && z < 4;
        EXPECT_EQ(volume.temperature->values.at({x, y, z}), hot ? 0.7f : kInactiveVoxel);
        EXPECT_EQ(volume.scalar(x, y, z), dense ? 0.5f : kInactiveVoxel);
      }
  for (std::size_t i = 0; i < volume.temperature->values.count(); ++i)
    EXPECT_TRUE(volume.scalars.numberAt(volume.temperature->values.cell(i)).has_value());
  // Nothing of it without being asked.
  EXPECT_EQ(readWith({}).dimensions, glm::ivec3(4));
}

TEST_F(VdbChannelsTest, DefaultNamesComeInOrder) {
  write({makeGrid("density"), makeGrid("flame"), makeGrid("heat"), makeGrid("temperature")});
  EXPECT_EQ(readWith({.temperature = asked("")}).temperature->name, "temperature");
  EXPECT_EQ(readWith({.temperature = asked("flame")}).temperature->name, "flame");
  write({makeGrid("density"), makeGrid("flame"), makeGrid("heat")});
  EXPECT_EQ(readWith({.temperature = asked("")}).temperature->name, "heat");
}

/// The programs that wrote such names: EmberGen, Houdini, Blender, PhoenixFD, FumeFX, Bifrost.
TEST_F(VdbChannelsTest, GridsAreRecognisedByTheNamesOfManyPrograms) {
  struct Case {
    std::vector<std::string> names;
    std::string density, temperature;
  };
  const MoreGrids automatic{.temperature = GridRequest{}, .albedo = GridRequest{}};
  for (const Case& one :
       {Case{{"smoke", "flames", "fuel"}, "smoke", "flames"}, Case{{"burn", "Density", "heat", "pressure"}, "Density", "heat"},
        Case{{"density", "flame", "shadow", "temperature"}, "density", "temperature"},
        Case{{"Smoke", "Fuel", "Temperature"}, "Smoke", "Temperature"}, Case{{"fire", "smoke"}, "smoke", "fire"},
        Case{{"voxel_fog_density", "voxel_temperature"}, "voxel_fog_density", "voxel_temperature"},
        Case{{"DENSITY", "density", "smoke"}, "density", ""}, Case{{"value", "fuel"}, "value", ""}}) {
    openvdb::GridPtrVec grids;
    for (const std::string& name : one.names) grids.push_back(makeGrid(name));
    grids.push_back(colours({Coord(0), Coord(1)}, openvdb::Vec3s(0.5f)));
    write(grids);
    const Volume volume = readVdb(file, "", kPlenty, automatic);
    SCOPED_TRACE(one.names.front());
    EXPECT_EQ(volume.source, "test.vdb " + one.density);
    EXPECT_EQ(volume.temperature ? volume.temperature->name : "", one.temperature);
    EXPECT_EQ(volume.albedo ? volume.albedo->name : "", "Cd");
  }
}

TEST(GridNames, CaseAndSeparatorsMeanNothing) {
  for (const char* name :
       {"density", "Density", "DENSITY", "smoke", "Smoke", "smoke_density", "VoxelDensity", "density_grid", "soot", "fog"})
    EXPECT_EQ(roleOfName(name).role, GridRole::Density) << name;
  for (const char* name : {"temperature", "Temperature", "heat", "flame", "flames", "Fire", "burn", "flame-intensity", "VoxelTemperature"})
    EXPECT_EQ(roleOfName(name).role, GridRole::Temperature) << name;
  for (const char* name : {"Cd", "cd", "color", "Colour", "colorGrid", "scatter", "albedo"})
    EXPECT_EQ(roleOfName(name).role, GridRole::Color) << name;
  for (const char* name : {"Cd.x", "Cd_y", "color.r", "Color B"}) EXPECT_EQ(roleOfName(name).role, GridRole::ColorComponent) << name;
  for (const char* name : {"fuel", "vel.x", "velX", "pressure", "shadow", "fuel_"})
    EXPECT_EQ(roleOfName(name).role, GridRole::Other) << name;
  for (const char* name : {"", "x", "mydensity2", "posdensity", "temperature1", "grid", "...."})
    EXPECT_EQ(roleOfName(name).role, GridRole::Unknown) << name;
  EXPECT_LT(roleOfName("temperature").rank, roleOfName("flames").rank);
  EXPECT_TRUE(roleOfName("flames").isFlame);
  EXPECT_FALSE(roleOfName("heat").isFlame);
}

TEST_F(VdbChannelsTest, ColoursInAGridForEachComponentAreNamed) {
  write({makeGrid("density", 0.5f), makeGrid("Cd.x", 0.1f), makeGrid("Cd.y", 0.2f), makeGrid("Cd.z", 0.3f)});
  const Volume volume = readWith({.albedo = GridRequest{}});
  EXPECT_FALSE(volume.albedo);
  ASSERT_EQ(volume.remarks.size(), 1u);
  EXPECT_NE(volume.remarks[0].find("'Cd.x'"), std::string::npos) << volume.remarks[0];
  EXPECT_TRUE(readWith({}).remarks.empty()) << "colours are not asked for";
}

TEST_F(VdbChannelsTest, WhatIsNoDensityNeitherBurnsNorHasColours) {
  write({makeGrid("density", 0.5f), makeGrid("temperature", 1500.0f), makeGrid("pressure", 3.0f),
         colours({Coord(0), Coord(3)}, openvdb::Vec3s(0.5f))});
  const MoreGrids usual{.temperature = GridRequest{}, .albedo = GridRequest{}};
  for (const auto& [name, burns] : {std::pair("density", true), {"pressure", false}, {"temperature", false}}) {
    const Volume volume = readVdb(file, {.grid = name, .maximumVoxels = kPlenty, .more = usual});
    EXPECT_EQ(volume.temperature.has_value(), burns) << name;
    EXPECT_EQ(volume.albedo.has_value(), burns) << name;
  }
  EXPECT_TRUE(
      readVdb(file, {.grid = "pressure", .maximumVoxels = kPlenty, .more = {.temperature = test::required("temperature")}}).temperature);
}

TEST_F(VdbChannelsTest, TemperaturesOfWeatherAloneAreDrawnLikeADensity) {
  for (const float value : {290.0f, -20.0f}) {
    const auto field = makeGrid("temperature", value);
    field->tree().setValueOn(Coord(0), 30.0f);
    write({field});
    const Volume volume = readVdb(file, "", kPlenty, {.temperature = GridRequest{}, .albedo = GridRequest{}});
    EXPECT_FALSE(volume.temperature) << value;
    EXPECT_EQ(volume.activeVoxels, 24u);
    ASSERT_FALSE(volume.remarks.empty());
    EXPECT_NE(volume.remarks[0].find("too cold to shine"), std::string::npos) << volume.remarks[0];
  }
}

TEST_F(VdbChannelsTest, AFileOfTemperaturesAloneIsAFlameWithoutDensity) {
  write({makeGrid("flames", {Coord(3), Coord(6)}, 0.7f), makeGrid("fuel", {Coord(0), Coord(9)}, 1.0f)});
  const Volume flame = readVdb(file, "", kPlenty, {.temperature = GridRequest{}});
  EXPECT_EQ(flame.activeVoxels, 0u);
  EXPECT_EQ(flame.dimensions, glm::ivec3(4));
  ASSERT_TRUE(flame.temperature);
  EXPECT_EQ(flame.temperature->activeVoxels, 64u);
  EXPECT_EQ(readVdb(file, "flames", kPlenty).activeVoxels, 64u) << "as a density, since it is named";
  EXPECT_THROW(readVdb(file, "", kPlenty), EmptyVolumeError);
  write({makeGrid("temperature", {Coord(3), Coord(6)}, 293.0f)});
  EXPECT_THROW(readVdb(file, "", kPlenty, {.temperature = GridRequest{}, .mayBeMissing = true}), EmptyVolumeError)
      << "a frame in which nothing is hot enough";
}

TEST_F(VdbChannelsTest, ASimulationWithoutFlamesDoesNotBurn) {
  const auto nothing = makeGrid("flame", openvdb::CoordBBox(), 0.0f);
  write({makeGrid("density"), makeGrid("temperature", 1.0f), nothing});
  EXPECT_FALSE(readWith({.temperature = GridRequest{}}).temperature->isBurning);
  EXPECT_TRUE(readWith({.temperature = asked("")}).temperature->isBurning) << "it is asked for";
  write({makeGrid("density"), makeGrid("temperature", 1500.0f), nothing});
  EXPECT_TRUE(readWith({.temperature = GridRequest{}}).temperature->isBurning) << "they are kelvin";
}

TEST_F(VdbChannelsTest, AFrameMayLackAnyGrid) {
  write({makeGrid("density")});
  const MoreGrids more{.temperature = asked("heat"), .albedo = asked("Cd"), .mayBeMissing = true};
  EXPECT_FALSE(readVdb(file, "density", kPlenty, more).temperature);
  EXPECT_THROW(readVdb(file, "smoke", kPlenty, more), EmptyVolumeError);
  write({makeGrid("density"), makeGrid("heat")});
  const Volume flame = readVdb(file, "smoke", kPlenty, more);
  EXPECT_EQ(flame.activeVoxels, 0u);
  EXPECT_TRUE(flame.temperature);
}

/// A linear field is the same whatever the voxels that it is sampled at, where all neighbours are active.
TEST_F(VdbChannelsTest, GridsOnOtherVoxelsAreResampled) {
  const auto field = [](const openvdb::Vec3d& world) { return float(100.0 + 3.0 * world.x() - 2.0 * world.y() + world.z()); };
  for (const double voxel : {0.5, 2.0, 0.7, 1.0}) {
    SCOPED_TRACE(voxel);
    const auto heat = makeGrid("heat", openvdb::CoordBBox(), 0.0f);
    heat->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    heat->transform().postTranslate(openvdb::Vec3d(0.3, -0.2, 0.1));
    const auto tint = colours(openvdb::CoordBBox(), openvdb::Vec3s(0.0f));
    tint->setTransform(heat->transform().copy());
    const int last = int(std::ceil(14.0 / voxel));
    for (int z = -3; z <= last; ++z)
      for (int y = -3; y <= last; ++y)
        for (int x = -3; x <= last; ++x) {
          heat->tree().setValueOn(Coord(x, y, z), field(heat->indexToWorld(Coord(x, y, z))));
          tint->tree().setValueOn(Coord(x, y, z), openvdb::Vec3s(0.25f, 0.5f, 0.75f));
        }
    write({makeGrid("density", {Coord(0), Coord(9)}, 0.5f), heat, tint});
    const Volume volume = readWith({.temperature = GridRequest{}, .albedo = GridRequest{}});
    for (const glm::ivec3 voxelIndex : {glm::ivec3(0), glm::ivec3(3, 5, 7), glm::ivec3(9)}) {
      const glm::ivec3 place = voxelIndex - volume.indexOrigin;
      EXPECT_NEAR(volume.temperature->values.at(place), field({double(voxelIndex.x), double(voxelIndex.y), double(voxelIndex.z)}), 1e-3);
      EXPECT_NEAR(albedoOf({}, *volume.albedo, place).y, 0.5f, 1e-6);
    }
    EXPECT_EQ(volume.remarks.size(), 4u) << "two are resampled, two recognised";
  }
}

/// Matrices of single precision differ in their last digits.
TEST_F(VdbChannelsTest, LatticesThatDifferByRoundingAreTheSame) {
  const auto heat = makeGrid("heat", 0.7f);
  heat->setTransform(openvdb::math::Transform::createLinearTransform(1.0 + 1e-7));
  write({makeGrid("density"), heat});
  const Volume volume = readWith({.temperature = asked("heat")});
  EXPECT_EQ(volume.temperature->minimum, 0.7f);
  EXPECT_EQ(volume.temperature->activeVoxels, 24u);
}

TEST_F(VdbChannelsTest, NotANumberCountsAsNothing) {
  const auto heat = makeGrid("heat", 0.5f);
  heat->tree().setValue(Coord(1, 1, 1), std::numeric_limits<float>::quiet_NaN());
  write({makeGrid("density"), heat});
  const Volume volume = readWith({.temperature = asked("heat")});
  EXPECT_EQ(volume.temperature->nanVoxels, 1u);
  EXPECT_EQ(volume.temperature->values.at({1, 1, 1}), kInactiveVoxel);
  EXPECT_EQ(volume.temperature->maximum, 0.5f);
}

TEST_F(VdbChannelsTest, WhatCannotBeTemperaturesIsRefused) {
  const auto frustum = makeGrid("heat");
  frustum->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(9.0)), 0.5, 1.0));
  write({makeGrid("density"), frustum, colours({Coord(0), Coord(1)}, openvdb::Vec3s(0.5f))});
  expectRefused({.temperature = asked("heat")}, {"heat", "frustum", "resample"});
  expectRefused({.temperature = asked("Cd")}, {"Cd", "vec3s", "with temperature-grid"});
  expectRefused({.temperature = asked("none")}, {"none", "heat"});
  write({makeGrid("density"), makeGrid("fuel")});
  expectRefused({.temperature = asked("")}, {"temperature", "heat", "flame", "with temperature-grid", "fuel"});
}

TEST_F(VdbChannelsTest, ColoursAreCutToWhatAnAlbedoCanBe) {
  const auto cd = colours({Coord(-3), Coord(20)}, openvdb::Vec3s(0.25f, 0.5f, 0.75f));
  cd->tree().setValue(Coord(1, 2, 3), openvdb::Vec3s(-1.0f, 0.5f, 2.0f));
  cd->tree().setValueOff(Coord(0, 2, 3));
  write({makeGrid("density"), cd});
  const Volume volume = readWith({.albedo = asked("Cd")});
  EXPECT_EQ(volume.dimensions, glm::ivec3(2, 3, 4));  // without density an albedo is of nothing
  ASSERT_TRUE(volume.albedo);
  EXPECT_EQ(volume.albedo->clippedVoxels, 1u);
  const Classification classification{.albedo = glm::vec3(0.125f)};
  EXPECT_EQ(albedoOf(classification, *volume.albedo, {1, 1, 1}), glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(albedoOf(classification, *volume.albedo, {1, 2, 3}), glm::vec3(0.0f, 0.5f, 1.0f));
  EXPECT_EQ(albedoOf(classification, *volume.albedo, {0, 2, 3}), glm::vec3(0.125f));
  expectRefused({.albedo = asked("density")}, {"density", "float", "with albedo-grid"});
  expectRefused({.albedo = asked("none")}, {"none"});
}

TEST_F(VdbChannelsTest, TheGridsAreListedForWhatTheyCanBe) {
  const auto velocity = colours({Coord(0), Coord(1)}, openvdb::Vec3s(0.5f));
  velocity->setName("v");
  velocity->setGridClass(openvdb::GRID_STAGGERED);
  write({makeGrid("density"), makeGrid("heat"), makeGrid("density"),
         colours({Coord(0), Coord(1)}, openvdb::Vec3s(0.5f)), velocity});
  const std::vector<GridChoice> choices = listVdb(file);
  const std::vector<GridInfo> infos = describeVdb(file);
  ASSERT_EQ(choices.size(), infos.size());
  for (std::size_t i = 0; i < infos.size(); ++i) {
    EXPECT_EQ(choices[i].name, infos[i].name);
    EXPECT_EQ(choices[i].isDensity, infos[i].unusable.empty());
    EXPECT_EQ(choices[i].isScalar, infos[i].hasRange);
    EXPECT_EQ(choices[i].isTemperature, infos[i].isTemperature);
    EXPECT_EQ(choices[i].isAlbedo, infos[i].isAlbedo);
  }
  EXPECT_TRUE(choices[1].isTemperature);
  EXPECT_TRUE(choices[3].isAlbedo);
  EXPECT_FALSE(choices[4].isAlbedo) << "velocities";
}

/// So the box around both grids is, and the densities as they were.
TEST_F(VdbChannelsTest, AFireGoesThroughAFile) {
  Volume fire = makeProcedural("fire", 24);
  cropToActive(fire);
  writeVdb(file, fire, "density");
  const Volume read = readWith({.temperature = asked("")});
  ASSERT_EQ(read.dimensions, fire.dimensions);
  EXPECT_EQ(read.temperature->activeVoxels, fire.temperature->activeVoxels);
  EXPECT_EQ(denseScalars(read), denseScalars(fire));
  EXPECT_GT(fire.temperature->maximum, 1500.0f);
}

TEST(CropToActive, TakesTheAlbedosAlong) {
  const glm::ivec3 size(5, 4, 3);
  Volume volume = makeVolume(size, glm::dmat4(1.0), [](int x, int y, int) {
    return x >= 3 && y >= 1 ? 1.0 : double(kInactiveVoxel);
  });
  volume.albedo.emplace();
  for (ScalarBricks& values : volume.albedo->values)
    values = ScalarBricks::make(size, [](glm::ivec3 v) { return 0.1f * float(v.x) + 0.01f * float(v.y); });
  cropToActive(volume);
  ASSERT_EQ(volume.dimensions, glm::ivec3(2, 3, 3));
  for (const ScalarBricks& values : volume.albedo->values) {
    EXPECT_EQ(values.at({0, 0, 0}), 0.1f * 3.0f + 0.01f * 1.0f);
    EXPECT_EQ(values.at({1, 2, 2}), 0.1f * 4.0f + 0.01f * 3.0f);
  }
}

}  // namespace
}  // namespace freevoxels::test
