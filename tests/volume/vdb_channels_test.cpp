// Temperatures and albedos that are read beside the densities.

#include <limits>

#include "engine/volume/classification.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels::test {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

class VdbChannelsTest : public Vdb {
 protected:
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
  const Volume volume = readWith({.temperature = ""});
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
  for (std::size_t i = 0; i < volume.temperature->values.bricks().size(); ++i)
    EXPECT_NE(volume.scalars.brickAt(volume.temperature->values.cell(i)), nullptr);
  // Nothing of it without being asked.
  EXPECT_EQ(readWith({}).dimensions, glm::ivec3(4));
}

TEST_F(VdbChannelsTest, DefaultNamesComeInOrder) {
  write({makeGrid("density"), makeGrid("flame"), makeGrid("heat"), makeGrid("temperature")});
  EXPECT_EQ(readWith({.temperature = ""}).temperature->name, "temperature");
  EXPECT_EQ(readWith({.temperature = "flame"}).temperature->name, "flame");
  write({makeGrid("density"), makeGrid("flame"), makeGrid("heat")});
  EXPECT_EQ(readWith({.temperature = ""}).temperature->name, "heat");
}

TEST_F(VdbChannelsTest, NotANumberCountsAsNothing) {
  const auto heat = makeGrid("heat", 0.5f);
  heat->tree().setValue(Coord(1, 1, 1), std::numeric_limits<float>::quiet_NaN());
  write({makeGrid("density"), heat});
  const Volume volume = readWith({.temperature = "heat"});
  EXPECT_EQ(volume.temperature->nanVoxels, 1u);
  EXPECT_EQ(volume.temperature->values.at({1, 1, 1}), 0.0f);
  EXPECT_EQ(volume.temperature->maximum, 0.5f);
}

TEST_F(VdbChannelsTest, WhatCannotBeTemperaturesIsRefused) {
  const auto scaled = makeGrid("heat");
  scaled->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  write({makeGrid("density"), scaled, colours({Coord(0), Coord(1)}, openvdb::Vec3s(0.5f))});
  expectRefused({.temperature = "heat"}, {"heat", "density", "transform", "resample"});
  expectRefused({.temperature = "Cd"}, {"Cd", "vec3s", "with temperature-grid"});
  expectRefused({.temperature = "none"}, {"none", "heat"});
  write({makeGrid("density"), makeGrid("fuel")});
  expectRefused({.temperature = ""}, {"temperature", "heat", "flame", "with temperature-grid", "fuel"});
}

TEST_F(VdbChannelsTest, ColoursAreCutToWhatAnAlbedoCanBe) {
  const auto cd = colours({Coord(-3), Coord(20)}, openvdb::Vec3s(0.25f, 0.5f, 0.75f));
  cd->tree().setValue(Coord(1, 2, 3), openvdb::Vec3s(-1.0f, 0.5f, 2.0f));
  cd->tree().setValueOff(Coord(0, 2, 3));
  write({makeGrid("density"), cd});
  const Volume volume = readWith({.albedo = "Cd"});
  EXPECT_EQ(volume.dimensions, glm::ivec3(2, 3, 4));  // without density an albedo is of nothing
  ASSERT_TRUE(volume.albedo);
  EXPECT_EQ(volume.albedo->clippedVoxels, 1u);
  const Classification classification{.albedo = glm::vec3(0.125f)};
  EXPECT_EQ(albedoOf(classification, *volume.albedo, {1, 1, 1}), glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(albedoOf(classification, *volume.albedo, {1, 2, 3}), glm::vec3(0.0f, 0.5f, 1.0f));
  EXPECT_EQ(albedoOf(classification, *volume.albedo, {0, 2, 3}), glm::vec3(0.125f));
  expectRefused({.albedo = "density"}, {"density", "float", "with albedo-grid"});
  expectRefused({.albedo = "none"}, {"none"});
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
  const Volume read = readWith({.temperature = ""});
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
