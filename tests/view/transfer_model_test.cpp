#include "apps/view/transfer_model.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/core/error.h"
#include "engine/volume/classification.h"
#include "engine/volume/procedural.h"
#include "engine/volume/transfer_source.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::readBytes;

/// Scalars 2..6, voxels of 0.5 x 0.5 x 0.5.
Volume smallVolume() {
  return makeVolume({5, 1, 1}, glm::dmat4(0.5), [](int x, int, int) { return 2.0f + float(x); });
}

void expectSame(const TransferFunction& a, const TransferFunction& b) {
  ASSERT_EQ(a.opacity.size(), b.opacity.size());
  for (std::size_t i = 0; i < a.opacity.size(); ++i) {
    EXPECT_EQ(a.opacity[i].scalar, b.opacity[i].scalar);
    EXPECT_EQ(a.opacity[i].opacity, b.opacity[i].opacity);
  }
  ASSERT_EQ(a.color.size(), b.color.size());
  for (std::size_t i = 0; i < a.color.size(); ++i) {
    EXPECT_EQ(a.color[i].scalar, b.color[i].scalar);
    EXPECT_EQ(a.color[i].color, b.color[i].color);
  }
  EXPECT_EQ(a.unitDistance, b.unitDistance);
}

TEST(TransferModel, WritesWhatItReads) {
  const Volume volume = smallVolume();
  std::vector<std::string> texts{
      R"({"opacity": [[0.25, 0.1]]})",
      R"({"range": [-1.5, 3], "opacity": [[0, 0], [0.3, 0.333333], [1, 1]], "color": [[0.1, 1, 0.5, 0]],
          "unit_distance": 0.125})"};
  for (const auto& file : std::filesystem::directory_iterator(FREEVOXELS_TRANSFER_FUNCTIONS))
    if (file.path().extension() == ".json") texts.push_back(readBytes(file.path()));
  ASSERT_GT(texts.size(), 4u);
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    const std::string written = TransferModel::read(text, volume).json();
    EXPECT_EQ(written.find('\n'), std::string::npos);
    expectSame(fitted(parseTransferCurves("inline", written), volume), fitted(parseTransferCurves("inline", text), volume));
  }
}

TEST(TransferModel, ReadsFilesAndRefusesWhatTheProgramsRefuse) {
  const std::string file = FREEVOXELS_TRANSFER_FUNCTIONS "/cloud.json";
  const TransferModel model = TransferModel::read(file, smallVolume());
  expectSame(fitted(parseTransferCurves("inline", model.json()), smallVolume()), fitted(readTransferCurves(file), smallVolume()));
  EXPECT_THROW(TransferModel::read("nowhere.json", smallVolume()), Error);
  EXPECT_THROW(TransferModel::read(R"({"opacity": [[0, 2]]})", smallVolume()), Error);
}

TEST(TransferModel, ReadsPresetsWithTheirRangeForTheVolume) {
  const TransferModel bone = TransferModel::read("ct-bone", smallVolume()), map = TransferModel::read("viridis", smallVolume());
  EXPECT_EQ(bone.range, glm::dvec2(130.0, 1500.0));
  EXPECT_EQ(bone.unitDistance, 1.0);
  EXPECT_EQ(map.range, glm::dvec2(2.0, 6.0));
  EXPECT_NEAR(*map.unitDistance, 2.5 / 128.0, 1e-9);
}

