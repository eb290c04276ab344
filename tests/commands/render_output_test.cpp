// What freevoxels render writes and prints: images, their headers, messages.

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>

#include "engine/image/image.h"
#include "tests/commands/render_fixture.h"

namespace freevoxels::test {

using RenderOutput = RenderCommand;

/// A variable of the environment that programs are started with, for as long as this object exists.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const char* value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    setenv(name, value, 1);
  }
  ~EnvironmentVariable() {
    if (before_)
      setenv(name_, before_->c_str(), 1);
    else
      unsetenv(name_);
  }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* const name_;
  std::optional<std::string> before_;
};

TEST_F(RenderOutput, TheRecordedCommandGivesTheSameBytes) {
  const std::string first = render("--float --paper --orbit 10,-20");
  expectSuccess(runFreevoxels(recordedCommand(first, folder / "again.exr")));
  EXPECT_EQ(first, readBytes(folder / "again.exr"));
}

TEST_F(RenderOutput, StandardOutputIsAPngAndNothingElse) {
  for (const std::string options : {"", "--png-bits 16", "--background transparent", "--crop 3,5,20,11 --exposure 1", "--verbose", "--quiet"}) {
    const std::string more = " --resolution 16 --size 40x30 " + options;
    const ProgramResult file = run("render procedural:cloud @a.png" + more);
    ASSERT_EQ(file.exitCode, 0) << file.err;
    const ProgramResult piped = run("render procedural:cloud -" + more);
    ASSERT_EQ(piped.exitCode, 0) << piped.err;
    EXPECT_TRUE(piped.out == readBytes(folder / "a.png")) << options;
  }
  const ProgramResult both = run("render procedural:cloud - @b.exr --resolution 16 --size 40x30 --aov depth --save-scene @s.json --timings @t.json");
  ASSERT_EQ(both.exitCode, 0) << both.err;
  EXPECT_TRUE(both.out.starts_with("\x89PNG"));
  EXPECT_TRUE(both.out.ends_with(std::string("IEND\xae\x42\x60\x82")));
  for (const char* name : {"b.exr", "s.json", "t.json"}) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  expectCleanRefusal("render procedural:cloud - -", ExitCode::Usage, "named twice");
  expectCleanRefusal("render procedural:cloud - --float", ExitCode::Usage, "--float");
  const ProgramResult oracle = run("oracle procedural:cube - --resolution 4 --size 6");
  ASSERT_EQ(oracle.exitCode, 0) << oracle.err;
  EXPECT_TRUE(oracle.out.starts_with("\x89PNG"));
}

TEST_F(RenderOutput, EndsByTheSignalThatInterruptsIt) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const ProgramResult result = runAndInterrupt(words("render procedural:cloud @i.png --resolution 512"), signal, 800);
    EXPECT_EQ(result.exitCode, -signal) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "i.png"));
  }
}

TEST_F(RenderOutput, RecordsOptionsVersionsAndCamera) {
  const std::string bytes = render("--orthographic 1.5 --density-scale 12.5");
  EXPECT_EQ(exrAttribute(bytes, "freevoxels:density-scale"), "12.5");
  EXPECT_EQ(exrAttribute(bytes, "freevoxels:orthographic"), "1.5");
  EXPECT_EQ(exrAttribute(bytes, "freevoxels:draw"), "gather");
  EXPECT_EQ(exrAttribute(bytes, "freevoxels:size"), "64x48");
  for (const char* name :
       {"freevoxels:version", "freevoxels:device", "freevoxels:driver", "freevoxels:look-at"})
    EXPECT_NE(exrAttribute(bytes, name), "") << name;
  for (const char* name : {"worldToCamera", "worldToNDC"})
    EXPECT_NE(bytes.find(std::string(name) + '\0' + "m44f"), std::string::npos) << name;
}

