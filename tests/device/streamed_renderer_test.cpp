// Baked volumes that are drawn cube by cube: the image is the one that is gathered with the whole volume in memory, and has the same bits
// with every memory limit.

#include "engine/streamed_renderer.h"

#include "engine/renderer.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using fvx::FvxFile;

class StreamedRendererTest : public DeviceTest {
 protected:
  std::shared_ptr<const FvxFile> bake(const Volume& volume, const Classification& classification, bool keepScalars = true) const {
    bakeVolume(folder_ / "a.fvx", volume, classification, {.keepScalars = keepScalars});
    return std::make_shared<const FvxFile>(folder_ / "a.fvx");
  }

  static FrameSettings litSettings(std::vector<Light> lights) {
    FrameSettings settings{.size = {96, 80}, .draw = Draw::Gather, .depth = true};
    settings.lighting = Lighting{.lights = std::move(lights), .ambient = glm::dvec3(0.2, 0.3, 0.4), .attenuation = LightAttenuation::Exact};
    return settings;
  }

  /// PSNR against the whole volume.
  double compare(const Volume& volume, const Classification& classification, const Camera& camera, const FrameSettings& settings) const {
    const Image expected = Renderer(device(), volume, classification, {}).render(camera, settings);
    const Image image = StreamedRenderer(device(), bake(volume, classification), 0, classification, {}).render(camera, settings);
    EXPECT_EQ(image.depth.size(), expected.depth.size());
    return psnr(image, expected);
  }

  const test::TemporaryFolder folder_;
};

TEST_F(StreamedRendererTest, DensitiesWithLightsAreTheImageOfTheWholeVolume) {
  // The last cubes are narrower than their surroundings; one light is inside the box.
  const Volume volume = randomVolume({73, 66, 43}, shearedTransform({73, 66, 43}), 0.5, 3.0);
  const Classification classification{.densityScale = 0.1};
  const glm::dvec3 middle = volume.indexToWorld * glm::dvec4(36.0, 33.0, 21.0, 1.0);
  const FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}, {.place = middle, .atInfinity = false, .intensity = 2.0}});
  EXPECT_GT(compare(volume, classification, framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 90.0);
  EXPECT_GT(compare(volume, classification, framingCamera(volume, 200.0, -60.0, 1.2, {.orthographic = true}), settings), 90.0);
}

TEST_F(StreamedRendererTest, SurfacesOfATransferFunctionAreTheImageOfTheWholeVolume) {
  const Volume volume = makeProcedural("head", 80);
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.lighting->surface = 0.8;
  settings.lighting->phaseG = 0.3;
  settings.lod = 0.0f;
  EXPECT_GT(compare(volume, coloured(volume), framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 60.0);
}

TEST_F(StreamedRendererTest, AnEyeInsideTheBoxSeesTheImageOfTheWholeVolume) {
  const Volume volume = makeProcedural("cloud", 100);
  Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  camera.position = glm::mix(camera.position, camera.lookAt, 0.9);
  FrameSettings settings = litSettings({});
  settings.lighting.reset();
  EXPECT_GT(compare(volume, {.densityScale = 8.0}, camera, settings), 90.0);
}

TEST_F(StreamedRendererTest, CoarseLevelsAreReadWhereTheWholeVolumeHasThemDrawn) {
  const Volume volume = makeProcedural("cloud", 128);
  const Classification classification{.densityScale = 8.0};
  Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  camera.position = glm::mix(camera.position, camera.lookAt, 0.55);
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.size = {64, 64};
  settings.lod = 1.5f;
  const Image expected = Renderer(device(), volume, classification, {}).render(camera, settings);
  StreamedRenderer renderer(device(), bake(volume, classification), 0, classification, {});
  const Image image = renderer.render(camera, settings);
  std::size_t levels = 0;
  for (const std::size_t cubes : renderer.cubesRead()) levels += cubes > 0 ? 1 : 0;
  EXPECT_GT(levels, 1u);
  EXPECT_GT(psnr(image, expected), 60.0);
}

TEST_F(StreamedRendererTest, TheImageHasTheSameBitsWithEveryMemoryLimit) {
  const Volume volume = makeProcedural("cloud", 120);
  const Classification classification{.densityScale = 8.0};
  const auto file = bake(volume, classification, false);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  const FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  const Image all = StreamedRenderer(device(), file, 0, classification, {}).render(camera, settings);
  for (const std::uint64_t mebibytes : {48, 256}) {
    const Device limited(instance(), "", mebibytes << 20);
    StreamedRenderer renderer(limited, file, 0, classification, {});
    EXPECT_EQ(renderer.render(camera, settings).pixels, all.pixels) << mebibytes;
    EXPECT_LE(limited.peakBytes(), mebibytes << 20);
  }
}

TEST_F(StreamedRendererTest, WhatNeedsTheWholeVolumeIsSaid) {
  const Volume volume = makeProcedural("cloud", 40);
  const auto why = [&](const Classification& classification, const FrameSettings& settings) {
    return StreamedRenderer::whyNot(*bake(volume, classification), classification, settings).value_or("");
  };
  const FrameSettings settings = litSettings(std::vector<Light>(4));
  EXPECT_EQ(why({}, settings), "");
  EXPECT_EQ(why(coloured(volume), settings), "");
  FrameSettings other = settings;
  other.draw = Draw::Splats;
  EXPECT_NE(why({}, other), "");
  other = settings;
  other.lighting->attenuation = LightAttenuation::Table;
  EXPECT_NE(why({}, other), "");
  EXPECT_NE(why({}, litSettings(std::vector<Light>(5))), "");
  Classification pre = coloured(volume);
  pre.order = ClassificationOrder::Pre;
  EXPECT_NE(why(pre, settings), "");
}

}  // namespace
}  // namespace freevoxels
