// freevoxels turntable: the options of render, an image a frame.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"
#include "tests/image_measures.h"

namespace freevoxels::test {

namespace {

constexpr const char* kSmallTurn = " --resolution 24 --size 48x36 ";
constexpr const char* kFlight = R"({"keys": [
    {"time": 0, "camera-position": [1.5, 0.5, 2], "look-at": [0, 0, 0], "light": [{"direction": [1, 1, 1], "intensity": 8}]},
    {"time": 1, "camera-position": [0, 0.4, 1.6], "look-at": [0, 0.1, 0], "up": [0.2, 1, 0], "fov": 50},
    {"time": 3, "camera-position": [-2, 0.3, 0.2], "look-at": [0, 0, 0], "light": [{"direction": [-1, 1, 0.5], "intensity": 8}]}]})";

class TurntableCommand : public CommandTest {
 protected:
  ProgramResult turn(const std::string& text) const {
    const ProgramResult result = run("turntable procedural:cloud " + text + kSmallTurn);
    expectSuccess(result);
    return result;
  }
  glm::dvec3 vectorOf(const std::string& file, const std::string& option) const {
    glm::dvec3 value(0.0);
    char comma = 0;
    std::istringstream text(exrAttribute(readBytes(folder / file), "freevoxels:" + option));
    text >> value.x >> comma >> value.y >> comma >> value.z;
    EXPECT_TRUE(text) << file << " " << option;
    return value;
  }
  double distanceOf(const std::string& file) const {
    return glm::length(vectorOf(file, "camera-position") - vectorOf(file, "look-at"));
  }
};

}  // namespace

TEST_F(TurntableCommand, WritesEveryFrameOfEveryOutputAndPrintsThem) {
  const ProgramResult result = turn("@a_##.exr @b#.png --frames 3");
  std::string expected;
  for (const char* name : {"a_00.exr", "b0.png", "a_01.exr", "b1.png", "a_02.exr", "b2.png"})
    expected += (folder / name).string() + "\n";
  EXPECT_EQ(result.out, expected);
  EXPECT_EQ(folder.fileCount(), 6u);
  EXPECT_NE(readExr(folder / "a_00.exr").pixels, readExr(folder / "a_01.exr").pixels);
  EXPECT_NE(readExr(folder / "a_01.exr").pixels, readExr(folder / "a_02.exr").pixels);
}

TEST_F(TurntableCommand, EachFrameHasItsOwnHoldout) {
  turn("@whole_#.exr --frames 2 --aov depth");
  turn("@front_#.exr --frames 2 --holdout @whole_#.exr");
  for (const char* frame : {"0", "1"}) {
    const float whole = readExr(folder / fmt::format("whole_{}.exr", frame)).pixels[18 * 48 + 24].a;
    const float front = readExr(folder / fmt::format("front_{}.exr", frame)).pixels[18 * 48 + 24].a;
    EXPECT_GT(front, 0.1f * whole) << frame;
    EXPECT_LT(front, 0.9f * whole) << frame;
  }
  expectCleanRefusal("turntable procedural:cloud @none_#.png --frames 2 --size 48x36 --holdout @whole_0.exr", ExitCode::Usage, "--holdout");
}

