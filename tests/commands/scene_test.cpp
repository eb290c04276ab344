// Scenes: the same images as the options make, from a file; what is wrong with one is said.

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "engine/image/image.h"
#include "engine/validation/sky_environment.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

const std::string kScenes = FREEVOXELS_SCENES;

class SceneCommand : public CommandTest {
 protected:
  void scene(const std::string& json, const std::string& file = "s.json") const {
    writeBytes(folder / file, json);
  }
  /// The file that `arguments` write to @a.exr.
  std::string bytes(const std::string& arguments) const {
    SCOPED_TRACE(arguments);
    expectSuccess(run(arguments + " --quiet"));
    return readBytes(folder / "a.exr");
  }
  void writeSky(const std::string& file) const {
    const Environment sky = makeSky(16);
    Image image{.size = sky.size, .pixels = {}, .depth = {}};
    for (const glm::vec3 radiance : sky.radiance) image.pixels.emplace_back(radiance, 1.0f);
    writeExr(folder / file, image, {});
  }
  void expectBadScene(const std::string& json, const std::string& mention) const {
    SCOPED_TRACE(json);
    scene(json);
    for (const char* command : {"render", "oracle"})
      expectCleanRefusal(fmt::format("{} --scene @s.json procedural:cube @a.png --resolution 8", command),
                         ExitCode::Input, mention);
  }
};

constexpr const char* kEverything = R"({
  "input": {"volume": "procedural:cloud", "resolution": 20},
  "camera": {"orbit": [200, 6], "fov": 26, "size": [40, 30], "up": [0, 1, 0.1]},
  "classification": {"density-scale": 30, "albedo": [0.8, 0.9, 0.7]},
  "light": {"lights": [{"direction": [-1, 0.5, 0.25], "color": [1, 0.8, 0.55], "intensity": 26},
                       {"position": [1, 2, 1]}],
            "ambient": 0.25, "environment": "sky.exr", "environment-rotation": 30,
            "extinction-tint": [0.5, 1, 2], "phase-g": 0.3, "light-attenuation": "exact"},
  "method": {"directions": 98, "gradient": false, "lod": 1.5, "composite": "additive"},
  "output": {"background": [0.1, 0.2, 0.3], "exposure": 1, "tone-map": "aces", "float": true, "aov": "depth"}
})";

constexpr const char* kTheSame =
    "render procedural:cloud @a.exr --resolution 20 --orbit 200,6 --fov 26 --size 40x30 --up 0,1,0.1 "
    "--density-scale 30 --albedo 0.8,0.9,0.7 --light "
    "direction=-1,0.5,0.25,color=1,0.8,0.55,intensity=26 --light position=1,2,1 --ambient 0.25 "
    "--environment @sky.exr --environment-rotation 30 --extinction-tint 0.5,1,2 --phase-g 0.3 "
    "--light-attenuation exact --directions "
    "98 "
    "--no-gradient --lod 1.5 --composite additive --float --aov depth";

}  // namespace

TEST_F(SceneCommand, AreOptions) {
  writeSky("sky.exr");
  scene(kEverything);
  EXPECT_EQ(bytes("render --scene @s.json @a.exr"), bytes(kTheSame));
}

TEST_F(SceneCommand, TheCommandLineWins) {
  writeSky("sky.exr");
  scene(kEverything);
  writeBytes(folder / "t.json", R"({"opacity": [[0, 0], [1, 0.5]]})");
  std::string file;
  const auto render = [&](const std::string& options) {
    file = bytes("render --scene @s.json " + options + " --size 8x8");
  };
  const auto attribute = [&](const std::string& name) { return exrAttribute(file, "freevoxels:" + name); };
  render("@a.exr --fov 40 --gradient --ambient 0.5 --light direction=0,1,0,intensity=2");
  EXPECT_EQ(attribute("fov"), "40");
  EXPECT_EQ(attribute("size"), "8x8");
  EXPECT_EQ(attribute("gradient"), "yes");
  EXPECT_EQ(attribute("ambient"), "0.5,0.5,0.5");
  EXPECT_EQ(attribute("environment-rotation"), "30");
  EXPECT_EQ(attribute("light"), "direction=0,1,0,color=1,1,1,intensity=2");

  render("@a.exr --orthographic 2 --camera-position 1,2,3 --paper --unlit");
  EXPECT_EQ(attribute("fov"), "");
  EXPECT_EQ(attribute("camera-position"), "1,2,3");
  EXPECT_EQ(attribute("directions"), "26");  // one of the eight, in the scene too
  EXPECT_EQ(attribute("light"), "");

  render("procedural:rods @a.exr --transfer-function @t.json");
  EXPECT_EQ(attribute("input"), "procedural:rods");
  EXPECT_EQ(attribute("resolution"), "128");
  EXPECT_EQ(attribute("density-scale"), "");
}

