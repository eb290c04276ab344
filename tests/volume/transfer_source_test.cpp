#include "engine/volume/transfer_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/core/error.h"
#include "engine/volume/procedural.h"
#include "engine/volume/scan.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::expectRefusal;
using test::writeBytes;

/// Scalars 2..6, voxels of 0.5 x 0.5 x 0.5.
Volume fiveVoxels() {
  return makeVolume({5, 1, 1}, glm::dmat4(0.5), [](int x, int, int) { return 2.0f + float(x); });
}

TEST(TransferPresets, HaveNamesThatAreFoundInAnySpelling) {
  std::set<std::string_view> names;
  for (const TransferPreset& preset : transferPresets()) {
    EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
    EXPECT_EQ(presetNamed(preset.name), &preset);
    EXPECT_FALSE(curvesOf(preset).description.empty()) << preset.name;
    EXPECT_FALSE(curvesOf(preset).color.empty()) << preset.name;
  }
  EXPECT_EQ(presetNamed("CT_Bone"), presetNamed("ct-bone"));
  EXPECT_NE(presetNamed("ct bone"), nullptr);
  EXPECT_EQ(presetNamed("ct-bones"), nullptr);
  for (const char* name : {"ct-bone", "ct-soft-tissue", "ct-skin", "ct-lung", "ct-vessels", "mr", "engine", "smoke", "fire", "viridis", "inferno",
                           "magma", "plasma", "turbo", "grey", "cool-warm"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(TransferPresets, OfCtAreInHounsfieldUnitsAndOthersInTheVolumes) {
  for (const TransferPreset& preset : transferPresets()) {
    const TransferCurves curves = curvesOf(preset);
    EXPECT_EQ(curves.range == TransferCurves::Range::Values, preset.name.starts_with("ct-")) << preset.name;
  }
}

TEST(TransferSource, ReadsFilesThenFunctionsOfFilesThenPresets) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "ct-bone").string(), several = (folder / "a:b.json").string();
  EXPECT_EQ(readTransferCurves("ct-bone").window, (ValueWindow{130.0, 1500.0}));
  writeBytes(file, R"({"range": [5, 6], "opacity": [[0, 1]]})");
  EXPECT_EQ(readTransferCurves(file).window, (ValueWindow{5.0, 6.0}));
  writeBytes(several, R"([{"Name": "x:y", "RGBPoints": [0, 1, 0, 0]}, {"Name": "z", "RGBPoints": [0, 0, 1, 0]}])");
  EXPECT_EQ(readTransferCurves(several + ":x:y").color.front().color.r, 1.0);
  EXPECT_EQ(readTransferCurves(several + ":z").color.front().color.g, 1.0);
  EXPECT_EQ(transferFile(several + ":z"), several);
  EXPECT_EQ(transferFile("viridis"), "");
  EXPECT_EQ(readTransferCurves(R"({"RGBPoints": [0, 1, 0, 0]})").color.front().color.r, 1.0) << "JSON of others, too";
}

TEST(TransferSource, SuggestsPresetsAndNamesFiles) {
  const auto read = [](const std::string& text) { return [text] { readTransferCurves(text); }; };
  expectRefusal(read("ct-bome"), ErrorKind::Input, {"'ct-bome'", "did you mean 'ct-bone'", "freevoxels presets"});
  expectRefusal(read("none.json"), ErrorKind::Input, {"none.json"});
  expectRefusal(read("none.json:A"), ErrorKind::Input, {"none.json:A"});
  expectRefusal(read(""), ErrorKind::Input, {""});
  const test::TemporaryFolder folder;
  expectRefusal(read(folder.path().string()), ErrorKind::Input, {folder.path().string()});
  std::ofstream(folder / "large.json") << "";
  std::filesystem::resize_file(folder / "large.json", std::uintmax_t(1) << 30);
  expectRefusal(read((folder / "large.json").string()), ErrorKind::Input, {"large.json", "1024 MiB"});
}

TEST(TransferSource, NamesInScenesAreFilesUnlessTheyArePresets) {
  const test::TemporaryFolder folder;
  const std::string here = folder.path().string();
  EXPECT_EQ(transferNameIn(here, "viridis"), "viridis");
  EXPECT_EQ(transferNameIn(here, "f.json"), here + "/f.json");
  EXPECT_EQ(transferNameIn(here, "{}"), "{}");
  writeBytes(folder / "viridis", "{}");
  EXPECT_EQ(transferNameIn(here, "viridis"), here + "/viridis");
  writeBytes(folder / "f.json", "[]");
  EXPECT_EQ(transferNameIn(here, "./f.json:A/../B"), here + "/f.json:A/../B");
}

TEST(FittedFunction, IsMovedByAWindow) {
  const TransferCurves curves = parseTransferCurves("f", R"({"range": [0, 1], "opacity": [[0, 0], [0.5, 0.1], [1, 0.2]], "unit_distance": 2})");
  const TransferFunction moved = fitted(curves, fiveVoxels(), {.window = ValueWindow{-160.0, 240.0}});
  EXPECT_EQ(moved.opacity[0].scalar, -160.0f);
  EXPECT_EQ(moved.opacity[1].scalar, 40.0f);
  EXPECT_EQ(moved.opacity[2].scalar, 240.0f);
  const TransferFunction again = changed(moved, {.window = ValueWindow{0.0, 4.0}});
  EXPECT_EQ(again.opacity[1].scalar, 2.0f);
  EXPECT_EQ(again.unitDistance, 2.0);
}

TEST(FittedFunction, OfAScaledOpacityIsThatPower) {
  const TransferCurves curves = parseTransferCurves("f", R"({"range": [0, 1], "opacity": [[0, 0.3]], "unit_distance": 1})");
  const auto transparencyOf = [](const TransferFunction& function) {
    return std::exp(-classify({.transferFunction = function}, 0.5f).extinction);
  };
  EXPECT_NEAR(transparencyOf(fitted(curves, fiveVoxels(), {.opacity = 2.5})), std::pow(0.7, 2.5), 1e-6);
}

TEST(FittedFunction, OfAnInvertedOneHasItsColoursTurnedRound) {
  const TransferCurves curves =
      parseTransferCurves("f", R"({"range": [0, 8], "opacity": [[0, 0], [1, 1]], "color": [[0, 1, 0, 0], [0.25, 0, 1, 0], [1, 0, 0, 1]]})");
  const TransferFunction function = fitted(curves, fiveVoxels(), {.inverted = true});
  ASSERT_EQ(function.color.size(), 3u);
  EXPECT_EQ(function.color[0].color, glm::vec3(0, 0, 1));
  EXPECT_EQ(function.color[1].scalar, 6.0f);
  EXPECT_EQ(function.color[1].color, glm::vec3(0, 1, 0));
  EXPECT_EQ(function.color[2].color, glm::vec3(1, 0, 0));
  EXPECT_EQ(function.opacity[1].opacity, 1.0f);
  EXPECT_EQ(changed(function, {.inverted = true}).color[0].color, glm::vec3(1, 0, 0));
}

TEST(FittedFunction, ThatIsInvertedKeepsItsOpacitiesToTheLastBit) {
  const TransferFunction function{.opacity = {{0.1f, 0.2f}, {0.7f, 0.4f}},
                                  .color = {{0.2f, glm::vec3(1, 0, 0)}, {0.9f, glm::vec3(0, 0, 1)}}};
  const TransferFunction turned = changed(function, {.inverted = true});
  EXPECT_EQ(turned.opacity[1].scalar, 0.7f);
  EXPECT_EQ(turned.color[0].color, glm::vec3(0, 0, 1));
  EXPECT_NEAR(turned.color[0].scalar, 0.1f, 1e-6f);
  EXPECT_NEAR(turned.color[1].scalar, 0.8f, 1e-6f);
}

TEST(FittedFunction, StaysAsItIsWithoutChanges) {
  const TransferFunction function{.opacity = {{0.1f, 0.2f}, {0.3f, 0.4f}}, .color = {{0.7f, glm::vec3(0.1f)}}, .unitDistance = 0.3};
  EXPECT_EQ(transferFunctionJson(changed(function, {})), transferFunctionJson(function));
}

TEST(FittedFunction, HasAUnitThatIsAShareOfTheBox) {
  const TransferCurves curves = parseTransferCurves("f", R"({"opacity": [[0, 1]], "unit_share": 0.1})");
  EXPECT_DOUBLE_EQ(fitted(curves, fiveVoxels()).unitDistance, 0.25);
}

TEST(UsualRange, LeavesOutOneIn2000AtEitherEnd) {
  const Volume scan = makeVolume({100, 100, 1}, glm::dmat4(1.0), [](int x, int y, int) {
    if (x == 0 && y < 2) return y == 0 ? 10000.0f : -9000.0f;
    return float((x + y) % 11) * 10.0f;
  });
  const ValueWindow range = usualRange(scan);
  EXPECT_NEAR(range.low, 0.0, 10.0);
  EXPECT_NEAR(range.high, 100.0, 10.0);
}

TEST(UsualRange, OfDensitiesBeginsAt0AndOfOneValueHasAWidth) {
  EXPECT_EQ(usualRange(makeProcedural("cloud", 16)).low, 0.0);
  EXPECT_EQ(usualRange(makeProcedural("cube", 4)), (ValueWindow{0.0, 1.0}));
}

}  // namespace
}  // namespace freevoxels
