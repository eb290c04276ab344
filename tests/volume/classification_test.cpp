#include "engine/volume/classification.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/volume/procedural.h"
#include "engine/volume/transfer_source.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::TemporaryFolder;
using test::writeBytes;

/// Scalars 2..6, voxels of 0.5 x 0.5 x 0.5.
Volume smallVolume() {
  return makeVolume({5, 1, 1}, glm::dmat4(0.5), [](int x, int, int) { return 2.0f + float(x); });
}

TEST(Classification, PhysicalExtinctionIsDensityTimesScale) {
  Classification classification;
  classification.densityScale = 3.0;
  classification.albedo = {0.25f, 0.5f, 0.75f};
  EXPECT_DOUBLE_EQ(classify(classification, 2.0f).extinction, 6.0);
  EXPECT_EQ(classify(classification, 2.0f).color, glm::dvec3(0.25, 0.5, 0.75));
  EXPECT_EQ(classify(classification, 0.0f).extinction, 0.0);
  EXPECT_EQ(classify(classification, -2.0f).extinction, 0.0);
  EXPECT_EQ(classify(classification, kInactiveVoxel).extinction, 0.0);
}

TEST(Classification, OpacityOverTheUnitDistanceIsWhatWasAskedFor) {
  Classification classification;
  classification.transferFunction = TransferFunction{
      .opacity = {{1.0f, 0.0f}, {3.0f, 0.5f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = 0.25};
  for (const auto& [scalar, alpha] : {std::pair(3.0f, 0.5), std::pair(2.0f, 0.25), std::pair(1.5f, 0.125)}) {
    const double extinction = classify(classification, scalar).extinction;
    EXPECT_NEAR(1.0 - std::exp(-extinction * 0.25), alpha, 1e-12) << scalar;
  }
}

TEST(Classification, TransferFunctionsAreConstantBeyondTheirEnds) {
  Classification classification;
  classification.transferFunction = TransferFunction{.opacity = {{1.0f, 0.1f}, {2.0f, 0.6f}},
                                                     .color = {{1.0f, {1, 0, 0}}, {2.0f, {0, 0, 1}}}};
  const auto same = [&](float a, float b) {
    EXPECT_EQ(classify(classification, a).extinction, classify(classification, b).extinction);
    EXPECT_EQ(classify(classification, a).color, classify(classification, b).color);
  };
  same(-100.0f, 1.0f);
  same(100.0f, 2.0f);
  EXPECT_EQ(classify(classification, 1.25f).color, glm::dvec3(0.75, 0.0, 0.25));
  EXPECT_EQ(classify(classification, kInactiveVoxel).extinction, 0.0);
}

TEST(Classification, FullOpacityStaysFinite) {
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, 1.0f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = 2.0};
  EXPECT_DOUBLE_EQ(classify(classification, 0.0f).extinction, std::log(4096.0) / 2.0);
}

TEST(Classification, TheAutomaticScaleGivesAUniformCubeItsOpticalDepth) {
  for (const int resolution : {8, 32}) {
    Volume cube = makeProcedural("cube", resolution);  // edge 1
    EXPECT_NEAR(automaticDensityScale(cube, 3.0), 3.0, 1e-9);
    for (ScalarBricks::Brick& brick : cube.scalars.editable())
      for (float& value : brick) value *= 0.25f;
    EXPECT_NEAR(automaticDensityScale(cube, 3.0), 4.0 * 3.0, 1e-9);
  }
  const Volume empty = makeVolume({2, 2, 2}, glm::dmat4(1.0), [](int, int, int) { return -1.0f; });
  EXPECT_EQ(automaticDensityScale(empty, 3.0), 1.0);
}

class TransferFunctionFile : public testing::Test {
 protected:
  TransferFunction read(const std::string& json) const {
    writeBytes(file, json);
    return fitted(readTransferCurves(file.string()), smallVolume());
  }
  void expectRefused(const std::string& json, std::initializer_list<std::string> parts) const {
    SCOPED_TRACE(json);
    try {
      read(json);
      ADD_FAILURE() << "it was accepted";
    } catch (const Error& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      EXPECT_NE(sentence.find(file.string()), std::string::npos) << sentence;
      for (const std::string& part : parts)
        EXPECT_NE(sentence.find(part), std::string::npos) << part << " in: " << sentence;
    }
  }

  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "transfer.json";
};

TEST_F(TransferFunctionFile, IsMappedToItsRange) {
  const TransferFunction transfer = read(
      R"({"range": [-1, 3], "opacity": [[0, 0], [0.5, 0.25], [1, 1]],
          "color": [[0.25, 1, 0.5, 0], [1, 0, 0.25, 1]], "unit_distance": 0.125})");
  ASSERT_EQ(transfer.opacity.size(), 3u);
  EXPECT_EQ(transfer.opacity[0].scalar, -1.0f);
  EXPECT_EQ(transfer.opacity[1].scalar, 1.0f);
  EXPECT_EQ(transfer.opacity[1].opacity, 0.25f);
  EXPECT_EQ(transfer.opacity[2].scalar, 3.0f);
  ASSERT_EQ(transfer.color.size(), 2u);
  EXPECT_EQ(transfer.color[0].scalar, 0.0f);
  EXPECT_EQ(transfer.color[0].color, glm::vec3(1.0f, 0.5f, 0.0f));
  EXPECT_EQ(transfer.unitDistance, 0.125);
}