TEST_F(RenderOutput, DepthIsTheDistanceOfWhatIsSeen) {
  const std::string camera = "--camera-position 0,0,4 --look-at 0,0,0 --aov depth ";
  render(camera);
  const Image image = readExr(folder / "a.exr");
  ASSERT_EQ(image.depth.size(), image.pixels.size());
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.pixels[i].a < 0.01f) continue;
    ASSERT_GT(image.depth[i], 3.4f) << "pixel " << i;  // the unit cube around 0, seen from 4 away
    ASSERT_LT(image.depth[i], 4.6f) << "pixel " << i;
  }
  EXPECT_EQ(image.depth[0], std::numeric_limits<float>::infinity());
}

TEST_F(RenderOutput, BackgroundIsOfPngAlone) {
  const std::string exr = render("", "a.exr");
  const std::string dark = render("", "a.png");
  expectSuccess(run(std::string("render procedural:cloud @b.exr @b.png --background 0.2,0.1,0") + kSmall));
  const Image plain = readExr(folder / "a.exr"), withBackground = readExr(folder / "b.exr");
  EXPECT_EQ(plain.pixels, withBackground.pixels);
  EXPECT_NE(dark, readBytes(folder / "b.png"));
}

TEST_F(RenderOutput, PngIsOverADarkGradientUnlessItIsToBeTransparent) {
  render("", "a.png");
  const Image dark = readPng(folder / "a.png");
  for (const glm::vec4& pixel : dark.pixels) ASSERT_EQ(pixel.a, 1.0f);
  EXPECT_GT(dark.pixels.front().b, dark.pixels.back().b);
  EXPECT_GT(dark.pixels.back().b, 0.0f);
  render("--background transparent", "a.png");
  EXPECT_EQ(readPng(folder / "a.png").pixels.front().a, 0.0f);
}

TEST_F(RenderOutput, ExposureAndToneMapChangeThePngAlone) {
  render("", "a.png");
  expectSuccess(run(std::string("render procedural:cloud @b.exr @b.png --exposure 1.5 --tone-map filmic") + kSmall));
  expectSuccess(run(std::string("render procedural:cloud @c.exr") + kSmall));
  EXPECT_EQ(readExr(folder / "b.exr").pixels, readExr(folder / "c.exr").pixels);
  EXPECT_NE(readBytes(folder / "a.png"), readBytes(folder / "b.png"));
}

TEST_F(RenderOutput, QuietPrintsNothing) {
  const ProgramResult result = run(std::string("render procedural:cloud @a.png --quiet") + kSmall);
  expectSuccess(result);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
}

TEST_F(RenderOutput, VerboseShowsOptionsAndStages) {
  const ProgramResult result = run(std::string("render procedural:cloud @a.png --verbose") + kSmall);
  expectSuccess(result);
  for (const char* word : {"--density-scale", "--camera-position", "--size", "64x48", "read volume",
                           "write images", "device ms", "total"})
    EXPECT_NE(result.err.find(word), std::string::npos) << word << " should be in\n" << result.err;
}

TEST_F(RenderOutput, TimingsAreJson) {
  expectSuccess(run(std::string("render procedural:cloud @a.png --timings @t.json") + kSmall));
  const auto json = nlohmann::json::parse(readBytes(folder / "t.json"));
  EXPECT_EQ(json.at("options").at("size"), "64x48");
  EXPECT_FALSE(json.at("device").at("name").get<std::string>().empty());
  EXPECT_GT(json.at("visible_voxels"), 0);
  EXPECT_GT(json.at("total_milliseconds"), 0.0);
  int onDevice = 0;
  for (const auto& stage : json.at("stages")) {
    EXPECT_GE(stage.at("milliseconds"), 0.0);
    onDevice += stage.at("on_device").get<bool>() ? 1 : 0;
  }
  EXPECT_GT(onDevice, 0);
}

