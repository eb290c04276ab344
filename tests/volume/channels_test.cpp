// Volumes of several channels: what is read, and what the channels add up to.

#include "engine/volume/channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/description/label_words.h"
#include "engine/description/scene_description.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/volume_of_scalars.h"
#include "engine/volume/voxel_classifier.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using test::expectRefusal;
using test::kPlenty;
using test::Vdb;

ChannelStyle channel(const std::string& text) {
  return readChannel("channel", text);
}

/// A ramp along x, and one along y, in a box that ends inside of bricks.
std::vector<ScalarBricks> ramps(glm::ivec3 size) {
  return {ScalarBricks::make(size, [](glm::ivec3 v) { return float(v.x); }),
          ScalarBricks::make(size, [](glm::ivec3 v) { return float(10 * v.y); })};
}

TEST(Channels, WordsAreReadAndWritten) {
  for (const std::string text : {"dapi", "0:#0000ff", "gfp:#00ff00@0.5:100,4000:emission", "2:@3", "a b:10.5,20", "x:emission",
                                 "ct:ct-bone:-100,900", "ct:../bone.json:#ff0000@2", "ct:ct-bone:@0.5"})
    EXPECT_EQ(channelText(channel(text)), text);
  EXPECT_EQ(channelText(channel("ct:ct-bone@0.5")), "ct:ct-bone:@0.5");
  EXPECT_EQ(channelText(channel("dapi:emission:1,2:blue")), "dapi:#0000ff:1,2:emission") << "in any order";
  for (const std::string text : {"", ":red", "a:", "a:2,1", "a:1,2,3", "a:red@-1", "a:red@x"})
    expectRefusal([&] { channel(text); }, ErrorKind::Usage, {"channel"});
}

TEST(Channels, ExtinctionsAddUpAndColoursAreWeightedByThem) {
  const Volume volume = volumeOfChannels(ramps({11, 5, 9}), glm::dmat4(1.0), {channel("0:red:0,10"), channel("1:blue@2:0,40")});
  const Classification classification{.densityScale = 3.0};
  const VoxelClassifier classifier(classification, volume);
  for (const glm::ivec3 v : {glm::ivec3(0, 0, 0), glm::ivec3(5, 0, 3), glm::ivec3(0, 4, 8), glm::ivec3(10, 1, 7), glm::ivec3(7, 3, 0)}) {
    const double red = 3.0 * std::min(v.x / 10.0, 1.0), blue = 3.0 * 2.0 * std::min(10.0 * v.y / 40.0, 1.0);
    const ClassifiedVoxel seen = classifier.at(v);
    EXPECT_NEAR(seen.extinction, red + blue, 1e-5);
    if (red + blue == 0.0) continue;
    EXPECT_NEAR(seen.color.r * seen.extinction, red, 1e-5);
    EXPECT_NEAR(seen.color.b * seen.extinction, blue, 1e-5);
    EXPECT_EQ(seen.emission, glm::dvec3(0.0));
  }
}

TEST(Channels, TransferFunctionsGiveColoursAndIntensitiesByValue) {
  const std::string file = testing::TempDir() + "channel_function.json";
  std::ofstream(file) << R"({"range": [0, 10], "unit_distance": 1, "opacity": [[0, 0], [0.5, 0.5], [1, 0.9]],
                             "color": [[0, 1, 0, 0], [1, 0, 1, 0]]})";
  const Volume volume = volumeOfChannels(ramps({11, 5, 9}), glm::dmat4(1.0), {channel("0:" + file), channel("1:blue@2:0,40")});
  const Classification classification{.densityScale = 3.0};
  const VoxelClassifier classifier(classification, volume);
  for (const glm::ivec3 v : {glm::ivec3(0, 1, 0), glm::ivec3(5, 0, 3), glm::ivec3(10, 1, 7), glm::ivec3(5, 2, 8)}) {
    const double opacity = v.x == 0 ? 0.0 : v.x == 5 ? 0.5 : 0.9, own = 3.0 * std::log(1.0 - opacity) / std::log(1.0 - 0.9);
    const double blue = 3.0 * 2.0 * std::min(10.0 * v.y / 40.0, 1.0);
    const ClassifiedVoxel seen = classifier.at(v);
    EXPECT_NEAR(seen.extinction, own + blue, 1e-3);
    EXPECT_NEAR(seen.color.r * seen.extinction, own * (1.0 - v.x / 10.0), 1e-3);
    EXPECT_NEAR(seen.color.g * seen.extinction, own * v.x / 10.0, 1e-3);
    EXPECT_NEAR(seen.color.b * seen.extinction, blue, 1e-3);
  }
  expectRefusal(
      [&] {
        volumeOfChannels(ramps({3, 3, 3}), glm::dmat4(1.0), {channel("0:nocolour"), channel("1")});
      },
      ErrorKind::Input, {"nocolour", "preset"});
}

TEST(Channels, LightAddsUpAndNothingIsDimmed) {
  const Volume volume =
      volumeOfChannels(ramps({11, 5, 9}), glm::dmat4(1.0), {channel("0:red:0,10:emission"), channel("1:#00ffff:0,40:emission")});
  EXPECT_EQ(volume.activeVoxels, 0u);
  const EmissionDescription description{.strength = 5.0};
  ASSERT_TRUE(description.shines(volume));
  const Classification classification{.emission = description.resolve(volume, {})};
  const VoxelClassifier classifier(classification, volume);
  const ClassifiedVoxel seen = classifier.at({4, 3, 8});
  EXPECT_EQ(seen.extinction, 0.0);
  EXPECT_NEAR(seen.emission.r, 5.0 * 0.4, 1e-5);
  EXPECT_NEAR(seen.emission.g, 5.0 * 0.75, 1e-5);
  EXPECT_NEAR(seen.emission.b, 5.0 * 0.75, 1e-5);
  EXPECT_GT(EmissionDescription().resolve(volume, {})->strength, 0.0) << "chosen for an image";
}

