// Baked volumes through the installed interface: the command line's images.

#include <fmt/format.h>
#include <freevoxels/freevoxels.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

/// The program, in a folder of its own.
class BakedTest : public ::testing::Test {
 protected:
  void run(const std::string& arguments) const {
    const std::string command = fmt::format("cd '{}' && '{}' {} --quiet", folder_.path().string(), FREEVOXELS_PROGRAM, arguments);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  }
  std::string commandsImage(const std::string& arguments) const {
    run("render " + arguments + " theirs.png");
    return test::readBytes(folder_ / "theirs.png");
  }
  std::string saved(const v1::Image& image) const {
    v1::save(folder_ / "ours.png", image);
    return test::readBytes(folder_ / "ours.png");
  }

  const test::TemporaryFolder folder_;
};

TEST_F(BakedTest, ImagesAreThoseOfTheCommandLine) {
  // Boxes that end with a group of 4 voxels, a brick, a chunk, and elsewhere.
  for (const char* bake : {"4x12x8", "16x8x24 --keep-scalars", "33x32x31 --density-scale 30 --compress", "64x72x40"}) {
    run(fmt::format("bake procedural:cloud a.fvx --resolution {}", bake));
    const v1::Volume volume = v1::Volume::open(folder_ / "a.fvx");
    for (const int size : {12, 96})
      EXPECT_TRUE(saved(v1::Renderer(volume, fmt::format(R"({{"size": {}}})", size)).render()) ==
                  commandsImage(fmt::format("a.fvx --size {}", size)))
          << bake << " " << size;
  }
}

TEST_F(BakedTest, ARendererReadsTheLevelOfDetailThatEachFrameNeeds) {
  run("bake procedural:cloud a.fvx --resolution 72x70x65");
  const v1::Volume volume = v1::Volume::open(folder_ / "a.fvx");
  EXPECT_EQ(volume.dimensions()[0] / 36, 1) << "of the finest level, whatever is drawn";
  v1::Renderer shared(volume);
  for (const int size : {200, 10, 40, 200}) {
    const std::string scene = fmt::format(R"({{"size": {}}})", size);
    EXPECT_TRUE(saved(shared.render(scene)) == commandsImage(fmt::format("a.fvx --size {}", size))) << size;
  }
}

TEST_F(BakedTest, WhatDoesNotFitIsTheCommandLinesImage) {
  run("bake procedural:cloud a.fvx --resolution 150x96x97");
  const v1::Volume baked = v1::Volume::open(folder_ / "a.fvx");
  v1::Renderer limited(baked, R"({"size": 60, "memory-limit": 30})");
  const std::string whole = saved(v1::Renderer(baked, R"({"size": 60})").render()), cubes = saved(limited.render());
  EXPECT_TRUE(cubes == commandsImage("a.fvx --size 60 --memory-limit 30"));
  EXPECT_TRUE(whole == commandsImage("a.fvx --size 60"));
  EXPECT_TRUE(saved(limited.submit().image()) == cubes);
  const v1::Volume dense = v1::Volume::open("procedural:cloud", R"({"resolution": [150, 96, 97]})");
  EXPECT_TRUE(saved(v1::Renderer(dense, R"({"size": 60, "memory-limit": 30})").render()) ==
              commandsImage("procedural:cloud --resolution 150x96x97 --size 60 --memory-limit 30"));
}

TEST_F(BakedTest, ADamagedChunkIsNamedWhenItIsDrawn) {
  run("bake procedural:cloud a.fvx --resolution 40");
  std::string bytes = test::readBytes(folder_ / "a.fvx");
  bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 0x55);
  test::writeBytes(folder_ / "b.fvx", bytes);
  try {
    v1::Renderer(v1::Volume::open(folder_ / "b.fvx"), R"({"size": 200})").render();
    ADD_FAILURE() << "was drawn";
  } catch (const v1::Error& error) {
    EXPECT_EQ(error.kind(), v1::ErrorKind::Input);
    EXPECT_NE(std::string(error.what()).find("b.fvx"), std::string::npos) << error.what();
  }
}

TEST_F(BakedTest, FilesAndFactsAreThoseOfTheCommandLine) {
  run("generate cloud a.vdb --resolution 12x20x9");
  const std::string path = folder_.path().string();
  run(fmt::format("bake '{}/a.vdb' theirs.fvx --density-scale 30 --compress", path));  // the file says which name it was given
  v1::bake(folder_ / "a.vdb", folder_ / "ours.fvx", R"({"density-scale": 30, "compress": true})");
  EXPECT_TRUE(test::readBytes(folder_ / "ours.fvx") == test::readBytes(folder_ / "theirs.fvx"));
  const std::string inFolder = fmt::format("cd '{}' && ", path);
  ASSERT_EQ(std::system((inFolder + "'" FREEVOXELS_PROGRAM "' info ours.fvx --json > info.txt").c_str()), 0);
  EXPECT_EQ(v1::info(folder_ / "ours.fvx", R"({"check": true})") + "\n", test::readBytes(folder_ / "info.txt"));
  for (const int share : {0, 1}) run(fmt::format("render a.vdb part_{}.exr --share {}/2 --sums --size 20", share, share));
  run("merge part_0.exr part_1.exr theirs.png");
  v1::merge({path + "/part_1.exr", path + "/part_0.exr"}, {path + "/ours.png"});
  EXPECT_TRUE(test::readBytes(folder_ / "ours.png") == test::readBytes(folder_ / "theirs.png"));
  EXPECT_NE(v1::devices().find(v1::Context().device()), std::string::npos);
  ASSERT_EQ(std::system((inFolder + "'" FREEVOXELS_PROGRAM "' presets --json > presets.txt").c_str()), 0);
  EXPECT_EQ(v1::presets() + "\n", test::readBytes(folder_ / "presets.txt"));

  const std::vector<float> values(20 * 13 * 9, 1.0f);
  const v1::Volume volume = v1::Volume::copy(values, {20, 13, 9});
  v1::bake(volume, folder_ / "copy.fvx", R"({"keep-scalars": true})");
  EXPECT_EQ(v1::Renderer(v1::Volume::open(folder_ / "copy.fvx"), R"({"size": 20})").render().pixels,
            v1::Renderer(volume, R"({"size": 20})").render().pixels);
  struct Abandoned {};
  EXPECT_THROW(v1::bake(volume, folder_ / "none.fvx", "{}", [](std::string_view, double) { throw Abandoned(); }), Abandoned);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.fvx"));
  EXPECT_THROW(v1::bake(volume, folder_ / "none.vdb"), v1::Error);
}

}  // namespace
}  // namespace freevoxels
