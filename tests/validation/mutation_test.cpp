// The checks are checked: every stage is broken on purpose, and the checks of that stage notice, and no
// others.

#include "engine/reference/reference_table.h"
#include "engine/validation/closed_forms.h"
#include "engine/validation/stage_checks.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/validation/stepped_stages.h"

namespace freevoxels::test {
namespace {

Classification thicker(Classification classification) {
  constexpr double kFactor = 1.001;
  classification.densityScale *= kFactor;
  if (classification.transferFunction) classification.transferFunction->unitDistance /= kFactor;
  return classification;
}

/// The table's plane for a lattice step, whichever set of directions the table holds.
int planeOf(const SteppedStages& stages, glm::ivec3 step) {
  const DirectionSet set = stages.steps.table.settings.directions;
  return directionIndex(set, int(set) * step);
}

void swapTwoPlanes(SteppedStages& stages) {
  const TableBytes table = stages.table();
  const int a = planeOf(stages, {1, 0, -1}), b = planeOf(stages, {0, 1, 1});
  stages.replacePlane(a, table[std::size_t(b)]);
  stages.replacePlane(b, table[std::size_t(a)]);
}

/// Eq. 5 with the voxel itself in the product.
void includeTheVoxelItself(SteppedStages& stages) {
  const std::vector<float> values = stages.extinction();
  const std::vector<double> extinction(values.begin(), values.end());
  const TableSettings& settings = stages.steps.table.settings;
  for (int d = 0; d < directionCount(settings.directions); ++d) {
    const double length = stepLength(stages.source.indexToWorld, directionAt(settings.directions, d),
                                     settings.pathLengthCorrection);
    const auto ahead = referenceOpticalDepth(stages.source, extinction, settings.directions, d,
                                             settings.pathLengthCorrection);
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < ahead.size(); ++i)
      bytes.push_back(std::uint8_t(encodeOpticalDepth(settings.code, ahead[i] + extinction[i] * length)));
    stages.replacePlane(d, bytes);
  }
}

/// By two codes, in the middle voxel.
void changeOneByte(SteppedStages& stages) {
  const int direction = planeOf(stages, {-1, 1, 0});
  std::vector<std::uint8_t> plane = stages.table()[std::size_t(direction)];
  std::uint8_t& byte = plane[plane.size() / 2];
  byte = std::uint8_t(byte < 128 ? byte + 2 : byte - 2);
  stages.replacePlane(direction, plane);
}

/// As a march that writes its planes in another order.
void rotateThePlanes(SteppedStages& stages) {
  stages.alterRays = [](RayCodes& codes) {
    for (std::vector<std::uint16_t>& fan : codes)
      if (!fan.empty()) std::ranges::rotate(fan, fan.begin() + std::ptrdiff_t(fan.size() / 2));
  };
}

void readTheOtherCode(SteppedStages& stages) {
  AttenuationCode& code = stages.steps.table.settings.code;
  code = code == AttenuationCode::Depth8 ? AttenuationCode::Linear8 : AttenuationCode::Depth8;
}

void eraseMiddle(std::vector<std::uint32_t>& voxels) {
  if (!voxels.empty()) voxels.erase(voxels.begin() + std::ptrdiff_t(voxels.size() / 2));
}

void dropOneSplat(SteppedStages& stages) {
  eraseMiddle(stages.drawn);
}

void forgetOneVisibleVoxel(SteppedStages& stages) {
  eraseMiddle(stages.listed);
  eraseMiddle(stages.drawn);
}

/// Colours are left as they are summed where they should be normalised.
void resolveWithoutNormalising(SteppedStages& stages) {
  stages.resolve = [](const std::vector<SplatSums>& sums, const FrameSettings& settings) {
    Image image = referenceResolve(sums, settings);
    for (std::size_t i = 0; i < sums.size(); ++i)
      image.pixels[i] = glm::vec4(glm::vec3(sums[i].color), image.pixels[i].a);
    return image;
  };
}

struct StageDefect {
  const char* name;
  const char* stage;  ///< with which the names of the checks begin that must notice
  void (*apply)(SteppedStages&) = nullptr;
  Classification (*classification)(Classification) = nullptr;
  const char* stageAfter = stage;  ///< which did not see it, and so does not agree with the reference
};

void PrintTo(const StageDefect& defect, std::ostream* stream) {
  *stream << defect.name;
}

constexpr StageDefect kStageDefects[] = {
    {"ExtinctionOffByAFactor", "classify", nullptr, thicker},
    {"TwoDirectionsSwapped", "table", swapTwoPlanes},
    {"ProductInclusive", "table", includeTheVoxelItself},
    {"OneByteOfTheTable", "table", changeOneByte},
    {"RaysOfOtherPlanes", "rays", rotateThePlanes, nullptr, "splat sums"},
    {"AVisibleVoxelForgotten", "visible voxels", forgetOneVisibleVoxel},
    {"TheOtherCodeRead", "splat sums", readTheOtherCode},
    {"ASplatDropped", "splat sums", dropOneSplat},
    {"ColoursNotNormalised", "resolve", resolveWithoutNormalising},
};

class Mutation : public DeviceTest, public testing::WithParamInterface<StageDefect> {
 protected:
  static StageMaker stages(const StageDefect& defect) {
    return [defect](const Volume& volume, const Classification& classification, const TableSettings& table) {
      auto made = std::make_unique<SteppedStages>(
          device(), volume, defect.classification ? defect.classification(classification) : classification,
          table);
      if (defect.apply) defect.apply(*made);
      return made;
    };
  }
  static ValidationScene scene(SceneColor color) {
    const glm::ivec3 size(13, 10, 9);
    return makeValidationScene(randomVolume(size, shearedTransform(size), 0.6, 1.0), color, 100);
  }
  static std::vector<Check> failedChecks(const ReportSection& section) {
    std::vector<Check> failed;
    std::ranges::copy_if(section.checks, std::back_inserter(failed),
                         [](const Check& check) { return !check.passed(); });
    return failed;
  }
  static constexpr glm::ivec2 kFrame{40, 32};
  static constexpr int kCubeEdge = 32;
};

TEST_P(Mutation, IsNoticedByTheChecksOfItsStageAndNoOthers) {
  const auto failed =
      failedChecks(stageChecks(stages(GetParam()), scene(SceneColor::TransferFunction), kFrame));
  EXPECT_TRUE(std::ranges::any_of(
      failed, [](const Check& check) { return check.name.starts_with(GetParam().stage); }));
  for (const Check& check : failed) {
    EXPECT_TRUE(check.name.starts_with(GetParam().stage) || check.name.starts_with(GetParam().stageAfter))
        << check.name << " failed at " << check.where;
    EXPECT_NE(check.where, "") << check.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Mutation, testing::ValuesIn(kStageDefects), [](const auto& defect) { return std::string(defect.param.name); });

using MutationTest = Mutation;

TEST_F(MutationTest, ClosedFormsNoticeWhatIsWrongInEveryVoxel) {
  for (const StageDefect& defect : {StageDefect{"", "", includeTheVoxelItself}, StageDefect{"", "", readTheOtherCode}})
    EXPECT_FALSE(closedForms(stages(defect), kCubeEdge).passed());
}

TEST_F(MutationTest, WithoutOneEverythingPasses) {
  std::vector<Check> checks = closedForms(stages({}), kCubeEdge).checks;
  for (const StageMaker& make : {stages({}), deviceStages(device())})
    std::ranges::copy(stageChecks(make, scene(SceneColor::TransferFunction), kFrame).checks,
                      std::back_inserter(checks));
  for (const Check& check : checks)
    EXPECT_TRUE(check.passed()) << check.name << ": " << check.figure << " at " << check.where;
}

TEST_F(MutationTest, AWrongByteIsFoundWhereItIs) {
  const auto failed =
      failedChecks(stageChecks(stages({"", "", changeOneByte}), scene(SceneColor::Density), kFrame));
  ASSERT_EQ(failed.size(), 5u);  // a table for each of the five settings
  for (const Check& check : failed) {
    EXPECT_EQ(check.figure, 2.0);
    EXPECT_EQ(check.where, "direction (-1, 1, 0), voxel (0, 5, 4)");
  }
}

}  // namespace
}  // namespace freevoxels::test
