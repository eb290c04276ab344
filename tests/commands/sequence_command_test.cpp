// freevoxels render of several volumes: the files of a pattern, or named one by one.

#include <map>
#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "engine/volume/openvdb_trees.h"
#include "engine/volume/procedural.h"
#include "engine/volume/vdb.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

constexpr const char* kSmallUnlit = " --size 32x24 --unlit ";

class SequenceCommand : public CommandTest {
 protected:
  /// A cloud whose densities are multiplied by `factor`.
  void write(const std::string& name, float factor) const {
    Volume cloud = makeProcedural("cloud", 12);
    Volume volume = makeVolume(cloud.dimensions, cloud.indexToWorld, [&](int x, int y, int z) {
      const float value = cloud.scalars.at({x, y, z});
      return value == kInactiveVoxel ? value : factor * value;
    });
    writeVdb(folder / name, volume, "density");
  }
  void writeEmpty(const std::string& name) const {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create();
    grid->setName("density");
    openvdb::io::File((folder / name).string()).write(openvdb::GridCPtrVec{grid});
  }
  std::string lines(std::initializer_list<const char*> names) const {
    std::string text;
    for (const char* name : names) text += (folder / name).string() + "\n";
    return text;
  }
  std::string attribute(const std::string& file, const std::string& name) const {
    return exrAttribute(readBytes(folder / file), "freevoxels:" + name);
  }
};

}  // namespace

TEST_F(SequenceCommand, APatternIsDrawnFrameByFrameAsTheFirstFrameIsSeen) {
  write("s_0007.vdb", 1.0f);
  write("s_0008.vdb", 3.0f);
  write("s_0010.vdb", 5.0f);
  const ProgramResult result = run(std::string("render @s_####.vdb @i_####.exr @i_%02d.png") + kSmallUnlit);
  expectSuccess(result);
  EXPECT_EQ(result.out, lines({"i_0007.exr", "i_07.png", "i_0008.exr", "i_08.png", "i_0010.exr", "i_10.png"}));
  EXPECT_NE(result.err.find("no file of frame 9\n"), std::string::npos) << result.err;
  for (const char* name : {"camera-position", "density-scale"}) {
    EXPECT_EQ(attribute("i_0007.exr", name), attribute("i_0010.exr", name)) << name;
    EXPECT_NE(attribute("i_0010.exr", name), "") << name;
  }
  // Each frame is what its own recorded command draws.
  const std::string last = readBytes(folder / "i_0010.exr");
  expectSuccess(runFreevoxels(recordedCommand(last, folder / "again.exr")));
  EXPECT_TRUE(last == readBytes(folder / "again.exr"));
  EXPECT_NE(readExr(folder / "i_0007.exr").pixels, readExr(folder / "i_0010.exr").pixels);
}

TEST_F(SequenceCommand, FramesAndTheirViewAreChosen) {
  for (const int number : {1, 2, 3, 4}) write(fmt::format("s{}.vdb", number), float(number));
  const ProgramResult result = run(std::string("render @s%d.vdb @i_#.exr --frames 2-6:2 --no-fixed-view --timings @t.json") + kSmallUnlit);
  expectSuccess(result);
  EXPECT_EQ(result.out, lines({"i_2.exr", "i_4.exr", "t.json"}));
  EXPECT_NE(result.err.find("no file of frame 6\n"), std::string::npos) << result.err;
  const double twice = std::stod(attribute("i_2.exr", "density-scale")) / std::stod(attribute("i_4.exr", "density-scale"));
  EXPECT_NEAR(twice, 2.0, 0.01);
  const auto json = nlohmann::json::parse(readBytes(folder / "t.json"));
  EXPECT_EQ(json.at("options").at("input"), (folder / "s%d.vdb").string());
}

TEST_F(SequenceCommand, FramesThatExistAreSkippedAndTheOthersSeenAsBefore) {
  for (const int number : {1, 2, 3, 4}) write(fmt::format("s{}.vdb", number), float(number));
  for (const std::string view : {" --fixed-view", " --no-fixed-view"}) {
    const std::string command = "render @s#.vdb @i#.exr --skip-existing" + view + kSmallUnlit;
    expectSuccess(run(command));
    std::map<int, std::string> before;
    for (const int number : {1, 2, 3, 4}) before[number] = readBytes(folder / fmt::format("i{}.exr", number));
    EXPECT_EQ(run(command).out, "");
    for (const std::vector<int>& missing : std::vector<std::vector<int>>{{4}, {1}, {2, 3}, {1, 2, 3, 4}}) {
      std::vector<std::string> names;
      for (const int number : missing) {
        names.push_back(fmt::format("i{}.exr", number));
        std::filesystem::remove(folder / names.back());
      }
      const ProgramResult again = run(command);
      expectSuccess(again);
      std::string printed;
      for (const std::string& name : names) printed += (folder / name).string() + "\n";
      EXPECT_EQ(again.out, printed);
      for (const int number : {1, 2, 3, 4}) EXPECT_TRUE(readBytes(folder / fmt::format("i{}.exr", number)) == before[number]) << number << view;
    }
    for (const int number : {1, 2, 3, 4}) std::filesystem::remove(folder / fmt::format("i{}.exr", number));
  }
}