TEST(TransferModel, IsLinearBetweenItsPointsAndConstantBeyond) {
  const TransferModel model{.opacity = {{0.25, 0.2}, {0.75, 0.6}},
                            .color = {{0.5, {1.0, 0.0, 0.0}}, {1.0, {0.0, 1.0, 0.0}}}};
  EXPECT_EQ(model.alphaAt(0.0), 0.2);
  EXPECT_DOUBLE_EQ(model.alphaAt(0.5), 0.4);
  EXPECT_EQ(model.alphaAt(1.0), 0.6);
  EXPECT_EQ(model.colorAt(0.1), glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(model.colorAt(0.75), glm::dvec3(0.5, 0.5, 0.0));
  EXPECT_EQ(TransferModel{}.colorAt(0.5), glm::dvec3(1.0));
}

TEST(TransferModel, PointsAreAddedInOrder) {
  TransferModel model;
  EXPECT_EQ(model.addOpacity(0.6, 0.3), 1u);
  EXPECT_EQ(model.addOpacity(0.2, 0.1234567), 1u);
  EXPECT_EQ(model.opacity[1].alpha, 0.12346);
  EXPECT_EQ(model.addOpacity(0.2003, 0.9), 1u) << "there is one already";
  EXPECT_EQ(model.opacity.size(), 4u);
  EXPECT_EQ(model.addColor(0.5), 0u);
  EXPECT_EQ(model.color[0].color, glm::dvec3(1.0)) << "the colour that is there";
  model.color[0].color = {0.5, 0.25, 0.0};
  EXPECT_EQ(model.addColor(0.9), 1u);
  EXPECT_EQ(model.color[1].color, glm::dvec3(0.5, 0.25, 0.0));
}

TEST(TransferModel, PointsStayBetweenTheirNeighbours) {
  TransferModel model{.opacity = {{0.0, 0.0}, {0.3, 0.5}, {0.6, 0.2}, {1.0, 1.0}},
                      .color = {{0.2, glm::dvec3(1.0)}, {0.8, glm::dvec3(0.0)}}};
  model.moveOpacity(1, 0.9, 1.7);
  EXPECT_DOUBLE_EQ(model.opacity[1].x, 0.599);
  EXPECT_EQ(model.opacity[1].alpha, 1.0);
  model.moveOpacity(2, -1.0, -1.0);
  EXPECT_DOUBLE_EQ(model.opacity[2].x, 0.6);
  EXPECT_EQ(model.opacity[2].alpha, 0.0);
  model.moveOpacity(0, 0.2, 0.4);
  EXPECT_EQ(model.opacity[0].x, 0.0) << "an end keeps its place";
  EXPECT_EQ(model.opacity[0].alpha, 0.4);
  model.moveColor(1, 0.1);
  EXPECT_DOUBLE_EQ(model.color[1].x, 0.201);
  model.moveColor(0, -5.0);
  EXPECT_EQ(model.color[0].x, 0.0);
  EXPECT_NO_THROW(fitted(parseTransferCurves("inline", model.json()), smallVolume()));
}

TEST(TransferModel, KeepsItsEndsAndAColour) {
  TransferModel model{.opacity = {{0.0, 0.0}, {0.5, 0.5}, {1.0, 1.0}},
                      .color = {{0.2, glm::dvec3(1.0)}, {0.8, glm::dvec3(0.0)}}};
  EXPECT_FALSE(model.removeOpacity(0));
  EXPECT_FALSE(model.removeOpacity(2));
  EXPECT_TRUE(model.removeOpacity(1));
  EXPECT_EQ(model.opacity.size(), 2u);
  EXPECT_TRUE(model.removeColor(0));
  EXPECT_FALSE(model.removeColor(0));
  EXPECT_EQ(model.color.size(), 1u);
}

TEST(TransferModel, OtherCurvesKeepRangeAndUnitDistance) {
  TransferModel model{.range = glm::dvec2(3.0, 4.0), .unitDistance = 0.5};
  model.takeCurves({.opacity = {{0.0, 1.0}}, .range = glm::dvec2(0.0, 1.0), .unitDistance = 9.0});
  EXPECT_EQ(model.opacity.size(), 1u);
  EXPECT_EQ(*model.range, glm::dvec2(3.0, 4.0));
  EXPECT_EQ(*model.unitDistance, 0.5);
}

TEST(TransferModel, TheWindowMovesWithinTheValues) {
  const ValueWindow all{0.0, 100.0}, half = movedWindow(all, all, {-50.0, 10.0});
  EXPECT_EQ(half, (ValueWindow{35.0, 85.0})) << "half as wide, about a higher level";
  const ValueWindow high = movedWindow(half, all, {0.0, 1000.0});
  EXPECT_EQ(high, (ValueWindow{75.0, 125.0})) << "the level is at most the largest value";
  const ValueWindow narrow = movedWindow(high, all, {-1000.0, 0.0});
  EXPECT_LT(narrow.low, narrow.high);
}

}  // namespace
}  // namespace freevoxels
