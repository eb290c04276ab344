// Baked volumes that are drawn cube by cube: the image is the one that is gathered with the whole volume in memory, and has the same bits
// with every memory limit.

#include "engine/streamed_renderer.h"

#include "engine/renderer.h"
#include "engine/volume/emission_light.h"
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
    settings.sampleTolerance = 0.0f;  // as cubes have every ray marched
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

TEST_F(StreamedRendererTest, VoxelsThatAreClassifiedBeforehandAreTheImageOfTheWholeVolume) {
  const Volume volume = makeProcedural("head", 80);
  Classification classification = coloured(volume);
  classification.order = ClassificationOrder::Pre;
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.lod = 0.0f;
  settings.lighting->surface = 0.8;
  EXPECT_GT(compare(volume, classification, framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 60.0);
}

TEST_F(StreamedRendererTest, FiresAreTheImageOfTheWholeVolumeAndOfTheirOwnLight) {
  const Volume volume = makeProcedural("fire", 128);
  ASSERT_GT(std::max({volume.dimensions.x, volume.dimensions.y, volume.dimensions.z}), StreamedRenderer::kCubeEdge);
  Classification classification{.densityScale = automaticDensityScale(volume, 2.0), .albedo = glm::vec3(0.8f)};
  classification.emission = Emission{.strength = automaticEmissionStrength(volume, classification, {})};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  StreamedRenderer streamed(device(), bake(volume, classification), 0, classification, {});
  for (const bool lit : {false, true, false}) {
    FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}, .intensity = 0.5}});
    settings.lod = 0.0f;
    if (!lit) settings.lighting.reset();
    const Image image = streamed.render(camera, settings);
    Classification whole = classification;
    if (lit) whole.emissionLight = std::make_shared<const EmissionLight>(volume, classification);
    EXPECT_GT(psnr(image, Renderer(device(), volume, whole, {}).render(camera, settings)), 90.0);
    if (lit) {
      EXPECT_LT(psnr(image, Renderer(device(), volume, classification, {}).render(camera, settings)), 60.0);
    }
  }
}

TEST_F(StreamedRendererTest, LightsBeyondFourAddTheirLight) {
  const Volume volume = makeProcedural("fire", 72);
  Classification classification{.densityScale = automaticDensityScale(volume, 4.0), .albedo = glm::vec3(0.8f)};
  classification.emission = Emission{.strength = 0.2 * automaticEmissionStrength(volume, classification, {})};
  const auto file = bake(volume, classification);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  // The same light as one light and as a sum of six.
  FrameSettings one = litSettings({{.place = {1.0, 0.7, 0.2}, .intensity = 6.0}}), six = one;
  six.lighting->lights.assign(6, {.place = {1.0, 0.7, 0.2}, .intensity = 1.0});
  StreamedRenderer renderer(device(), file, 0, classification, {});
  const Image expected = renderer.render(camera, one), image = renderer.render(camera, six);
  EXPECT_GT(psnr(image, expected), 100.0);
  EXPECT_EQ(image.depth, expected.depth);
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
  const auto file = bake(volume, {});
  const auto why = [&](const FrameSettings& settings) { return StreamedRenderer::whyNot(*file, settings).value_or(""); };
  const FrameSettings settings = litSettings(std::vector<Light>(4));
  EXPECT_EQ(why(settings), "");
  FrameSettings other = settings;
  other.draw = Draw::Splats;
  EXPECT_NE(why(other), "");
  other = settings;
  other.lighting->attenuation = LightAttenuation::Table;
  EXPECT_NE(why(other), "");
}

}  // namespace
}  // namespace freevoxels
