#include "engine/volume/transfer_formats.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/volume/transfer_source.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using Range = TransferCurves::Range;

TransferCurves readText(const std::string& text, const std::string& wanted = "") {
  return readTransferText({.name = "f.txt", .text = text, .wanted = wanted});
}

void expectRefusedText(const std::string& text, std::initializer_list<std::string> parts, const std::string& wanted = "") {
  SCOPED_TRACE(text);
  test::expectRefusal([&] { readText(text, wanted); }, ErrorKind::Input, parts);
}

double half() {
  return std::pow((0.5 + 0.055) / 1.055, 2.4);  // the linear value of a display's 0.5
}

constexpr const char* kParaView =
    R"([{"Name": "Two", "ColorSpace": "RGB", "RGBPoints": [100, 0, 0, 0, 300, 1, 1, 0.5], "Points": [100, 0, 0.5, 0, 300, 1, 0.5, 0]}])";

TEST(ParaViewFunctions, KeepTheirValuesWithOpacity) {
  const TransferCurves curves = readText(kParaView);
  EXPECT_EQ(curves.range, Range::Values);
  EXPECT_EQ(curves.window, (ValueWindow{100.0, 300.0}));
  ASSERT_EQ(curves.opacity.size(), 2u);
  EXPECT_EQ(curves.opacity[1].opacity, 1.0);
  EXPECT_NEAR(curves.color.back().color.b, half(), 1e-6);
  EXPECT_FALSE(curves.unitDistance);
  EXPECT_TRUE(curves.warnings.empty());
}

TEST(ParaViewFunctions, AreBroughtOverTheValuesOfAVolumeWithoutOpacity) {
  const TransferCurves curves = readText(R"({"Name": "Map", "ColorSpace": "Diverging", "NanColor": [1, 1, 0],
      "RGBPoints": [-1, 0.23, 0.3, 0.75, 1, 0.7, 0.02, 0.15]})");
  EXPECT_EQ(curves.range, Range::Usual);
  EXPECT_EQ(curves.opacity.back().opacity, kMapOpacity);
  EXPECT_GT(curves.color.size(), 5u);
}

TEST(ParaViewFunctions, AreChosenByName) {
  const std::string two = R"([{"Name": "A", "RGBPoints": [0, 1, 0, 0]}, {"Name": "B: b", "RGBPoints": [0, 0, 1, 0]}])";
  EXPECT_EQ(readText(two, "B: b").color.front().color, glm::dvec3(0.0, 1.0, 0.0));
  expectRefusedText(two, {"f.txt", "2 transfer functions", "A, B: b"});
  expectRefusedText(two, {"'C'", "A, B: b"}, "C");
}

TEST(ParaViewFunctions, SayWhatIsLost) {
  EXPECT_EQ(readText(R"({"RGBPoints": [0, 1, 0, 0, 1, 1, 1, 1], "UseLogScale": 1})").warnings.size(), 1u);
  const TransferCurves categories = readText(R"({"IndexedColors": [1, 0, 0, 0, 1, 0, 0, 0, 1]})");
  EXPECT_EQ(categories.warnings.size(), 1u);
  EXPECT_EQ(categories.color.front().color, glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(categories.color.back().color, glm::dvec3(0.0, 0.0, 1.0));
  EXPECT_EQ(readText(R"({"ColorSpace": "New", "RGBPoints": [0, 1, 0, 0]})").warnings.size(), 1u);
}

TEST(ParaViewFunctions, AreRefusedWhereTheyAreWrong) {
  expectRefusedText(R"({"RGBPoints": [0, 1, 0]})", {"RGBPoints", "groups of 4"});
  expectRefusedText(R"({"RGBPoints": 3})", {"RGBPoints"});
  expectRefusedText(R"({"RGBPoints": [0, 1, 0, "x"]})", {"RGBPoints", "x"});
  expectRefusedText(R"({"RGBPoints": []})", {"neither"});
  expectRefusedText(R"([{"RGBPoints": []}, 3])", {"3"});
  expectRefusedText(R"({"ColorSpace": 3, "RGBPoints": [0, 1, 0, 0]})", {"ColorSpace"});
}

TEST(VolViewFunctions, AreInHounsfieldUnitsForAMillimetre) {
  const TransferCurves curves = readText(R"([{"Name": "CT", "AbsoluteRange": true, "EffectiveRange": [-16, 641], "ColorSpace": "RGB",
      "OpacityPoints": [-3024, 0, -16, 0, 641, 0.7, 3071, 0.7], "RGBPoints": [-3024, 0, 0, 0, 3071, 1, 1, 1]}])");
  EXPECT_EQ(curves.window, (ValueWindow{-3024.0, 3071.0}));
  EXPECT_EQ(curves.unitDistance, 1.0);
  ASSERT_EQ(curves.opacity.size(), 4u);
  EXPECT_NEAR(curves.opacity[2].x, (641.0 + 3024.0) / 6095.0, 1e-12);
}

