// The checks of the gather are checked: every stage is broken on purpose, and the checks of that stage notice, and no others.

#include <bit>
#include <utility>

#include "engine/validation/gather_checks.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/validation/stepped_gather.h"

namespace freevoxels::test {
namespace {

/// Rays begin at the volume's second slice.
void skipTheFirstSlice(SteppedGather& gather) {
  gather.alterSamples = [](shader::GatherFrame& frame) {
    for (shader::GatherAxis& axis : frame.axes) {
      ++axis.slices[1][frame.finest].x;
      --axis.slices[0][frame.finest].y;
    }
  };
}

/// The slice in front of the border between two levels is in both.
void countALevelsBorderTwice(SteppedGather& gather) {
  gather.alterSamples = [](shader::GatherFrame& frame) {
    for (shader::GatherAxis& axis : frame.axes)
      for (int level = frame.finest + 1; level <= frame.coarsest; ++level) {
        if (axis.slices[1][level].x > 0) --axis.slices[1][level].x;
        ++axis.slices[0][level].y;
      }
  };
}

/// Swaps the two neighbours of a sample along the first side, inside the volume.
void swapWeights(SteppedGather& gather) {
  gather.alterQuads = [](const Device& device, const GatherVolume::Quads& quads) {
    const Buffer& buffer = quads.medium.pieces.front();
    std::vector<std::uint32_t> pairs(buffer.bytes() / sizeof(std::uint32_t));
    download(device, buffer, std::as_writable_bytes(std::span(pairs)));
    for (std::uint32_t& pair : pairs)
      if ((pair & 0xffffu) != 0 && pair >> 16 != 0) pair = std::rotl(pair, 16);
    upload(device, buffer, std::as_bytes(std::span(pairs)));
  };
}

void endRaysTooEarly(SteppedGather& gather) {
  gather.alterSamples = [](shader::GatherFrame& frame) { frame.endTransmittance *= 1.2f; };
}

/// What the gather keeps of a voxel is made from another extinction.
void shadeThickerBlocks(SteppedGather& gather) {
  gather.alterMedium = [altered = false](const Device& device, BuiltVolume& built) mutable {
    if (std::exchange(altered, true) || !built.hasBlocks()) return;
    std::vector<float> extinction(built.volume.extinction.bytes() / sizeof(float));
    download(device, built.volume.extinction, std::as_writable_bytes(std::span(extinction)));
    for (float& value : extinction) value *= 1.01f;
    upload(device, built.volume.extinction, std::as_bytes(std::span(extinction)));
  };
}

/// As if slices were seen from straight in front.
void leaveTheStencilOut(SteppedGather& gather) {
  gather.alterStencil = [](shader::GatherFrame& frame) {
    for (shader::GatherAxis& axis : frame.axes) axis.tilt = glm::vec2(axis.tiltDepth = 0.0f);
  };
}

void interpolateBetweenRougherSamples(SteppedGather& gather) {
  gather.alterSamples = [](shader::GatherFrame& frame) { frame.sampleTolerance *= 1.5f; };
}

/// Slopes of distances that are interpolated well are rough.
void marchBetweenSmoothDistances(SteppedGather& gather) {
  gather.alterSamples = [](shader::GatherFrame& frame) { frame.distanceTolerance *= 0.1f; };
}

void widenTheLattice(SteppedGather& gather) {
  gather.alterResampling = [](shader::GatherFrame& frame) { frame.pitch *= 1.01f; };
}

struct GatherDefect {
  const char* name;
  const char* stage;  ///< with which the names of the checks begin that must notice
  void (*apply)(SteppedGather&) = nullptr;
};

void PrintTo(const GatherDefect& defect, std::ostream* stream) {
  *stream << defect.name;
}

constexpr GatherDefect kGatherDefects[] = {
    {"ASliceSkipped", "gather samples", skipTheFirstSlice},
    {"ALevelsBorderCountedTwice", "gather samples", countALevelsBorderTwice},
    {"WeightsSwapped", "gather samples", swapWeights},
    {"RaysEndTooEarly", "gather samples", endRaysTooEarly},
    {"BlocksThicker", "gather blocks", shadeThickerBlocks},
    {"StencilLeftOut", "gather stencil", leaveTheStencilOut},
    {"LatticeWider", "gather image", widenTheLattice},
    {"RougherInterpolated", "gather refinement", interpolateBetweenRougherSamples},
    {"SmoothDistancesMarched", "gather refinement", marchBetweenSmoothDistances},
};

class GatherMutation : public DeviceTest, public testing::WithParamInterface<GatherDefect> {
 protected:
  static GatherMaker outputs(const GatherDefect& defect) {
    return [defect](const Volume& volume, const Classification& classification) {
      auto made = std::make_unique<SteppedGather>(device(), volume, classification);
      if (defect.apply) defect.apply(*made);
      return made;
    };
  }
  static ReportSection checks(const GatherMaker& make, SceneColor color) {
    const glm::ivec3 size(13, 10, 9);
    const Volume volume = randomVolume(size, shearedTransform(size), 0.6, 1.0);
    return gatherChecks(make, makeValidationScene(volume, color, 100), {28, 22});
  }
};

TEST_P(GatherMutation, IsNoticedByTheChecksOfItsStageAndNoOthers) {
  int noticed = 0;
  for (const Check& check : checks(outputs(GetParam()), SceneColor::TransferFunction).checks) {
    if (check.passed()) continue;
    ++noticed;
    EXPECT_TRUE(check.name.starts_with(GetParam().stage)) << check.name << " failed at " << check.where;
    EXPECT_NE(check.where, "") << check.name;
  }
  EXPECT_GT(noticed, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, GatherMutation, testing::ValuesIn(kGatherDefects),
                         [](const auto& defect) { return std::string(defect.param.name); });

using GatherMutationTest = GatherMutation;

TEST_F(GatherMutationTest, WithoutOneEverythingPasses) {
  for (const GatherMaker& make : {outputs({}), deviceGather(device())})
    for (const SceneColor color : {SceneColor::TransferFunction, SceneColor::Density})
      for (const Check& check : checks(make, color).checks)
        EXPECT_TRUE(check.passed()) << check.name << ": " << check.figure << " at " << check.where;
}

/// Draws frames with other lights than it is told.
class OtherLight : public GatherOutputs {
 public:
  OtherLight(std::unique_ptr<GatherOutputs> made, void (*alter)(Lighting&)) : made_(std::move(made)), alter_(alter) {}
  GatherStages frame(const Camera& camera, const FrameSettings& wanted) override {
    FrameSettings settings = wanted;
    if (alter_ != nullptr) alter_(*settings.lighting);
    return made_->frame(camera, settings);
  }

 private:
  std::unique_ptr<GatherOutputs> made_;
  void (*alter_)(Lighting&);
};

struct LightDefect {
  const char* name;
  void (*apply)(Lighting&);
  ReportSection (*checks)(const GatherMaker&, glm::ivec2) = gatherLightChecks;
};

void PrintTo(const LightDefect& defect, std::ostream* stream) {
  *stream << defect.name;
}

constexpr LightDefect kLightDefects[] = {
    {"None", nullptr},
    {"NoneOfScalars", nullptr, gatherScalarLightChecks},
    {"NoneOfAllOrders", nullptr, gatherScatteringChecks},
    {"LightElsewhere", [](Lighting& l) { l.lights[0].place.x += 0.1; }},
    {"LightBrighter", [](Lighting& l) { l.lights[0].intensity *= 1.02; }},
    {"TintStronger", [](Lighting& l) { l.tint.r *= 1.05; }},
    {"PhaseNarrower", [](Lighting& l) { l.phaseG *= 1.1; }},
    {"AmbientBrighter", [](Lighting& l) { l.ambient *= 1.1; }, gatherScatteringChecks},
    {"FewerOrders", [](Lighting& l) { l.scattering = 3; }, gatherScatteringChecks},
};

class GatherLightMutation : public DeviceTest, public testing::WithParamInterface<LightDefect> {};

TEST_P(GatherLightMutation, IsNoticed) {
  const GatherMaker make = [](const Volume& volume, const Classification& classification) {
    return std::make_unique<OtherLight>(deviceGather(device())(volume, classification), GetParam().apply);
  };
  int noticed = 0;
  for (const Check& check : GetParam().checks(make, {16, 12}).checks) {
    if (check.passed()) continue;
    ++noticed;
    EXPECT_NE(GetParam().apply, nullptr) << check.name << ": " << check.figure << " at " << check.where;
  }
  EXPECT_EQ(noticed > 0, GetParam().apply != nullptr);
}

INSTANTIATE_TEST_SUITE_P(Of, GatherLightMutation, testing::ValuesIn(kLightDefects),
                         [](const auto& defect) { return std::string(defect.param.name); });

using GatherSurfaceMutation = DeviceTest;

TEST_F(GatherSurfaceMutation, IsNoticedInTheImage) {
  const GatherMaker make = [](const Volume& volume, const Classification& classification) {
    return std::make_unique<OtherLight>(deviceGather(device())(volume, classification), [](Lighting& l) { l.surface *= 0.9; });
  };
  for (const Check& check : gatherSurfaceChecks(make).checks)
    EXPECT_EQ(check.passed(), check.name.starts_with("gather surfaces: gradients")) << check.name << ": " << check.figure;
}

/// Says that blocks emit more than what is drawn.
class OtherEmission : public GatherOutputs {
 public:
  OtherEmission(std::unique_ptr<GatherOutputs> made, double factor) : made_(std::move(made)), factor_(factor) {}
  GatherStages frame(const Camera& camera, const FrameSettings& settings) override {
    GatherStages stages = made_->frame(camera, settings);
    for (GatherBlocks& blocks : stages.blocks)
      for (glm::dvec3& emission : blocks.emission) emission *= factor_;
    return stages;
  }

 private:
  std::unique_ptr<GatherOutputs> made_;
  double factor_;
};

using GatherEmissionMutation = DeviceTest;

TEST_F(GatherEmissionMutation, IsNoticedByTheChecksOfBlocks) {
  for (const double factor : {1.0, 1.02}) {
    const GatherMaker make = [factor](const Volume& volume, const Classification& classification) {
      return std::make_unique<OtherEmission>(deviceGather(device())(volume, classification), factor);
    };
    int ofBlocks = 0;
    for (const Check& check : gatherEmissionChecks(make, {24, 20}).checks) {
      if (check.passed()) continue;
      if (check.name.starts_with("gather blocks: emission"))
        ++ofBlocks;
      else
        ADD_FAILURE() << check.name << ": " << check.figure << " at " << check.where;
    }
    EXPECT_EQ(ofBlocks, factor == 1.0 ? 0 : 2);
  }
}

}  // namespace
}  // namespace freevoxels::test