TEST_F(TurntableCommand, NumbersGrowBeyondTheirPlace) {
  turn("@#.png --frames 11 --quiet");
  EXPECT_TRUE(std::filesystem::exists(folder / "0.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "10.png"));
  EXPECT_EQ(folder.fileCount(), 11u);
}

TEST_F(TurntableCommand, ARangeHasTheFramesOfTheWholeTurn) {
  turn("@all_#.exr @all_#.png --frames 7");
  const std::map<std::string, std::vector<int>> ranges{
      {"2-4", {2, 3, 4}}, {"1-5:2", {1, 3, 5}}, {"5-", {5, 6}}, {"0", {0}}, {"4-90:2", {4, 6}}};
  for (const auto& [range, numbers] : ranges) {
    const ProgramResult result = turn("@part_#.exr @part_#.png --frames 7 --range " + range);
    std::string printed;
    for (const int number : numbers)
      for (const char* kind : {"exr", "png"}) {
        const std::string name = fmt::format("part_{}.{}", number, kind);
        printed += (folder / name).string() + "\n";
        EXPECT_TRUE(readBytes(folder / name) == readBytes(folder / fmt::format("all_{}.{}", number, kind))) << name << " of " << range;
      }
    EXPECT_EQ(result.out, printed) << range;
    EXPECT_EQ(folder.fileCount(), 14 + 2 * numbers.size()) << range;
    for (const int number : numbers)
      for (const char* kind : {"exr", "png"}) std::filesystem::remove(folder / fmt::format("part_{}.{}", number, kind));
  }
  for (const char* wrong : {"7-", "x", "3-2", "1-2:0", ""})
    expectCleanRefusal(fmt::format("turntable procedural:cloud @n#.png --frames 7 --range={}", wrong), ExitCode::Usage, "--range");
}

TEST_F(TurntableCommand, FramesThatExistAreSkipped) {
  turn("@a#.png @a#.exr --frames 5");
  std::map<std::string, std::string> before;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) before[entry.path().string()] = readBytes(entry.path());
  for (const char* name : {"a1.png", "a3.exr", "a4.png", "a4.exr"}) std::filesystem::remove(folder / name);
  writeBytes(folder / "a2.png", "kept, whatever it is");
  const ProgramResult rest = turn("@a#.png @a#.exr --frames 5 --skip-existing");
  std::string printed;
  for (const char* name : {"a1.png", "a1.exr", "a3.png", "a3.exr", "a4.png", "a4.exr"}) printed += (folder / name).string() + "\n";
  EXPECT_EQ(rest.out, printed);
  EXPECT_NE(rest.err.find("2 of 5 frames exist"), std::string::npos) << rest.err;
  EXPECT_EQ(readBytes(folder / "a2.png"), "kept, whatever it is");
  before[(folder / "a2.png").string()] = "kept, whatever it is";
  for (const auto& [file, bytes] : before) EXPECT_TRUE(readBytes(file) == bytes) << file;
  const ProgramResult nothing = turn("@a#.png @a#.exr --frames 5 --skip-existing --range 1-3");
  EXPECT_EQ(nothing.out, "");
  EXPECT_EQ(turn("@a#.png @a#.exr --frames 5 --skip-existing --save-scene @s.json").out, (folder / "s.json").string() + "\n");
  expectCleanRefusal("turntable procedural:cloud - --skip-existing", ExitCode::Usage, "--skip-existing");
}

TEST_F(TurntableCommand, StandardOutputHasTheImagesOneAfterAnother) {
  turn("@#.png --frames 3");
  const std::string whole = readBytes(folder / "0.png") + readBytes(folder / "1.png") + readBytes(folder / "2.png");
  EXPECT_TRUE(turn("- --frames 3").out == whole);
  EXPECT_TRUE(turn("- @b#.exr --frames 3 --range 1-").out == readBytes(folder / "1.png") + readBytes(folder / "2.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "b2.exr"));
}

TEST_F(TurntableCommand, TheRecordedCommandRepeatsOneFrame) {
  turn("@####.exr --frames 5 --float --aov depth --paper --orbit 10,-20 --up 0.1,1,0");
  for (const char* name : {"0000.exr", "0003.exr"}) {
    const std::string frame = readBytes(folder / name);
    expectSuccess(runFreevoxels(recordedCommand(frame, folder / "again.exr")));
    EXPECT_TRUE(frame == readBytes(folder / "again.exr")) << name;
  }
}

TEST_F(TurntableCommand, TurnsAtOneDistance) {
  turn("@#.exr --frames 4 --orbit 20,30");
  const double distance = distanceOf("0.exr");
  for (const char* name : {"1.exr", "2.exr", "3.exr"}) EXPECT_NEAR(distanceOf(name), distance, 1e-9) << name;
  const glm::dvec3 centre = vectorOf("0.exr", "look-at");
  const glm::dvec3 first = vectorOf("0.exr", "camera-position") - centre;
  const glm::dvec3 opposite = vectorOf("2.exr", "camera-position") - centre;
  EXPECT_LT(glm::length(first * glm::dvec3(-1, 1, -1) - opposite), 1e-9);
  EXPECT_NEAR(first.y / distance, 0.5, 1e-9);
}

TEST_F(TurntableCommand, AFullTurnComesBackToTheFirstFrame) {
  turn("@a#.exr --frames 4 --orbit 20,10 --float");
  turn("@b#.exr --frames 4 --orbit 380,10 --float");
  EXPECT_LT(largestPixelDifference(readExr(folder / "a0.exr"), readExr(folder / "b0.exr")), 1e-3);
  EXPECT_GT(largestPixelDifference(readExr(folder / "a0.exr"), readExr(folder / "a1.exr")), 1e-2);
}

TEST_F(TurntableCommand, OneFrameIsTheImageOfRender) {
  turn("@#.exr --frames 1 --float");
  expectSuccess(run(std::string("render procedural:cloud @r.exr --float") + kSmallTurn));
  EXPECT_TRUE(readBytes(folder / "0.exr") == readBytes(folder / "r.exr"));
}

TEST_F(TurntableCommand, APositionTurnsAboutUp) {
  turn("@#.exr --frames 4 --camera-position 2,3,1 --look-at 0.5,0,0 --up 0,0,1");
  const glm::dvec3 expected[] = {{2, 3, 1}, {-2.5, 1.5, 1}, {-1, -3, 1}, {3.5, -1.5, 1}};
  for (int i = 0; i < 4; ++i)
    EXPECT_LT(glm::length(vectorOf(std::to_string(i) + ".exr", "camera-position") - expected[i]), 1e-9) << i;
}

TEST_F(TurntableCommand, AFlightPassesThroughItsKeysWithItsLights) {
  writeBytes(folder / "flight.json", kFlight);
  turn("@#.exr --frames 4 --float --flight @flight.json");
  const glm::dvec3 places[] = {{1.5, 0.5, 2.0}, {0.0, 0.4, 1.6}, {}, {-2.0, 0.3, 0.2}};
  for (const int key : {0, 1, 3})
    EXPECT_LT(glm::length(vectorOf(fmt::format("{}.exr", key), "camera-position") - places[key]), 1e-12) << key;
  const std::string lights[] = {exrAttribute(readBytes(folder / "0.exr"), "freevoxels:light"),
                                exrAttribute(readBytes(folder / "2.exr"), "freevoxels:light")};
  EXPECT_NE(lights[0], lights[1]);
  for (const char* name : {"0.exr", "1.exr", "2.exr", "3.exr"}) {
    const std::string frame = readBytes(folder / name);
    expectSuccess(runFreevoxels(recordedCommand(frame, folder / "again.exr")));
    EXPECT_TRUE(frame == readBytes(folder / "again.exr")) << name;
  }
  turn("@part#.exr --frames 4 --float --range 2 --flight @flight.json");
  EXPECT_TRUE(readBytes(folder / "part2.exr") == readBytes(folder / "2.exr"));
}

TEST_F(TurntableCommand, OneFrameOfAFlightIsItsFirstKey) {
  writeBytes(folder / "flight.json", kFlight);
  turn("@#.exr --frames 1 --float --flight @flight.json");
  expectSuccess(run(std::string("render procedural:cloud @r.exr --float --flight @flight.json") + kSmallTurn));
  expectSuccess(run(std::string("render procedural:cloud @same.exr --float --camera-position 1.5,0.5,2 --look-at 0,0,0 --light "
                                "direction=1,1,1,intensity=8") +
                    kSmallTurn));
  EXPECT_TRUE(readBytes(folder / "0.exr") == readBytes(folder / "r.exr"));
  EXPECT_TRUE(readBytes(folder / "same.exr") == readBytes(folder / "r.exr"));
}

TEST_F(TurntableCommand, ASavedFlightIsDrawnAgain) {
  std::filesystem::create_directories(folder / "flights");
  writeBytes(folder / "flights/flight.json", kFlight);
  turn("@a#.exr --frames 3 --float --flight @flights/flight.json --save-scene @flights/s.json");
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "flights/s.json")).at("camera").at("flight"), "flight.json");
  expectSuccess(run("turntable --scene @flights/s.json @b#.exr --quiet --float"));
  for (const char* frame : {"0", "1", "2"})
    EXPECT_EQ(readExr(folder / fmt::format("a{}.exr", frame)).pixels, readExr(folder / fmt::format("b{}.exr", frame)).pixels) << frame;
}

