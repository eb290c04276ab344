// Image quality: what is read off the figures, and that stages broken on purpose are noticed.

#include "engine/validation/quality.h"
#include "engine/validation/quality_images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/reference/oracle.h"
#include "engine/volume/procedural.h"
#include "engine/volume/transfer_source.h"
#include "tests/not_finite.h"

namespace freevoxels {
namespace {

using test::kInfinity;
using test::kNan;

std::vector<QualityMethod> madeUpMethods() {
  return {{.name = "first",
           .table = {},
           .frame = {},
           .order = ClassificationOrder::Post,
           .goals = {.mean = 40.0, .least = 31.0, .leastThin = 25.0, .notBelowSorted = true}},
          {.name = "sorted",
           .table = {},
           .frame = {.method = SplatSettings{.composite = Composite::Sorted}},
           .order = ClassificationOrder::Post,
           .goals = {}}};
}

QualityFigures madeUpFigures() {
  return {.scene = "head at 8^3",
          .thin = false,
          .hasGoals = true,
          .views = {{0, 0}, {90, 0}, {300, 15, 100}},
          .figures = {{{50.0, 0.1}, {30.0, 0.2}, {46.0, 0.6}}, {{48.0, 0.1}, {29.0, 0.1}, {47.5, 0.1}}}};
}

TEST(QualityFigures, MeanLeastAndWhere) {
  const QualityFigures scene = madeUpFigures();
  const auto methods = madeUpMethods();
  EXPECT_DOUBLE_EQ(scene.meanPsnr(0), 42.0);
  EXPECT_DOUBLE_EQ(scene.meanFlip(0), 0.3);
  EXPECT_EQ(scene.worstView(0), 1u);
  const ReportTable table = methodTable(scene, methods);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"first", "42.0", "30.0", "(90, 0)", "0.3000"}));
  const ReportTable views = viewTable(scene, methods);
  EXPECT_EQ(views.columns, (std::vector<std::string>{"view", "first", "sorted"}));
  ASSERT_EQ(views.rows.size(), 3u);
  EXPECT_EQ(views.rows[2], (std::vector<std::string>{"(300, 15), 100° wide", "46.0", "47.5"}));
}

TEST(QualityFigures, GoalsOfAScene) {
  QualityFigures scene = madeUpFigures();
  auto methods = madeUpMethods();
  std::vector<Check> checks = sceneChecks(scene, methods);
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_DOUBLE_EQ(checks[0].figure, 30.0);
  EXPECT_DOUBLE_EQ(checks[0].tolerance, 31.0);
  EXPECT_EQ(checks[0].where, "(90, 0)");
  EXPECT_FALSE(checks[0].passed());
  EXPECT_DOUBLE_EQ(checks[1].figure, -1.5);
  EXPECT_EQ(checks[1].where, "(300, 15), 100° wide");
  EXPECT_FALSE(checks[1].passed());
  scene.thin = true;
  checks = sceneChecks(scene, methods);
  EXPECT_DOUBLE_EQ(checks[0].tolerance, 25.0);
  EXPECT_TRUE(checks[0].passed());
  scene.resolution = 65;
  methods[0].goals.thinResolution = 64;
  EXPECT_EQ(sceneChecks(scene, methods).size(), 1u);
  scene.hasGoals = false;
  EXPECT_TRUE(sceneChecks(scene, methods).empty());
}

TEST(QualityFigures, SummaryTakesTheMeanOverAllViewsOfScenesWithGoals) {
  const auto methods = madeUpMethods();
  QualityFigures one = madeUpFigures(), two = madeUpFigures(), small = madeUpFigures();
  two.figures[0] = {{32.0, 0.0}, {33.0, 0.0}, {34.0, 0.0}};
  small.figures[0] = {{1.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}};
  small.hasGoals = false;
  const ReportSection section = summariseQuality({one, two, small}, methods);
  ASSERT_EQ(section.checks.size(), 1u);
  EXPECT_DOUBLE_EQ(section.checks[0].figure, 37.5);
  EXPECT_FALSE(section.checks[0].passed());
  ASSERT_EQ(section.tables.size(), 1u);
  EXPECT_EQ(section.tables[0].columns.size(), 5u);
  EXPECT_EQ(section.tables[0].rows[0][1], "30.0–50.0");
  EXPECT_EQ(section.tables[0].rows[0][4], "25.3");
  EXPECT_TRUE(summariseQuality({small}, methods).checks.empty());
}