TEST(VolViewFunctions, OfTheirOwnFileAreRead) {
  const std::filesystem::path file = std::filesystem::path(FREEVOXELS_DATA_DIR) / "colormaps/volview_MedicalColorPresets.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the presets of VolView are not here";
  const nlohmann::json presets = nlohmann::json::parse(test::readBytes(file));
  for (const nlohmann::json& preset : presets) {
    SCOPED_TRACE(preset["Name"].get<std::string>());
    const TransferCurves curves = readTransferCurves(file.string() + ":" + preset["Name"].get<std::string>());
    EXPECT_FALSE(curves.opacity.empty());
    EXPECT_FALSE(curves.color.empty());
  }
}

TEST(VolViewFunctions, OfParaViewsMapsAreAllRead) {
  const std::filesystem::path file = std::filesystem::path(FREEVOXELS_DATA_DIR) / "colormaps/paraview_ColorMaps_vtkjs.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the maps of ParaView are not here";
  const nlohmann::json maps = nlohmann::json::parse(test::readBytes(file));
  for (const nlohmann::json& map : maps) {
    SCOPED_TRACE(map["Name"].get<std::string>());
    const TransferCurves curves = readForeignJson({.name = "maps", .text = "", .wanted = ""}, map);
    EXPECT_FALSE(curves.color.empty());
    EXPECT_NO_THROW(parseTransferCurves("written", transferCurvesJson(curves)));
  }
}

constexpr const char* kSlicerXml = R"(<?xml version="1.0"?>
<MRML>
  <VolumeProperty name="CT-A" scalarOpacity="4 -100 0 300 0.5" colorTransfer="8 -100 0 0 0 300 1 1 0.5" gradientOpacity="4 0 1 255 1"/>
  <VolumeProperty name="CT-B" scalarOpacity="2 0 1" colorTransfer="4 0 1 0 0" gradientOpacity="4 0 0 255 1"/>
</MRML>)";

TEST(SlicerFunctions, OfPresetsAreRead) {
  const TransferCurves curves = readText(kSlicerXml, "CT-A");
  EXPECT_EQ(curves.window, (ValueWindow{-100.0, 300.0}));
  EXPECT_EQ(curves.unitDistance, 1.0);
  EXPECT_EQ(curves.opacity.back().opacity, 0.5);
  EXPECT_NEAR(curves.color.back().color.b, half(), 1e-6);
  EXPECT_TRUE(curves.warnings.empty());
  EXPECT_EQ(readText(kSlicerXml, "CT-B").warnings, std::vector<std::string>{kGradientOpacityIsLost});
  expectRefusedText(kSlicerXml, {"CT-A, CT-B"});
  expectRefusedText(R"(<MRML><VolumeProperty scalarOpacity="3 0 1 2"/></MRML>)", {"3 0 1 2"});
  expectRefusedText(R"(<MRML><VolumeProperty scalarOpacity="8 0 1"/></MRML>)", {"8 0 1"});
}

TEST(SlicerFunctions, OfVolumePropertiesAreRead) {
  const TransferCurves curves = readText("1\n1\n0.9\n0.1\n0.2\n10\n4 -100 0 300 0.5\n4 0 1 255 1\n8 -100 0 0 0 300 1 1 0.5\n");
  EXPECT_EQ(curves.window, (ValueWindow{-100.0, 300.0}));
  EXPECT_EQ(curves.opacity.back().opacity, 0.5);
  EXPECT_TRUE(curves.warnings.empty());
}

