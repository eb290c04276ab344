// The paper's figures, drawn by the device, and that a device which draws something else is noticed.

#include "engine/validation/lattice_steps.h"
#include "engine/validation/paper_figures.h"

#include "engine/validation/leakage.h"
#include "tests/device/device_fixture.h"

namespace freevoxels {
namespace {

class PaperFigures : public DeviceTest {};

/// The device's outcome but for a table with two directions swapped and one composite drawn for another.
struct WrongStages : StageOutputs {
  std::unique_ptr<StageOutputs> right;
  Composite asked, drawn;

  std::vector<float> extinction() override { return right->extinction(); }
  std::vector<glm::dvec3> emission() override { return right->emission(); }
  TableBytes table() override {
    TableBytes bytes = right->table();
    std::swap(bytes[std::size_t(directionIndex(kLatticeSteps, {1, 0, 0}))],
              bytes[std::size_t(directionIndex(kLatticeSteps, {0, 1, 0}))]);
    return bytes;
  }
  std::vector<std::uint32_t> visibleVoxels() override { return right->visibleVoxels(); }
  RayCodes rays(const RaySource& source) override { return right->rays(source); }
  std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) override {
    std::vector<SplatSums> sums = right->sums(camera, settings);
    for (SplatSums& s : sums) s.depth *= 0.99f;
    return sums;
  }
  Image image(const Camera& camera, const FrameSettings& settings) override {
    FrameSettings changed = settings;
    if (changed.splats().composite == asked) changed.splats().composite = drawn;
    return right->image(camera, changed);
  }
};

StageMaker wrongStages(const Device& device, Composite asked, Composite drawn) {
  return [=, make = deviceStages(device)](const Volume& volume, const Classification& classification,
                                          const TableSettings& table) {
    auto stages = std::make_unique<WrongStages>();
    stages->right = make(volume, classification, table);
    stages->asked = asked;
    stages->drawn = drawn;
    return stages;
  };
}

TEST_F(PaperFigures, Figure2ShowsTheTable) {
  const ReportSection section = paperFigure2(deviceStages(device()));
  EXPECT_EQ(section.checks.size(), 3u);
  EXPECT_TRUE(section.passed());
  const ReportSection wrong =
      paperFigure2(wrongStages(device(), Composite::Normalised, Composite::Normalised));
  EXPECT_EQ(wrong.failures(), 1u);
  EXPECT_FALSE(wrong.checks[0].passed());
}

TEST_F(PaperFigures, Figure6ShowsTheLeak) {
  const ReportSection section = paperFigure6(deviceStages(device()));
  EXPECT_EQ(section.checks.size(), 2u);
  EXPECT_TRUE(section.passed());
  for (const Check& check : section.checks) EXPECT_LT(check.figure, 0.2) << check.name;
  const ReportSection wrong = paperFigure6(wrongStages(device(), Composite::Normalised, Composite::Additive));
  EXPECT_GT(wrong.checks[0].figure, 2.0 * section.checks[0].figure);
}

/// That it passes is part of ValidateCommand's test: the oracle takes its time.
TEST_F(PaperFigures, Figure7NoticesWhatTheOracleDoesNotShow) {
  const ReportSection wrong = paperFigure7(wrongStages(device(), Composite::Normalised, Composite::Additive));
  ASSERT_EQ(wrong.checks.size(), 2u);
  EXPECT_FALSE(wrong.checks[0].passed());
}

TEST_F(PaperFigures, LeakageFollowsEquation9) {
  const LayerStacks stacks{.opacities = {0.3, 0.9}, .layers = {1, 3}};
  const ReportSection section = leakageOfLayers(deviceStages(device()), stacks);
  EXPECT_EQ(section.checks.size(), 2u);
  EXPECT_TRUE(section.passed());
  ASSERT_EQ(section.tables.size(), 1u);
  EXPECT_EQ(section.tables[0].rows.size(), 4u);
  EXPECT_EQ(section.plots.at(0).series.size(), 3u);
  const ReportSection wrong =
      leakageOfLayers(wrongStages(device(), Composite::Sorted, Composite::Normalised), stacks);
  EXPECT_EQ(wrong.failures(), 2u);
}

}  // namespace
}  // namespace freevoxels
