// Presets, functions of other programs, and what changes them, on the command line.
#include <nlohmann/json.hpp>

#include "tests/commands/render_fixture.h"

namespace freevoxels {
namespace {

using test::expectSuccess;
using test::readBytes;
using test::writeBytes;
using nlohmann::json;

class TransferFunctionCommand : public test::RenderCommand {
 protected:
  /// Of a cloud without light.
  std::string pixels(const std::string& options) const { return render("--unlit " + options, "a.png"); }
};

TEST_F(TransferFunctionCommand, ListsItsPresets) {
  const test::ProgramResult list = run("presets");
  expectSuccess(list);
  EXPECT_NE(list.out.find("ct-bone"), std::string::npos);
  EXPECT_NE(list.out.find("Hounsfield"), std::string::npos);
  const json all = json::parse(run("presets --json").out);
  EXPECT_TRUE(all.at("viridis").contains("color"));
  EXPECT_EQ(json::parse(run("presets viridis").out), all.at("viridis"));
  expectCleanRefusal("presets virdis", ExitCode::Usage, "virdis");
}

TEST_F(TransferFunctionCommand, DrawsWithAPresetAsWithItsFile) {
  expectSuccess(run("convert-tf turbo @turbo.json"));
  EXPECT_EQ(pixels("--transfer-function turbo"), pixels("--transfer-function " + (folder / "turbo.json").string()));
  expectCleanRefusal("convert-tf @turbo.json @turbo.json", ExitCode::Usage, "same file");
}

TEST_F(TransferFunctionCommand, WritesWhatItUnderstood) {
  writeBytes(folder / "p.xml", R"(<MRML><VolumeProperty name="A" scalarOpacity="4 0 0 10 1" colorTransfer="8 0 0 0 0 10 1 1 1"
      gradientOpacity="4 0 0 1 1"/></MRML>)");
  const test::ProgramResult result = run("convert-tf @p.xml:A @out.json");
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("gradient opacity"), std::string::npos) << result.err;
  const json function = json::parse(readBytes(folder / "out.json"));
  EXPECT_EQ(function.at("range"), json({0.0, 10.0}));
  EXPECT_EQ(function.at("unit_distance"), 1.0);
  EXPECT_EQ(function.at("opacity"), json({{0.0, 0.0}, {1.0, 1.0}}));
  expectCleanRefusal("convert-tf @p.xml:B @other.json", ExitCode::Input, "'B'");
}

TEST_F(TransferFunctionCommand, ChangesGiveTheImageOfTheChangedFunction) {
  writeBytes(folder / "a.json", R"({"range": [0, 1], "opacity": [[0, 0], [1, 0.5]], "color": [[0, 1, 0, 0], [1, 0, 0, 1]], "unit_distance": 0.1})");
  writeBytes(folder / "b.json", R"({"range": [0.2, 0.6], "opacity": [[0, 0], [1, 0.5]], "color": [[0, 0, 0, 1], [1, 1, 0, 0]], "unit_distance": 0.05})");
  const std::string a = "--transfer-function " + (folder / "a.json").string(), b = "--transfer-function " + (folder / "b.json").string();
  const std::string changed = pixels(a + " --window 0.4,0.4 --opacity 2 --invert");
  EXPECT_EQ(changed, pixels(b));
  EXPECT_EQ(changed, pixels(a + " --window 0.2..0.6 --opacity 2 --invert"));
  EXPECT_NE(changed, pixels(a));
}

TEST_F(TransferFunctionCommand, AWindowAloneIsGreyAndOpacityScalesDensities) {
  EXPECT_EQ(pixels("--window 0.1..0.7"), pixels("--transfer-function grey --window 0.1..0.7"));
  EXPECT_EQ(pixels("--density-scale 10 --opacity 2"), pixels("--density-scale 20"));
  EXPECT_NE(pixels(""), pixels("--opacity 2"));
}

TEST_F(TransferFunctionCommand, ScenesNamePresetsAndFilesOfTheirFolder) {
  std::filesystem::create_directory(folder / "made");
  writeBytes(folder / "made/map.json", R"([{"Name": "A", "RGBPoints": [0, 1, 0, 0]}, {"Name": "B", "RGBPoints": [0, 0, 0, 1]}])");
  const std::string volume = R"({"input": {"volume": "procedural:cloud", "resolution": 24}, "camera": {"size": [64, 48]}, "light": {"unlit": true},)";
  writeBytes(folder / "made/preset.json", volume + R"("classification": {"transfer-function": "skin-and-bone", "window": [0.5, 0.8], "opacity": 3}})");
  writeBytes(folder / "made/file.json", volume + R"("classification": {"transfer-function": "map.json:B", "invert": true}})");
  const auto ofScene = [&](const std::string& options) {
    expectSuccess(run("render @a.png --quiet --scene " + options));
    return readBytes(folder / "a.png");
  };
  EXPECT_EQ(ofScene("@made/preset.json --save-scene @saved.json"), pixels("--transfer-function skin-and-bone --window 0.1..0.9 --opacity 3"));
  const json saved = json::parse(readBytes(folder / "saved.json")).at("classification");
  EXPECT_EQ(saved.at("transfer-function"), "skin-and-bone");
  EXPECT_EQ(saved.at("window"), "0.1..0.9");
  EXPECT_EQ(saved.at("opacity"), 3.0);
  const std::string file = ofScene("@made/file.json --save-scene @saved.json");
  EXPECT_EQ(file, pixels("--invert --transfer-function " + (folder / "made/map.json").string() + ":B"));
  EXPECT_EQ(file, ofScene("@saved.json"));
}

TEST_F(TransferFunctionCommand, WhatIsNeitherFileNorPresetIsRefused) {
  expectCleanRefusal("render procedural:cube @a.png --transfer-function ct-bome", ExitCode::Input, "did you mean 'ct-bone'");
  writeBytes(folder / "two.json", R"([{"Name": "A", "RGBPoints": [0, 1, 0, 0]}, {"Name": "B", "RGBPoints": [0, 0, 0, 1]}])");
  expectCleanRefusal("render procedural:cube @a.png --transfer-function @two.json", ExitCode::Input, "A, B");
}

}  // namespace
}  // namespace freevoxels