TEST_F(TransferFunctionFile, DefaultsToTheVolumesRangeItsVoxelSizeAndWhite) {
  const TransferFunction transfer = read(R"({"opacity": [[0, 0], [1, 0.5]]})");
  EXPECT_EQ(transfer.opacity[0].scalar, 2.0f);
  EXPECT_EQ(transfer.opacity[1].scalar, 6.0f);
  EXPECT_DOUBLE_EQ(transfer.unitDistance, 0.5);
  ASSERT_EQ(transfer.color.size(), 1u);
  EXPECT_EQ(transfer.color[0].color, glm::vec3(1.0f));
}

TEST_F(TransferFunctionFile, OfAUniformVolumeEndsAtItsLastPoint) {
  writeBytes(file, R"({"opacity": [[0, 0], [1, 0.75]]})");
  Classification classification;
  classification.transferFunction = fitted(readTransferCurves(file.string()), makeProcedural("cube", 2));
  EXPECT_NEAR(1.0 - std::exp(-0.5 * classify(classification, 1.0f).extinction), 0.75, 1e-12);
}

TEST_F(TransferFunctionFile, RefusesUnknownAndMissingKeys) {
  expectRefused(R"({"opacity": [[0, 1]], "colour": []})", {"\"colour\"", "color"});
  expectRefused(R"({"opacity": [[0, 1]], "a\nb": []})", {"a\\nb"});
  expectRefused(R"({"color": [[0, 1, 1, 1]]})", {"\"opacity\""});
  expectRefused("{}", {"\"opacity\""});
  expectRefused("[1, 2]", {"array"});
}

TEST_F(TransferFunctionFile, RefusesRepeatedKeys) {
  expectRefused(R"({"opacity": [[0, 1]], "opacity": [[0, 0.5]]})", {"\"opacity\"", "more than once"});
  expectRefused(R"({"range": [0, 1], "opacity": [[0, 1]], "range": [0, 2]})",
                {"\"range\"", "more than once"});
}

TEST_F(TransferFunctionFile, RefusesBadPoints) {
  expectRefused(R"({"opacity": []})", {"\"opacity\"", "at least one"});
  expectRefused(R"({"opacity": 1})", {"\"opacity\"", "list"});
  expectRefused(R"({"opacity": [[0, 0], [0.5, 1], [0.5, 0]]})", {"\"opacity\"", "ascending"});
  expectRefused(R"({"opacity": [[0.6, 0], [0.5, 1]]})", {"\"opacity\"", "ascending"});
  expectRefused(R"({"opacity": [[0, 1.5]]})", {"\"opacity\"", "1.5"});
  expectRefused(R"({"opacity": [[0, -0.5]]})", {"\"opacity\"", "-0.5"});
  expectRefused(R"({"opacity": [[2, 0.5]]})", {"\"opacity\"", "0..1"});
  expectRefused(R"({"opacity": [[0, 0.5, 1]]})", {"\"opacity\"", "2 numbers"});
  expectRefused(R"({"opacity": [[0, "1"]]})", {"\"opacity\"", "string"});
  expectRefused(R"({"opacity": [[0, null]]})", {"\"opacity\"", "null"});
  expectRefused(R"({"opacity": [[0, 1]], "color": [[0, 255, 0, 0]]})", {"\"color\"", "255"});
  expectRefused(R"({"opacity": [[0, 1]], "color": [[0, 1, 0]]})", {"\"color\"", "4 numbers"});
}

TEST_F(TransferFunctionFile, RefusesBadRangesAndDistances) {
  const std::string opacity = R"({"opacity": [[0, 1]], )";
  expectRefused(opacity + R"("range": [1, 1]})", {"\"range\"", "lo below hi"});
  expectRefused(opacity + R"("range": [2, 1]})", {"\"range\""});
  expectRefused(opacity + R"("range": [1]})", {"\"range\"", "2 numbers"});
  expectRefused(opacity + R"("range": "all"})", {"\"range\""});
  expectRefused(opacity + R"("range": [0, 1e300]})", {"\"range\"", "too large"});
  expectRefused(opacity + R"("unit_distance": 0})", {"\"unit_distance\"", "above 0"});
  expectRefused(opacity + R"("unit_distance": -1})", {"\"unit_distance\""});
  expectRefused(opacity + R"("unit_distance": [1]})", {"\"unit_distance\"", "array"});
}

TEST_F(TransferFunctionFile, RefusesWhatIsNotJson) {
  expectRefused("", {"not valid JSON"});
  expectRefused("opacity = 1", {"not valid JSON", "line 1"});
  expectRefused(R"({"opacity": [[0, NaN]]})", {"not valid JSON"});
  expectRefused(R"({"opacity": [[0, 1e999]]})", {"too large"});
  expectRefused("{\"opacity\":\n\n [[0,", {"not valid JSON", "line 3"});
}

TEST_F(TransferFunctionFile, RefusesMissingFilesAndFolders) {
  EXPECT_THROW(readTransferCurves((folder / "none.json").string()), Error);
  EXPECT_THROW(readTransferCurves(folder.path().string()), Error);
}

}  // namespace
}  // namespace freevoxels