TEST_F(SceneCommand, SavedOnesMakeTheSamePixelsFromAnyFolder) {
  std::filesystem::create_directories(folder / "made/here");
  std::filesystem::create_directories(folder / "kept");
  expectSuccess(run("generate cloud @made/cloud.vdb --resolution 20 --quiet"));
  writeSky("sky.exr");
  writeBytes(folder / "made/t.json", R"({"opacity": [[0, 0], [1, 0.5]], "color": [[0, 1, 0.5, 0]]})");
  const std::string lit = " --light position=1,2,1 --environment @sky.exr --size 40x30 --float --quiet";
  for (const std::string options :
       {"--transfer-function @made/t.json --no-culling", "--orbit 10,80 --paper"}) {
    SCOPED_TRACE(options);
    expectSuccess(run("render @made/cloud.vdb @a.exr @a.png --save-scene @kept/s.json " + options + lit));
    expectSuccess(run("render --scene @kept/s.json @b.exr @b.png --save-scene @made/here/s.json --quiet"));
    expectSuccess(run("render --scene @made/here/s.json @c.exr @c.png --quiet"));
    for (const std::string name : {"b", "c"}) {
      EXPECT_EQ(readExr(folder / "a.exr").pixels, readExr(folder / (name + ".exr")).pixels);
      EXPECT_EQ(readBytes(folder / "a.png"), readBytes(folder / (name + ".png")));
    }
    const auto saved = nlohmann::json::parse(readBytes(folder / "kept/s.json"));
    EXPECT_EQ(saved.at("input").at("volume"), "../made/cloud.vdb");
    EXPECT_EQ(saved.at("light").at("environment"), "../sky.exr");
    EXPECT_TRUE(saved.at("light").at("lights").at(0).at("intensity").is_number());
    EXPECT_TRUE(saved.at("camera").contains("camera-position"));
    std::filesystem::remove(folder / "kept/s.json");
    std::filesystem::remove(folder / "made/here/s.json");
  }
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "made/t.json")).size(), 2u);
}

TEST_F(SceneCommand, VolumesAreAListOrOptionsInAnyOrder) {
  const std::string one = "{\"volume\": \"procedural:fire\", \"resolution\": 14, \"transform\": [0.2, 0, 0.1]}",
                    other = "\"procedural:cube\"";
  const std::string options = "--resolution 16 --size 32x24 --camera-position 1.5,1,2 --unlit";
  scene("{\"volumes\": [" + one + ", " + other + "]}");
  const std::string drawn = bytes("render procedural:cloud @a.exr --float " + options + " --scene @s.json");
  const std::string text = "procedural:fire,resolution=14,transform=0.2,0,0.1";
  for (const std::string& added : {"--add " + text + " --add procedural:cube", "--add procedural:cube --add " + text}) {
    expectSuccess(run("render procedural:cloud @b.exr --float --quiet " + options + " " + added + " --save-scene @saved.json"));
    EXPECT_EQ(readExr(folder / "b.exr").pixels, readExr(folder / "a.exr").pixels) << added;
    expectSuccess(run("render --scene @saved.json @c.exr --float --quiet"));
    EXPECT_EQ(readExr(folder / "c.exr").pixels, readExr(folder / "a.exr").pixels) << added;
  }
  expectSuccess(run("render procedural:cloud @alone.exr --float --quiet " + options));
  EXPECT_NE(readExr(folder / "alone.exr").pixels, readExr(folder / "a.exr").pixels);
  EXPECT_FALSE(drawn.empty());
}