TEST_F(SequenceCommand, SeveralVolumesBecomeImagesOfTheirNamesInAFolder) {
  write("a.vdb", 1.0f);
  write("b.vdb", 2.0f);
  const ProgramResult result = run(std::string("render @a.vdb @b.vdb procedural:cube --out-dir @images/of --format exr,jpg") + kSmallUnlit);
  expectSuccess(result);
  EXPECT_EQ(result.out, lines({"images/of/a.exr", "images/of/a.jpg", "images/of/b.exr", "images/of/b.jpg", "images/of/cube.exr",
                               "images/of/cube.jpg"}));
  EXPECT_EQ(readExr(folder / "images/of/b.exr").size, glm::ivec2(32, 24));
}

TEST_F(SequenceCommand, AnEmptyFrameIsBackgroundAndADamagedOneIsLeftOut) {
  writeEmpty("s1.vdb");
  write("s2.vdb", 1.0f);
  writeBytes(folder / "s3.vdb", "no volume");
  writeEmpty("s4.vdb");
  const ProgramResult result = run(std::string("render @s#.vdb @i#.exr --aov depth") + kSmallUnlit);
  EXPECT_EQ(result.exitCode, int(ExitCode::Input));
  EXPECT_EQ(result.out, lines({"i1.exr", "i2.exr", "i4.exr"}));
  EXPECT_NE(result.err.find("s3.vdb"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("1 of 4 volumes could not be drawn"), std::string::npos) << result.err;
  const Image empty = readExr(folder / "i1.exr");
  EXPECT_EQ(empty.pixels, std::vector<glm::vec4>(32 * 24, glm::vec4(0.0f)));
  EXPECT_EQ(empty.depth.front(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(attribute("i1.exr", "camera-position"), attribute("i2.exr", "camera-position"));
  EXPECT_FALSE(std::filesystem::exists(folder / "i3.exr"));
}

TEST_F(SequenceCommand, WhatMakesNoSenseIsRefusedBeforeAnyWork) {
  write("s1.vdb", 1.0f);
  write("s2.vdb", 1.0f);
  expectCleanRefusal("render @s#.vdb @i.png", ExitCode::Usage, "run of #");
  expectCleanRefusal("render @s#.vdb @i#.png --frames 3-", ExitCode::Input, "from 1 to 2");
  expectCleanRefusal("render @s#.vdb @i#.png --frames 2-1", ExitCode::Usage, "--frames");
  expectCleanRefusal("render @s1.vdb @i.png --frames 1", ExitCode::Usage, "--frames");
  expectCleanRefusal("render @s1.vdb @i.png --format exr", ExitCode::Usage, "--format");
  expectCleanRefusal("render @s1.vdb --format gif", ExitCode::Usage, "gif");
  expectCleanRefusal("render @none_#.vdb @i#.png", ExitCode::Input, "none_#.vdb");
  expectCleanRefusal("render @s1.vdb @s2.vdb @i#.png @s2.vdb", ExitCode::Usage, "named twice");
  expectCleanRefusal("render @s1.vdb @s2.vdb @i#.png @s1.vdb", ExitCode::Usage, "same file");
}

TEST_F(SequenceCommand, ProgressSaysHowMuchTimeIsLeft) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  write("s1.vdb", 1.0f);
  write("s2.vdb", 1.0f);
  const ProgramResult shown = runFreevoxelsOnTerminal(words(std::string("render @s#.vdb @i#.png") + kSmallUnlit));
  expectSuccess(shown);
  EXPECT_NE(shown.err.find("frame 1 of 2: "), std::string::npos) << shown.err;
  EXPECT_NE(shown.err.find("frame 2 of 2, "), std::string::npos) << shown.err;
  EXPECT_NE(shown.err.find(" s left: "), std::string::npos) << shown.err;
}

}  // namespace freevoxels::test
