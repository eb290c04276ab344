#include "apps/view/opened_file.h"

#include <CLI/CLI.hpp>

#include "apps/view/view_options.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::expectRefusal;

class OpenedFile : public testing::Test {
 protected:
  OpenedFile() {
    state.scene.input.volume = "procedural:cloud";
    state.scene.classification.densityScale = 3.0;
    state.scene.lighting.ambient = glm::dvec3(0.5);
    state.scene.camera.size = {300, 200};
    state.scene.camera.position = glm::dvec3(1.0, 2.0, 3.0);
    state.camera = Camera{};
    state.changed = false;
  }
  std::string made(const std::string& name, const std::string& text = "") const {
    test::writeBytes(folder / name, text);
    return (folder / name).string();
  }
  /// Refused, with nothing changed.
  void expectRefused(const std::string& file, std::initializer_list<std::string> parts) {
    expectRefusal([&] { openFile(state, file); }, ErrorKind::Input, parts);
    EXPECT_EQ(state.scene.input.volume, "procedural:cloud");
    EXPECT_EQ(state.scene.classification.densityScale, 3.0);
    EXPECT_TRUE(state.camera);
    EXPECT_FALSE(state.changed);
  }

  const test::TemporaryFolder folder;
  ViewState state;
};

TEST_F(OpenedFile, ASceneAtTheStartGivesAllThatOptionsLeaveOpen) {
  const std::string file = made("s.json", R"({"input": {"volume": "procedural:head", "resolution": 32},
      "camera": {"fov": 20, "frames": 5}, "output": {"background": [0.1, 0.2, 0.3], "exposure": 2}})");
  CLI::App program;
  ViewOptions options;
  options.add(program);
  program.parse(fmt::format("--scene '{}' --fov 30", file));
  options.prepare();
  const SceneDescription& scene = options.scene.description;
  EXPECT_EQ(scene.input.volume, "procedural:head");
  EXPECT_EQ(scene.camera.verticalFov, 30.0);
  EXPECT_EQ(scene.camera.frames, 5);
  EXPECT_EQ(scene.output.background, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(scene.output.exposure, 2.0);
}

TEST_F(OpenedFile, AVolumeIsFramedAnewInTheSameLight) {
  const std::string file = made("smoke.vdb");
  openFile(state, file);
  EXPECT_EQ(state.scene.input.volume, file);
  EXPECT_FALSE(state.camera);
  EXPECT_FALSE(state.scene.camera.position);
  EXPECT_EQ(state.scene.camera.size, glm::ivec2(300, 200));
  EXPECT_FALSE(state.scene.classification.densityScale);
  EXPECT_EQ(state.scene.lighting.ambient, glm::dvec3(0.5));
  EXPECT_FALSE(state.sequence);
  EXPECT_TRUE(state.changed);
  openFile(state, "procedural:head");
  EXPECT_EQ(state.scene.input.volume, "procedural:head");
}

TEST_F(OpenedFile, APatternIsItsFirstFrame) {
  made("s_2.vdb");
  made("s_1.vdb");
  openFile(state, (folder / "s_#.vdb").string());
  EXPECT_EQ(state.scene.input.volume, (folder / "s_1.vdb").string());
  ASSERT_TRUE(state.sequence);
  EXPECT_EQ(state.sequence->files.size(), 2u);
  openFile(state, (folder / "s_2.vdb").string());
  EXPECT_FALSE(state.sequence) << "one file is opened alone";
}

TEST_F(OpenedFile, AFolderOfOpenVdbFilesIsItsSequenceOrItsFirstFile) {
  made("s_2.vdb");
  made("s_1.vdb");
  openFile(state, folder.path().string());
  EXPECT_EQ(state.scene.input.volume, (folder / "s_1.vdb").string());
  ASSERT_TRUE(state.sequence);
  EXPECT_EQ(state.sequence->files.size(), 2u);
  std::filesystem::remove(folder / "s_2.vdb");
  openFile(state, folder.path().string());
  EXPECT_EQ(state.scene.input.volume, (folder / "s_1.vdb").string());
  EXPECT_FALSE(state.sequence);
}