TEST(Channels, ThoseWithAndWithoutEmissionMixInOneVolume) {
  const Volume volume = volumeOfChannels(ramps({11, 5, 9}), glm::dmat4(1.0), {channel("0:red:0,10:emission"), channel("1:blue:0,40")});
  const Classification classification{.densityScale = 3.0, .emission = EmissionDescription{.strength = 5.0}.resolve(volume, {})};
  const auto expectMixed = [&](const Volume& mixed) {
    const ClassifiedVoxel seen = VoxelClassifier(classification, mixed).at({4, 3, 8});
    EXPECT_NEAR(seen.extinction, 3.0 * 0.75, 1e-4);
    EXPECT_EQ(glm::vec3(seen.color), glm::vec3(0.0f, 0.0f, 1.0f)) << "the light has a colour of its own";
    EXPECT_NEAR(seen.emission.r, 5.0 * 0.4, 1e-5);
    EXPECT_EQ(seen.emission.b, 0.0);
  };
  expectMixed(volume);
  const std::string file = testing::TempDir() + "mixed_channels.fvx";
  bakeVolume(file, volume, classification, {.keepScalars = true});
  expectMixed(readBaked(std::make_shared<const fvx::FvxFile>(file)));
  const Volume coarse = coarseVolume(volume, 2, WithoutData::Zero);
  EXPECT_EQ(coarse.madeOf, MadeOf::Channels);
  EXPECT_GT(VoxelClassifier(classification, coarse).at({2, 1, 4}).emission.r, 0.0);
}

TEST(Channels, AWindowThatIsNotGivenLeavesOutTheBrightestThousandth) {
  const auto values = [] {
    return std::vector<ScalarBricks>{ScalarBricks::make(
        glm::ivec3(40, 30, 20), [](glm::ivec3 v) { return v == glm::ivec3(7, 7, 7) ? 900.0f : 10.0f + float((v.x + v.y + v.z) % 50); })};
  };
  const Volume volume = volumeOfChannels(values(), glm::dmat4(1.0), {channel("0")});
  EXPECT_EQ(volume.scalars.at({0, 0, 0}), kInactiveVoxel) << "the least value";
  EXPECT_NEAR(volume.scalars.at({20, 5, 0}), 25.0f / 49.0f, 0.02f);
  EXPECT_EQ(volume.scalars.at({7, 7, 7}), 1.0f);
  EXPECT_EQ(albedoOf({}, *volume.albedo, {7, 7, 7}), automaticChannelColor(0));
}

TEST(Channels, WhatCannotBeDrawnTogetherIsRefused) {
  expectRefusal([] { checkCount(std::vector<ChannelStyle>(17)); }, ErrorKind::Usage, {"16", "17"});
  expectRefusal([] { channelNumber(channel("3"), 3); }, ErrorKind::Input, {"3"});
  expectRefusal(
      [] {
        volumeOfChannels(ramps({4, 4, 4}), glm::dmat4(1.0), {channel("0:100,200"), channel("1:100,200")});
      },
      ErrorKind::Input, {"window"});
}

TEST_F(Vdb, ChannelsAreGridsByNameOrNumberOnTheLatticeOfTheFirst) {
  const openvdb::FloatGrid::Ptr red = test::makeGrid("red", {Coord(0, 0, 0), Coord(9, 9, 9)}, 4.0f);
  const openvdb::Int32Grid::Ptr count = openvdb::Int32Grid::create(0);
  count->setName("count");
  count->denseFill(CoordBBox(Coord(5, 5, 5), Coord(19, 7, 7)), 30, true);
  const openvdb::FloatGrid::Ptr coarse = test::makeGrid("coarse", {Coord(0, 0, 0), Coord(9, 9, 9)}, 8.0f);
  coarse->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  write({red, count, coarse});
  const ReadRequest request{.maximumVoxels = kPlenty,
                            .channels = {channel("red:red:0,4"), channel("1:#00ff00:0,60"), channel("coarse:blue:0,32")}};
  const Volume volume = readVdb(file, request);
  EXPECT_EQ(volume.dimensions, glm::ivec3(21)) << "what is resampled reaches a voxel farther";
  EXPECT_EQ(volume.remarks.size(), 1u) << "the coarse grid is resampled";
  const auto densityAt = [&](glm::ivec3 v) { return volume.scalars.at(v - volume.indexOrigin); };
  EXPECT_NEAR(densityAt({2, 2, 2}), 1.0f + 0.25f, 1e-6);
  EXPECT_NEAR(densityAt({6, 6, 6}), 1.0f + 0.5f + 0.25f, 1e-6);
  EXPECT_NEAR(densityAt({18, 6, 6}), 0.5f + 0.25f, 1e-6);
  ReadRequest part = request;
  part.channels.resize(1);
  EXPECT_EQ(readVdb(file, part).dimensions, glm::ivec3(10)) << "channels that are not asked for take no place";
  part.channels = {channel("7")};
  expectRefusal([&] { readVdb(file, part); }, ErrorKind::Input, {"3", "7"});
}

}  // namespace
}  // namespace freevoxels