TEST_F(SceneCommand, AVolumeThatIsWronglyAddedIsSaidInOneSentence) {
  const std::string render = "render procedural:cube @a.png --resolution 8 --size 16x12 --add ";
  expectCleanRefusal(render + "procedural:cloud,densityscale=3", ExitCode::Usage, "did you mean 'density-scale'");
  expectCleanRefusal(render + "procedural:cloud,transform=1,2", ExitCode::Usage, "X,Y,Z");
  expectCleanRefusal(render + "procedural:cloud,transform=0,0,0,0,0,1,0,0,0,0,1,0", ExitCode::Usage, "inverted");
  expectCleanRefusal(render + "@missing.vdb", ExitCode::Input, "missing.vdb");
  expectCleanRefusal(render + "procedural:cloud --paper", ExitCode::Usage, "splats");
  expectBadScene(R"({"volumes": [{"resolution": 8}]})", "names no volume");
}

TEST_F(SceneCommand, NamesThatAreNoUnicodeAreRefusedInsteadOfChanged) {
  expectSuccess(run("generate cloud @made\xff.vdb --resolution 12 --quiet"));
  const std::string draw = "render @made\xff.vdb @a.png --size 8 --quiet";
  expectSuccess(run(draw));
  const ProgramResult refused = run(draw + " --save-scene @s.json");
  EXPECT_EQ(refused.exitCode, int(ExitCode::Input));
  EXPECT_NE(refused.err.find(R"(made\xff.vdb' is not)"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("the volume '"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "s.json"));
}

TEST_F(SceneCommand, EmissionNeedsNoNumber) {
  const std::string fire = "procedural:fire @a.exr --resolution 16 --size 24x24 ";
  for (const auto& [json, option] : {std::pair("true", "--emission"), {"3.5", "--emission 3.5"}, {"false", "--no-emission"}}) {
    scene(fmt::format(R"({{"emission": {{"emission": {}}}}})", json));
    const std::string file = bytes("render " + fire + "--scene @s.json");
    EXPECT_EQ(file, bytes("render " + fire + option));
  }
  const std::string file = bytes("render " + fire + "--emission --save-scene @kept.json");
  EXPECT_EQ(file, bytes("render --scene @kept.json @a.exr"));
}

TEST_F(SceneCommand, TransferFunctionsMayBeInline) {
  const std::string transfer = R"({"opacity": [[0, 0], [1, 0.5]], "color": [[0, 1, 0.5, 0]]})";
  writeBytes(folder / "t.json", transfer);
  scene(R"({"input": {"volume": "procedural:cloud", "resolution": 20}, "camera": {"size": [40, 30]},
            "classification": {"transfer-function": )" +
        transfer + "}}");
  bytes("render --scene @s.json @a.exr --save-scene @saved.json");
  const Image inlined = readExr(folder / "a.exr");
  bytes("render --scene @s.json @a.exr --transfer-function @t.json");
  EXPECT_EQ(inlined.pixels, readExr(folder / "a.exr").pixels);
  bytes("render --scene @saved.json @a.exr");
  EXPECT_EQ(inlined.pixels, readExr(folder / "a.exr").pixels);
  const std::string command = exrAttribute(readBytes(folder / "a.exr"), "freevoxels:command");
  EXPECT_NE(command.find("--transfer-function '{"), std::string::npos) << command;
}

TEST_F(SceneCommand, EveryCommandTakesOne) {
  writeSky("sky.exr");
  scene(kEverything);
  const ProgramResult info = run("info --scene @s.json");
  expectSuccess(info);
  EXPECT_EQ(info.out, run("info procedural:cloud --resolution 20").out);
  bytes("oracle --scene @s.json procedural:cloud --resolution 8 @a.exr --size 6x6 --save-scene @o.json");
  const auto oracle = nlohmann::json::parse(readBytes(folder / "o.json"));
  EXPECT_FALSE(oracle.contains("method"));
  EXPECT_EQ(oracle.at("camera").at("size"), nlohmann::json({6, 6}));

  expectSuccess(run("turntable --scene @s.json @t#.exr --frames 2 --save-scene @t.json --quiet"));
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "t.json")).at("camera").at("frames"), 2);
  expectSuccess(run("turntable --scene @t.json @u#.exr --quiet"));
  for (const char frame : {'0', '1'})
    EXPECT_EQ(readExr(folder / (std::string("t") + frame + ".exr")).pixels,
              readExr(folder / (std::string("u") + frame + ".exr")).pixels);
  expectSuccess(run("render --scene @t.json @a.png --quiet"));  // frames, float and aov say nothing here
}