TEST_F(OpenedFile, ASceneBringsAllButTheSize) {
  made("smoke.vdb");
  openFile(state, made("scene.json", R"({"input": {"volume": "smoke.vdb"}, "output": {"float": true},
      "camera": {"orbit": [10, 20], "size": [64, 64], "frames": 5}, "method": {"attenuation": "nearest"}})"));
  EXPECT_EQ(state.scene.input.volume, (folder / "smoke.vdb").string());
  EXPECT_EQ(state.scene.camera.orbit, glm::dvec2(10.0, 20.0));
  EXPECT_EQ(state.scene.camera.size, glm::ivec2(300, 200));
  EXPECT_FALSE(state.scene.lighting.ambient);
  EXPECT_TRUE(state.scene.output.fullFloat);
  EXPECT_TRUE(state.scene.method.attenuation);
  EXPECT_FALSE(state.camera);
  EXPECT_TRUE(state.changed);
}

TEST_F(OpenedFile, AToneMapThatWasChosenForLightGoesOnToVolumesAndNotToScenes) {
  state.scene.output.toneMap = ToneMap::Filmic;
  state.toneMapIsAutomatic = true;
  openFile(state, "procedural:head");
  EXPECT_TRUE(state.toneMapIsAutomatic) << "its first image says whether it has light";
  openFile(state, made("given.json", R"({"input": {"volume": "procedural:head"}, "output": {"tone-map": "none"}})"));
  EXPECT_EQ(state.scene.output.toneMap, ToneMap::None);
  EXPECT_FALSE(state.toneMapIsAutomatic);
}

TEST_F(OpenedFile, ATransferFunctionTakesThePlaceOfDensities) {
  const std::string file = made("tf.json", R"({"opacity": [[0, 0], [1, 1]]})");
  openFile(state, file);
  EXPECT_EQ(state.scene.classification.transferFunction, file);
  EXPECT_FALSE(state.scene.classification.densityScale);
  EXPECT_TRUE(state.camera) << "seen from the same place";
  EXPECT_TRUE(state.changed);
}

TEST_F(OpenedFile, AFunctionOfAnotherProgramIsOne) {
  const std::string table = made("table.1dt", "1\n1 1 1 0.5\n"), map = made("map.json", R"([{"RGBPoints": [0, 1, 0, 0]}])");
  expectRefused(made("two.json", R"([{"Name": "A", "RGBPoints": []}, {"Name": "B", "RGBPoints": []}])"), {"two.json", "A, B"});
  openFile(state, table);
  EXPECT_EQ(state.scene.classification.transferFunction, table);
  openFile(state, map);
  EXPECT_EQ(state.scene.classification.transferFunction, map);
  EXPECT_FALSE(isWorthRemembering(table));
}

TEST_F(OpenedFile, AnImageIsTheLightAround) {
  const std::string file = made("sky.exr");
  openFile(state, file);
  EXPECT_EQ(state.scene.lighting.environment, file);
  EXPECT_EQ(state.scene.input.volume, "procedural:cloud");
  EXPECT_TRUE(state.changed);
}

TEST_F(OpenedFile, WhatIsNoneOfThemIsRefused) {
  expectRefused((folder / "none.vdb").string(), {"none.vdb", "no such file"});
  expectRefused((folder / "none_#.vdb").string(), {"none_#.vdb", "no frame"});
  expectRefused(made("a.txt"), {"a.txt", ".vdb", ".json", ".exr"});
  expectRefused(made("a.json", "{"), {"a.json"});
  expectRefused(made("b.json", R"({"camera": {"fov": -3}, "nonsense": {}})"), {"b.json"});
  expectRefused(made("c.json", R"({"input": {"volume": "missing.vdb"}})"), {"missing.vdb"});
}

TEST_F(OpenedFile, OnlyWhatMakesAnImageIsRemembered) {
  EXPECT_TRUE(isWorthRemembering(made("smoke.vdb")));
  EXPECT_TRUE(isWorthRemembering(made("scene.json", R"({"camera": {}})")));
  EXPECT_FALSE(isWorthRemembering(made("tf.json", R"({"opacity": [[0, 1]]})")));
  EXPECT_FALSE(isWorthRemembering(made("sky.exr")));
  EXPECT_FALSE(isWorthRemembering("procedural:cloud"));
}

TEST_F(OpenedFile, ALookThatSeesNothingIsNotTaken) {
  Camera wrong;
  wrong.up = glm::dvec3(0.0);
  state.setCamera(wrong);
  EXPECT_NE(state.problem.find("up"), std::string::npos);
  EXPECT_EQ(state.scene.camera.position, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_FALSE(state.changed);
}

}  // namespace
}  // namespace freevoxels