TEST(SlicerFunctions, OfJsonHaveUnitDistancesAndSharpnesses) {
  const TransferCurves curves = readText(R"({"@schema": "volume-property", "volumeProperties": [{"effectiveRange": [0, 10], "components": [{
      "scalarOpacityUnitDistance": 2.5,
      "scalarOpacity": {"type": "piecewiseLinearFunction", "points": [{"x": 0, "y": 0, "midpoint": 0.5, "sharpness": 1}, {"x": 10, "y": 1,
          "midpoint": 0.5, "sharpness": 0}]},
      "gradientOpacity": {"points": [{"x": 0, "y": 0.2, "midpoint": 0.5, "sharpness": 0}]},
      "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 0, 0], "midpoint": 0.5, "sharpness": 0}]}}, {}]}]})");
  EXPECT_EQ(curves.unitDistance, 2.5);
  ASSERT_EQ(curves.opacity.size(), 4u) << "a step";
  EXPECT_NEAR(curves.opacity[1].x, 0.5, 1e-5);
  EXPECT_NEAR(curves.opacity[2].x, 0.5, 1e-5);
  EXPECT_EQ(curves.warnings.size(), 2u) << "the gradient opacity and the second component";
  expectRefusedText(R"({"volumeProperties": []})", {"no function"});
  expectRefusedText(R"({"volumeProperties": [{}]})", {"components"});
  expectRefusedText(R"({"volumeProperties": [{"components": [{"scalarOpacity": {"points": [{"x": 1}]}}]}]})", {"\"y\""});
}

TEST(TableFunctions, AreOverAllValues) {
  const TransferCurves curves = readText("3\n0 0 0 0 \n1 0 0 0.5 \n1 1 1 0.25 \n");
  EXPECT_EQ(curves.range, Range::All);
  ASSERT_EQ(curves.opacity.size(), 3u);
  EXPECT_EQ(curves.opacity[1].x, 0.5);
  EXPECT_EQ(curves.opacity[1].opacity, 0.5);
  EXPECT_EQ(curves.color.back().color, glm::dvec3(1.0));
  expectRefusedText("3\n0 0 0 0\n", {"no known format"});
  expectRefusedText("1000000000000\n0 0 0 0\n", {"no known format"});
}