TEST_F(SceneCommand, ExamplesAreRight) {
  for (const char* name : {"cloud.json", "head.json"}) {
    const std::string file = kScenes + "/" + name;
    expectSuccess(runFreevoxels({"info", "--scene", file, "--resolution", "16"}));
    expectSuccess(run("render --scene " + file + " --resolution 16 --size 48x32 @a.png --quiet"));
    EXPECT_EQ(readPng(folder / "a.png").size, glm::ivec2(48, 32));
  }
}

/// Every option of an image is explained, and nothing else: no key is forgotten.
TEST_F(SceneCommand, EveryKeyIsInTheirReadme) {
  const std::string readme = readBytes(kScenes + "/README.md");
  std::set<std::string> explained, known{"volume"};
  const std::map<std::string, std::string> lists{{"light", "lights"}, {"add", "volumes"}, {"channel", "channels"}};  // of repeated options
  const std::regex row(R"(\n\| `([a-z-]+)` \|)"), heading(R"(\n([A-Z][a-z]+):\n)"),
      option(R"(\n  (--[a-z-]+))");
  for (std::sregex_iterator i(readme.begin(), readme.end(), row), end; i != end; ++i)
    explained.insert((*i)[1]);
  const std::string help = run("turntable --help").out;
  std::vector<std::smatch> groups(std::sregex_iterator(help.begin(), help.end(), heading), {});
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::string name = groups[g][1];
    if (std::set<std::string>{"Positionals", "Options", "Scene", "Device", "Messages", "Cluster", "Sequence"}.contains(name))
      continue;
    const auto begin = help.begin() + groups[g].position();
    const auto end = g + 1 < groups.size() ? help.begin() + groups[g + 1].position() : help.end();
    for (std::sregex_iterator i(begin, end, option), last; i != last; ++i) {
      const std::string key = (*i)[1].str().substr(2);
      known.insert(lists.contains(key) ? lists.at(key) : key);
    }
  }
  std::erase_if(known, [&](const std::string& name) { return name.starts_with("no-") && known.contains(name.substr(3)); });  // of an option
  EXPECT_GT(known.size(), 25u);
  EXPECT_EQ(explained, known);
}

TEST_F(SceneCommand, UnknownKeysAreRefusedByName) {
  expectBadScene(R"({"camera": {"fob": 3}})", R"(there is no key "camera.fob"; did you mean "camera.fov"?)");
  expectBadScene(R"({"fov": 3})", R"("fov"; did you mean "camera.fov"?)");
  expectBadScene(R"({"camra": {}})", R"("camra"; did you mean "camera"?)");
  expectBadScene(R"({"light": {"light": []}})", R"("light.light"; did you mean "light.lights"?)");
  expectBadScene(R"({"device": {"device": 0}})", R"("device")");
  expectBadScene(R"({"light": {"lights": [{"direction": [1, 0, 0], "shine": 3}]}})", "shine");
  expectBadScene(R"({"classification": {"transfer-function": {"opacity": [[0, 1]], "shine": 1}}})", "shine");
}

TEST_F(SceneCommand, WrongValuesAreRefused) {
  expectBadScene(R"({"camera": {"fov": "wide"}})", "--fov");
  expectBadScene(R"({"camera": {"fov": true}})", "camera.fov");
  expectBadScene(R"({"camera": {"fov": [1, 2]}})", "--fov");
  expectBadScene(R"({"camera": {"fov": {"degrees": 3}}})", "camera.fov");
  expectBadScene(R"({"camera": {"up": null}})", "camera.up");
  expectBadScene(R"({"camera": {"up": [0, "nan", 1]}})", "camera.up");
  expectBadScene(R"({"camera": {"up": "0,nan,1"}})", "--up");
  expectBadScene(R"({"camera": {"size": [0, 3]}})", "--size");
  expectBadScene(R"({"camera": {"orbit": [1, 2], "camera-position": [1, 2, 3]}})", "exclude each other");
  expectBadScene(R"({"camera": 5})", R"("camera" takes an object)");
  expectBadScene(R"({"light": {"lights": {"direction": [1, 0, 0]}}})", "takes a list");
  expectBadScene(R"({"light": {"lights": [{"color": [1, 1, 1]}]}})", "neither a direction nor a position");
  expectBadScene(R"({"light": {"lights": [{"direction": [0, 0, 0]}]}})", "points nowhere");
  expectBadScene(R"({"light": {"lights": [{"direction": [0, null, 1]}]}})", "light.lights");
  expectBadScene(R"({"classification": {"transfer-function": 3}})", "classification.transfer-function");
  scene(R"({"input": {"volume": ["cloud.vdb"]}})");
  expectCleanRefusal("render --scene @s.json @a.png", ExitCode::Input, "input.volume");
  scene(R"({"method": {"culling": "no"}})");
  expectCleanRefusal("render --scene @s.json procedural:cube @a.png", ExitCode::Input,
                     R"("method.culling" takes true or false)");
}