TEST(QualityFigures, JumpsOfASeries) {
  const auto jump = [](std::vector<double> values) {
    std::vector<glm::dvec2> series;
    for (const double value : values) series.emplace_back(10.0 * double(series.size()), value);
    return largestJump(series, 1.0, "jump");
  };
  EXPECT_TRUE(jump({40.0, 40.9, 41.8, 42.7}).passed());  // the ends are no neighbours
  const Check inside = jump({40.0, 40.5, 39.0, 39.5});
  EXPECT_FALSE(inside.passed());
  EXPECT_DOUBLE_EQ(inside.figure, 1.5);
  EXPECT_EQ(inside.where, "after azimuth 10");
  const Check last = jump({40.0, 40.9, 41.8, 44.5});
  EXPECT_NEAR(last.figure, 2.7, 1e-12);
  EXPECT_EQ(last.where, "after azimuth 20");
  EXPECT_FALSE(jump({40.0, kNan, 40.0, 40.0}).passed());
}

TEST(QualityFigures, AImageAgainstItselfAndAnother) {
  const Image black{.size = {8, 8}, .pixels = std::vector(64, glm::vec4(0.0f)), .depth = {}};
  const Image grey{.size = {8, 8}, .pixels = std::vector(64, glm::vec4(0.1f)), .depth = {}};
  EXPECT_EQ(compareToOracle(grey, grey).psnr, kInfinity);
  EXPECT_EQ(compareToOracle(grey, grey).flip, 0.0);
  EXPECT_NEAR(compareToOracle(grey, black).psnr, 20.0, 1e-5);
  EXPECT_GT(compareToOracle(grey, black).flip, 0.0);
}

TEST(QualityMethods, TheFirstIsTheDefaultAndOneIsSorted) {
  const auto& methods = qualityMethods();
  EXPECT_TRUE(methods.front().frame.gathers());
  EXPECT_TRUE(methods.at(sortedMethod(methods)).frame.isSorted());
}

TEST(QualityScenes, TransferFunctionsAreThoseOfTheFiles) {
  const Volume volume = makeProcedural("cloud", 16);
  for (const auto& [color, file] :
       {std::pair(QualityColor::Bone, "bone.json"), {QualityColor::Cloud, "cloud.json"}}) {
    const TransferFunction ours = qualityTransferFunction(color, volume);
    const TransferFunction read = fitted(readTransferCurves(std::string(FREEVOXELS_TRANSFER_FUNCTIONS "/") + file), volume);
    EXPECT_EQ(ours.unitDistance, read.unitDistance);
    ASSERT_EQ(ours.opacity.size(), read.opacity.size()) << file;
    for (std::size_t i = 0; i < read.opacity.size(); ++i) {
      EXPECT_NEAR(ours.opacity[i].scalar, read.opacity[i].scalar, 1e-6) << file << i;
      EXPECT_EQ(ours.opacity[i].opacity, read.opacity[i].opacity) << file << i;
    }
    ASSERT_EQ(ours.color.size(), read.color.size()) << file;
    for (std::size_t i = 0; i < read.color.size(); ++i) {
      EXPECT_NEAR(ours.color[i].scalar, read.color[i].scalar, 1e-6) << file << i;
      EXPECT_EQ(ours.color[i].color, read.color[i].color) << file << i;
    }
  }
}

/// Draws what the oracle does, changed by `change`, which is told how many images came before.
struct OracleStages : StageOutputs {
  using Change = std::function<void(Image&, const FrameSettings&, int)>;
  Volume volume;
  Classification classification;
  Change change;
  int images = 0;