TEST(InviwoFunctions, OfAllVersionsAreRead) {
  const auto expectHalf = [](const TransferCurves& curves) {
    EXPECT_EQ(curves.range, Range::All);
    ASSERT_EQ(curves.opacity.size(), 2u);
    EXPECT_EQ(curves.opacity[0].x, 0.25);
    EXPECT_EQ(curves.opacity[1].opacity, 0.5);
    EXPECT_NEAR(curves.color.back().color.r, half(), 1e-6);
    EXPECT_NEAR(*curves.unitShare, 1.0 / 150.0, 1e-12);
  };
  const std::string colors = R"(<rgba x="0" y="0" z="0" w="0"/>)", ends = R"(<rgba x="0.5" y="0.5" z="0.5" w="0.5"/>)";
  expectHalf(readText(fmt::format(R"(<InviwoTransferFunction version="1"><type content="0"/><TFPrimitives><TFPrimitive><pos content="0.25"/>{}</TFPrimitive>
      <TFPrimitive><pos content="1"/>{}</TFPrimitive></TFPrimitives></InviwoTransferFunction>)", colors, ends)));
  expectHalf(readText(fmt::format(R"(<InviwoWorkspace version="2"><Points><Point><pos content="0.25"/>{}</Point><Point><pos content="1"/>{}</Point>
      </Points></InviwoWorkspace>)", colors, ends)));
  expectHalf(readText(fmt::format(R"(<InviwoTreeData><dataPoints><point><pos x="0.25" y="0"/>{}</point><point><pos x="1" y="0.5"/>{}</point>
      </dataPoints></InviwoTreeData>)", colors, ends)));
  const TransferCurves absolute = readText(fmt::format(R"(<InviwoTransferFunction><type content="1"/><TFPrimitives><TFPrimitive><pos content="-7"/>{}
      </TFPrimitive><TFPrimitive><pos content="9"/>{}</TFPrimitive></TFPrimitives></InviwoTransferFunction>)", colors, ends));
  EXPECT_EQ(absolute.range, Range::Values);
  EXPECT_EQ(absolute.window, (ValueWindow{-7.0, 9.0}));
}

TEST(InviwoFunctions, AreTransparentBeyondTheirMask) {
  const TransferCurves curves = readText(R"(<InviwoTransferFunction><maskMin content="0.5"/><maskMax content="1"/><TFPrimitives>
      <TFPrimitive><pos content="0"/><rgba x="1" y="1" z="1" w="0.5"/></TFPrimitive>
      <TFPrimitive><pos content="1"/><rgba x="1" y="1" z="1" w="1"/></TFPrimitive></TFPrimitives></InviwoTransferFunction>)");
  ASSERT_EQ(curves.opacity.size(), 3u);
  EXPECT_EQ(curves.opacity[0].opacity, 0.0);
  EXPECT_EQ(curves.opacity[1].opacity, 0.75);
  EXPECT_EQ(curves.opacity[2].opacity, 1.0);
}

std::string voreenText(const std::string& domain, const std::string& more = "") {
  return fmt::format(R"(<VoreenData version="1"><TransFuncIntensity type="TransFuncIntensity">{}<threshold x="0" y="1"/>{}<Keys>
      <key type="TransFuncMappingKey"><intensity value="0"/><split value="false"/><colorL r="0" g="0" b="0" a="0"/></key>
      <key type="TransFuncMappingKey"><intensity value="0.5"/><split value="true"/><colorL r="255" g="0" b="0" a="51"/><colorR r="0" g="0" b="255" a="255"/></key>
      <key type="TransFuncMappingKey"><intensity value="1"/><split value="false"/><colorL r="0" g="0" b="255" a="255"/></key>
      </Keys></TransFuncIntensity></VoreenData>)", domain, more);
}

TEST(VoreenFunctions, AreReadWithTheirSplits) {
  const TransferCurves curves = readText(voreenText(R"(<domain x="-1000" y="3000"/>)"));
  EXPECT_EQ(curves.range, Range::Values);
  EXPECT_EQ(curves.window, (ValueWindow{-1000.0, 3000.0}));
  ASSERT_EQ(curves.opacity.size(), 4u);
  EXPECT_EQ(curves.opacity[1].opacity, 0.2);
  EXPECT_EQ(curves.opacity[2].opacity, 1.0);
  EXPECT_NEAR(*curves.unitShare, 1.0 / 200.0, 1e-12);
  EXPECT_EQ(readText(voreenText(R"(<domain x="0" y="1"/>)")).range, Range::All);
  EXPECT_EQ(readText(voreenText("", R"(<gammaValue value="2"/><alphaMode value="2"/>)")).warnings.size(), 2u);
  expectRefusedText(voreenText(R"(<domain x="3" y="3"/>)"), {"3..3"});
}

TEST(TransferText, OfNoFormatIsRefused) {
  expectRefusedText("opacity = 1", {"f.txt", "no known format", ".vp", ".itf"});
  expectRefusedText("<a>", {"not valid XML"});
  expectRefusedText("<a/>", {"none of 3D Slicer"});
  expectRefusedText("{\"opacity\": [[0, 1]]}", {"leave out ':x'"}, "x");
  EXPECT_NO_THROW(readText("\xef\xbb\xbf {\"opacity\": [[0, 1]]}"));
}

TEST(TransferCurvesJson, IsReadAsTheSameCurves) {
  for (const char* text : {kParaView, R"({"range": "usual", "opacity": [[0, 0.25]], "unit_share": 0.5, "description": "a map"})"}) {
    const TransferCurves curves = readText(text), again = parseTransferCurves("again", transferCurvesJson(curves));
    EXPECT_EQ(again.range, curves.range);
    EXPECT_EQ(again.unitShare, curves.unitShare);
    EXPECT_EQ(again.description, curves.description);
    ASSERT_EQ(again.color.size(), curves.color.size());
    for (std::size_t i = 0; i < curves.color.size(); ++i) EXPECT_NEAR(again.color[i].color.g, curves.color[i].color.g, 1e-5);
  }
}

}  // namespace
}  // namespace freevoxels