TEST_F(SceneCommand, WhatIsNoJsonIsRefused) {
  expectBadScene("", "is not valid JSON");
  expectBadScene("[]", "must be an object");
  expectBadScene("{\"camera\": {\n\"fov\": 3,\n}}", "line 3");
  expectBadScene(R"({"camera": {"fov": NaN}})", "is not valid JSON");
  expectBadScene(R"({"camera": {"fov": 1e999}})", "too large");
  expectBadScene(R"({"camera": {"fov": 3, "fov": 4}})", R"("fov" more than once)");
  expectCleanRefusal("render --scene @none.json @a.png", ExitCode::Input, "none.json");
  scene("{}");
  expectCleanRefusal("render --scene @s.json @a.png", ExitCode::Usage, "IN is required");
  scene(R"({"input": {"volume": "procedural:cube"}})");
  expectCleanRefusal("oracle --scene @s.json", ExitCode::Usage, "OUT");
  expectCleanRefusal("render --scene @s.json @a.png --save-scene @s.json", ExitCode::Usage, "same file");
  expectCleanRefusal("render --scene @s.json @a.png --save-scene @no/s.json", ExitCode::Output, "no");
}

TEST_F(SceneCommand, BadEnvironmentsAreRefused) {
  const auto expectBad = [this](const std::string& options, ExitCode code, const std::string& mention) {
    for (const char* command : {"render", "oracle"})
      expectCleanRefusal(
          fmt::format("{} procedural:cube @a.png --resolution 8 --size 8x8 --quiet {}", command, options),
          code, mention);
  };
  const auto write = [this](glm::ivec2 size, float value) {
    Image image{.size = size, .pixels = {}, .depth = {}};
    image.pixels.resize(std::size_t(size.x * size.y), glm::vec4(value));
    writeExr(folder / "e.exr", image, {.fullFloat = true});  // a half file has no infinity: writeExr clamps it
  };
  expectBad("--environment @none.exr", ExitCode::Input, "none.exr");
  write({4, 4}, 1.0f);
  expectBad("--environment @e.exr", ExitCode::Input, "twice as wide as high");
  write({4, 2}, INFINITY);
  expectBad("--environment @e.exr", ExitCode::Input, "radiance is finite");
  writeBytes(folder / "e.exr", "no image");
  expectBad("--environment @e.exr", ExitCode::Input, "e.exr");
  expectBad("--environment-rotation 3", ExitCode::Usage, "--environment-rotation");
  expectBad("--environment-intensity 3", ExitCode::Usage, "--environment-intensity");
  write({4, 2}, 1.0f);
  expectBad("--environment @e.exr --environment-intensity -1", ExitCode::Usage, "--environment-intensity");
  expectBad("--environment @e.exr --environment-rotation nan", ExitCode::Usage, "--environment-rotation");
  expectCleanRefusal("render procedural:cube @e.exr --environment @e.exr", ExitCode::Usage, "same file");
}

/// Lossy compression makes such values of black.
TEST_F(SceneCommand, ANegativeValueOfAnEnvironmentCountsAsNothingAndIsToldOnce) {
  Image sky{.size = {8, 4}};
  sky.pixels.assign(32, glm::vec4(1.0f));
  const auto draw = [&](float value, const char* file) {
    sky.pixels[9].g = value;
    writeExr(folder / "sky.exr", sky, {.fullFloat = true});
    const ProgramResult result =
        run(std::string("render procedural:cube --resolution 8 --size 8x8 --environment @sky.exr @") + file);
    expectSuccess(result);
    return result.err;
  };
  EXPECT_EQ(draw(0.0f, "a.exr").find("below 0"), std::string::npos);
  EXPECT_NE(draw(-6e-8f, "b.exr").find("below 0 count as 0: 1 of them"), std::string::npos);
  EXPECT_EQ(readExr(folder / "a.exr").pixels, readExr(folder / "b.exr").pixels);
}

}  // namespace freevoxels::test