TEST_F(RenderOutput, ProgressIsForTerminalsAndErased) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  const EnvironmentVariable terminal("TERM", "xterm");
  const Arguments arguments = words(std::string("render procedural:cloud @a.png") + kSmall);
  const ProgramResult shown = runFreevoxelsOnTerminal(arguments);
  expectSuccess(shown);
  EXPECT_NE(shown.err.find("reading procedural:cloud"), std::string::npos) << shown.err;
  EXPECT_TRUE(shown.err.ends_with("\r\033[K"));
  EXPECT_EQ(runFreevoxels(arguments).err.find("\033"), std::string::npos);
  EXPECT_EQ(
      runFreevoxelsOnTerminal(words(std::string("render procedural:cloud @a.png --quiet") + kSmall)).err, "");
}

TEST_F(RenderOutput, ProgressNeverGoesBackwards) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  const EnvironmentVariable terminal("TERM", "xterm");
  for (const std::string method : {"--draw splats", "--draw gather"}) {
    const ProgramResult shown = runFreevoxelsOnTerminal(words("render procedural:cloud @a.png --resolution 64 --size 700 " + method));
    expectSuccess(shown);
    int last = 0;
    const std::regex percent(" ([0-9]+) %");
    for (auto one = std::sregex_iterator(shown.err.begin(), shown.err.end(), percent); one != std::sregex_iterator(); ++one) {
      const int now = std::stoi((*one)[1]);
      EXPECT_GE(now, last) << shown.err;
      last = now;
    }
    EXPECT_GT(last, 0) << shown.err;
  }
}

TEST_F(RenderOutput, TerminalsWithoutEscapeCodesAreGivenNone) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  const EnvironmentVariable terminal("TERM", "dumb");
  const ProgramResult shown = runFreevoxelsOnTerminal(words(std::string("render procedural:cloud @a.png") + kSmall));
  expectSuccess(shown);
  EXPECT_EQ(shown.err.find("\033"), std::string::npos) << shown.err;
}

TEST_F(RenderOutput, ACropIsThePartOfTheWholeToTheByte) {
  const std::string view = std::string("render procedural:cloud --float --aov depth,position,normal,transmittance") + kSmall;
  expectSuccess(run(view + "@whole.exr @whole.png"));
  expectSuccess(run(view + "@part.exr @part.png --crop 20,11,30,25"));
  const PixelRectangle part{{20, 11}, {30, 25}};
  const Image whole = cropped(readExr(folder / "whole.exr"), part), cut = readExr(folder / "part.exr");
  EXPECT_EQ(cut.pixels, whole.pixels);
  EXPECT_EQ(cut.depth, whole.depth);
  EXPECT_EQ(readPng(folder / "part.png").pixels, cropped(readPng(folder / "whole.png"), part).pixels);
  EXPECT_NE(readBytes(folder / "part.exr").find("transmittance.Y"), std::string::npos);
  for (const char* crop : {"0,0,65,48", "60,0,5,5", "0,0,0,5", "-1,0,5,5", "1,2,3"})
    expectCleanRefusal(view + "@none.exr --crop " + crop, ExitCode::Usage, "--crop");
}

TEST_F(RenderOutput, ImagesMayBeJpegAndPngOf16Bits) {
  expectSuccess(run(std::string("render procedural:cloud @a.jpg @b.JPEG @c.png --png-bits 16") + kSmall));
  EXPECT_TRUE(readBytes(folder / "a.jpg").starts_with("\xff\xd8\xff"));
  EXPECT_EQ(readBytes(folder / "a.jpg"), readBytes(folder / "b.JPEG"));
  EXPECT_EQ(readBytes(folder / "c.png")[24], 16);
  expectCleanRefusal("render procedural:cube @d.jpg --background transparent", ExitCode::Usage, "no alpha");
  expectCleanRefusal("render procedural:cube @d.jpg --png-bits 16", ExitCode::Usage, "--png-bits");
}

}  // namespace freevoxels::test