TEST_F(TurntableCommand, WrongFlightsAreRefused) {
  writeBytes(folder / "flight.json", kFlight);
  writeBytes(folder / "short.json", R"({"keys": []})");
  const auto refuses = [&](const std::string& options, ExitCode code, const std::string& mention) {
    expectCleanRefusal("turntable procedural:cloud @n#.png --frames 2 " + options, code, mention);
  };
  refuses("--flight @none.json", ExitCode::Input, "none.json");
  refuses("--flight @short.json", ExitCode::Input, "has 0 keys, and a flight takes 2 to 10000");
  for (const char* other : {"--orbit 1,2", "--camera-position 1,2,3", "--look-at 1,2,3", "--up 0,1,0", "--fov 30", "--orthographic 2"})
    refuses(std::string("--flight @flight.json ") + other, ExitCode::Usage, "--flight");
  refuses("--flight @flight.json --save-scene @flight.json", ExitCode::Usage, "same file");
}

TEST_F(TurntableCommand, TimingsSumTheFrames) {
  turn("@#.png --frames 3 --timings @t.json");
  const auto json = nlohmann::json::parse(readBytes(folder / "t.json"));
  EXPECT_EQ(json.at("options").at("frames"), "3");
  std::vector<std::string> names;
  for (const auto& stage : json.at("stages")) names.push_back(stage.at("name"));
  for (const char* once : {"bricks", "gather", "write images"})
    EXPECT_EQ(std::ranges::count(names, once), 1) << once;
}

TEST_F(TurntableCommand, ProgressCountsTheFrames) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  const ProgramResult shown = runFreevoxelsOnTerminal(words(std::string("turntable procedural:cloud @#.png --frames 3") + kSmallTurn));
  expectSuccess(shown);
  for (const char* text : {"frame 1 of 3", "frame 3 of 3"})
    EXPECT_NE(shown.err.find(text), std::string::npos) << shown.err;
  EXPECT_TRUE(shown.err.ends_with("\r\033[K"));
}

TEST_F(TurntableCommand, OutputsAreCheckedBeforeAnyWork) {
  expectCleanRefusal("turntable procedural:cloud @none/#.png", ExitCode::Output, "none");
  std::filesystem::create_directory(folder / "07.png");
  expectCleanRefusal("turntable procedural:cloud @##.png --frames 9", ExitCode::Output, "07.png");
  expectSuccess(run("generate cube @3.png.vdb --resolution 8 --quiet"));
  std::filesystem::create_symlink(folder / "3.png.vdb", folder / "3.png");
  expectCleanRefusal("turntable @3.png.vdb @#.png --frames 4", ExitCode::Usage, "same file");
}

}  // namespace freevoxels::test
