// A small flight through the cloud on the device, and one that pops.

#include "engine/validation/fly_through_quality.h"

#include <memory>
#include <utility>

#include "engine/scene/camera.h"
#include "engine/volume/procedural.h"
#include "tests/device/device_fixture.h"

namespace freevoxels {
namespace {

using FlyThroughQualityTest = DeviceTest;

QualityScene smallCloud() {
  const QualitySubject cloud{"cloud", QualityColor::Cloud, false};
  QualityScene scene = makeQualityScene(cloud, 24, makeProcedural("cloud", 24));
  scene.classification.transferFunction->unitDistance =
      scene.volume.voxelSize();  // a voxel as thin as a large volume's
  return scene;
}

/// Images of an eye inside the volume lack what is opaque by a quarter.
class Popping : public StageOutputs {
 public:
  Popping(std::unique_ptr<StageOutputs> whole, const Volume& volume)
      : whole_(std::move(whole)), dimensions_(volume.dimensions), indexToWorld_(volume.indexToWorld) {}
  std::vector<float> extinction() override { return whole_->extinction(); }
  std::vector<glm::dvec3> emission() override { return whole_->emission(); }
  TableBytes table() override { return whole_->table(); }
  std::vector<std::uint32_t> visibleVoxels() override { return whole_->visibleVoxels(); }
  RayCodes rays(const RaySource& source) override { return whole_->rays(source); }
  std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) override {
    return whole_->sums(camera, settings);
  }
  Image image(const Camera& camera, const FrameSettings& settings) override {
    Image image = whole_->image(camera, settings);
    if (eyeIsInside(camera, dimensions_, indexToWorld_))
      for (glm::vec4& pixel : image.pixels) pixel *= 0.75f;
    return image;
  }

 private:
  std::unique_ptr<StageOutputs> whole_;
  glm::ivec3 dimensions_;
  glm::dmat4 indexToWorld_;
};

TEST_F(FlyThroughQualityTest, TheDevicesFramesPassAndAPopIsFound) {
  const QualityScene scene = smallCloud();
  const StageMaker whole = deviceStages(device());
  const ReportSection good = flyThroughQuality(whole, scene, 7, 24);
  ASSERT_EQ(good.checks.size(), 2u);
  EXPECT_TRUE(good.passed()) << good.checks[0].figure << " " << good.checks[1].figure;
  EXPECT_EQ(good.plots.size(), 2u);
  const ReportSection bad = flyThroughQuality(
      [&](const Volume& volume, const Classification& classification, const TableSettings& table) {
        return std::make_unique<Popping>(whole(volume, classification, table), volume);
      },
      scene, 7, 24);
  EXPECT_EQ(bad.failures(), 2u);
}

}  // namespace
}  // namespace freevoxels