  std::vector<float> extinction() override { return {}; }
  std::vector<glm::dvec3> emission() override { return {}; }
  TableBytes table() override { return {}; }
  std::vector<std::uint32_t> visibleVoxels() override { return {}; }
  RayCodes rays(const RaySource&) override { return {}; }
  std::vector<SplatSums> sums(const Camera&, const FrameSettings&) override { return {}; }
  Image image(const Camera& camera, const FrameSettings& settings) override {
    Image image =
        renderOracle(volume, classification, camera, {.size = settings.size, .tolerance = kQualityTolerance})
            .image;
    change(image, settings, images++);
    return image;
  }
};

StageMaker oracleStages(const OracleStages::Change& change) {
  return [change](const Volume& volume, const Classification& classification, const TableSettings&) {
    auto stages = std::make_unique<OracleStages>();
    stages->volume = volume;
    stages->classification = classification;
    stages->change = change;
    return stages;
  };
}

void brighten(Image& image, float by) {
  for (glm::vec4& pixel : image.pixels) pixel += glm::vec4(by);
}

QualityScene tinyScene() {
  return makeQualityScene(kQualitySubjects[1], 8, makeProcedural("shells", 8));
}

TEST(ImageQuality, ComparesEachMethodWithTheOracleInEachView) {
  const auto make = oracleStages([](Image& image, const FrameSettings& settings, int before) {
    if (settings.isSorted()) brighten(image, before == 1 ? 0.1f : 0.01f);
  });
  const auto [section, figures] =
      imageQuality(make, tinyScene(), madeUpMethods(), {.views = quickQualityViews(), .imageEdge = 12, .hasGoals = true});
  ASSERT_EQ(figures.figures.size(), 2u);
  ASSERT_EQ(figures.figures[0].size(), 3u);
  for (const ImageFigures& figure : figures.figures[0]) EXPECT_EQ(figure.psnr, kInfinity);
  EXPECT_NEAR(figures.figures[1][0].psnr, 40.0, 1e-3);
  EXPECT_NEAR(figures.figures[1][1].psnr, 20.0, 1e-3);
  EXPECT_EQ(figures.worstView(1), 1u);
  EXPECT_EQ(section.checks.size(), 2u);
  EXPECT_TRUE(section.passed());
  ASSERT_EQ(section.imageRows.size(), 1u);
  EXPECT_EQ(section.imageRows[0].images.size(), 5u);
}

TEST(ImageQuality, NoticesAImageThatIsOff) {
  const auto make = oracleStages([](Image& image, const FrameSettings& settings, int before) {
    if (settings.isNormalised() && before == 2) brighten(image, 0.05f);
  });
  const ReportSection section =
      imageQuality(make, tinyScene(), madeUpMethods(), {.views = quickQualityViews(), .imageEdge = 12, .hasGoals = true}).section;
  EXPECT_EQ(section.failures(), 2u);  // too low, and below sorted blending
  for (const Check& check : section.checks) EXPECT_EQ(check.where, viewText(quickQualityViews()[2]));
}

TEST(ImageQuality, NoticesAFrameOfATurntableThatPops) {
  const auto make = [](float third) {
    return oracleStages([third](Image& image, const FrameSettings&, int before) {
      brighten(image, before == 2 ? third : 0.01f);
    });
  };
  EXPECT_TRUE(turntableQuality(make(0.0104f), tinyScene(), 4, 12).passed());
  const ReportSection popping = turntableQuality(make(0.015f), tinyScene(), 4, 12);
  ASSERT_EQ(popping.failures(), 1u);
  EXPECT_NEAR(popping.checks[0].figure, 0.005, 1e-5);
  ASSERT_EQ(popping.plots.size(), 1u);
  ASSERT_EQ(popping.plots[0].series.size(), 2u);  // default, sorted
  EXPECT_EQ(popping.plots[0].series[0].points.size(), 5u);
  EXPECT_EQ(popping.plots[0].series[0].points[2].x, 45.0);
}

}  // namespace
}  // namespace freevoxels
