// Volumes that are drawn cube by cube, from memory and from baked files: the image is the one that is gathered with the whole volume on the
// device, and has the same bits with every memory limit.

#include "engine/cube_drawing.h"

#include <glm/gtc/matrix_transform.hpp>

#include "engine/cube_level.h"
#include "engine/renderer.h"
#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

class CubeDrawingTest : public DeviceTest {
 protected:
  std::shared_ptr<const VolumeSource> bake(const Volume& volume, const Classification& classification, bool keepScalars = true) const {
    bakeVolume(folder_ / "a.fvx", volume, classification, {.keepScalars = keepScalars});
    return std::make_shared<const BakedSource>(std::make_shared<const fvx::FvxFile>(folder_ / "a.fvx"));
  }

  std::unique_ptr<Renderer> inCubes(std::shared_ptr<const VolumeSource> source, const Classification& classification) const {
    auto renderer = std::make_unique<Renderer>(device(), std::move(source), classification, TableSettings{});
    renderer->requireCubes();
    return renderer;
  }

  static FrameSettings litSettings(std::vector<Light> lights) {
    FrameSettings settings{.size = {96, 80}, .depth = true};
    settings.lighting = Lighting{.lights = std::move(lights), .ambient = glm::dvec3(0.2, 0.3, 0.4), .attenuation = LightAttenuation::Exact};
    settings.gather().sampleTolerance = 0.0f;  // as cubes have every ray marched
    return settings;
  }

  /// PSNR against the whole volume. Cubes of memory and of a file have the same bits.
  double compare(const Volume& volume, const Classification& classification, const Camera& camera, const FrameSettings& settings) const {
    const Image expected = Renderer(device(), volume, classification, {}).render(camera, settings);
    const Image image = inCubes(bake(volume, classification), classification)->render(camera, settings);
    const auto memory = std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(volume));
    EXPECT_EQ(inCubes(memory, classification)->render(camera, settings).pixels, image.pixels);
    EXPECT_EQ(image.depth.size(), expected.depth.size());
    return psnr(image, expected);
  }

  const test::TemporaryFolder folder_;
};

TEST_F(CubeDrawingTest, DensitiesWithLightsAreTheImageOfTheWholeVolume) {
  // The last cubes are narrower than their surroundings; one light is inside the box.
  const Volume volume = randomVolume({73, 66, 43}, shearedTransform({73, 66, 43}), 0.5, 3.0);
  const Classification classification{.densityScale = 0.1};
  const glm::dvec3 middle = volume.indexToWorld * glm::dvec4(36.0, 33.0, 21.0, 1.0);
  const FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}, {.place = middle, .atInfinity = false, .intensity = 2.0}});
  EXPECT_GT(compare(volume, classification, framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 90.0);
  EXPECT_GT(compare(volume, classification, framingCamera(volume, 200.0, -60.0, 1.2, {.orthographic = true}), settings), 90.0);
}

TEST_F(CubeDrawingTest, SurfacesOfATransferFunctionAreTheImageOfTheWholeVolume) {
  const Volume volume = makeProcedural("head", 80);
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.lighting->surface = 0.8;
  settings.lighting->phaseG = 0.3;
  settings.lod = 0.0f;
  EXPECT_GT(compare(volume, coloured(volume), framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 60.0);
}

TEST_F(CubeDrawingTest, VoxelsThatAreClassifiedBeforehandAreTheImageOfTheWholeVolume) {
  const Volume volume = makeProcedural("head", 80);
  Classification classification = coloured(volume);
  classification.order = ClassificationOrder::Pre;
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.lod = 0.0f;
  settings.lighting->surface = 0.8;
  EXPECT_GT(compare(volume, classification, framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 60.0);
}

TEST_F(CubeDrawingTest, FiresAreTheImageOfTheWholeVolumeWithAndWithoutLight) {
  const Volume volume = makeProcedural("fire", 128);
  ASSERT_GT(std::max({volume.dimensions.x, volume.dimensions.y, volume.dimensions.z}), PieceTree::kCubeEdge);
  Classification classification{.densityScale = automaticDensityScale(volume, 2.0), .albedo = glm::vec3(0.8f)};
  classification.emission = Emission{.strength = automaticEmissionStrength(volume, classification, {})};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  const auto cubes = inCubes(bake(volume, classification), classification);
  for (const bool lit : {false, true, false}) {
    FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}, .intensity = 0.5}});
    settings.lod = 0.0f;
    if (!lit) settings.lighting.reset();
    const Image image = cubes->render(camera, settings);
    EXPECT_GT(psnr(image, Renderer(device(), volume, classification, {}).render(camera, settings)), 90.0);
  }
}

TEST_F(CubeDrawingTest, LightsBeyondFourAddTheirLight) {
  const Volume volume = makeProcedural("fire", 72);
  Classification classification{.densityScale = automaticDensityScale(volume, 4.0), .albedo = glm::vec3(0.8f)};
  classification.emission = Emission{.strength = 0.2 * automaticEmissionStrength(volume, classification, {})};
  const auto file = bake(volume, classification);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  // The same light as one light and as a sum of six.
  FrameSettings one = litSettings({{.place = {1.0, 0.7, 0.2}, .intensity = 6.0}}), six = one;
  six.lighting->lights.assign(6, {.place = {1.0, 0.7, 0.2}, .intensity = 1.0});
  const auto renderer = inCubes(file, classification);
  const Image expected = renderer->render(camera, one), image = renderer->render(camera, six);
  EXPECT_GT(psnr(image, expected), 100.0);
  EXPECT_EQ(image.depth, expected.depth);
}

TEST_F(CubeDrawingTest, AnEyeInsideTheBoxSeesTheImageOfTheWholeVolume) {
  const Volume volume = makeProcedural("cloud", 100);
  Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  camera.position = glm::mix(camera.position, camera.lookAt, 0.9);
  FrameSettings settings = litSettings({});
  settings.lighting.reset();
  EXPECT_GT(compare(volume, {.densityScale = 8.0}, camera, settings), 90.0);
}

TEST_F(CubeDrawingTest, CoarseLevelsAreReadWhereTheWholeVolumeHasThemDrawn) {
  const Volume volume = makeProcedural("cloud", 128);
  const Classification classification{.densityScale = 8.0};
  Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  camera.position = glm::mix(camera.position, camera.lookAt, 0.55);
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.size = {64, 64};
  settings.lod = 1.5f;
  const Image expected = Renderer(device(), volume, classification, {}).render(camera, settings);
  const auto renderer = inCubes(bake(volume, classification), classification);
  const Image image = renderer->render(camera, settings);
  std::size_t levels = 0;
  for (const std::size_t cubes : renderer->cubesRead()) levels += cubes > 0 ? 1 : 0;
  EXPECT_GT(levels, 1u);
  EXPECT_GT(psnr(image, expected), 60.0);
}

TEST_F(CubeDrawingTest, TheImageHasTheSameBitsWithEveryMemoryLimit) {
  const Volume volume = makeProcedural("cloud", 120);
  const Classification classification{.densityScale = 8.0};
  const auto file = bake(volume, classification, false);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  const FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  const Image all = inCubes(file, classification)->render(camera, settings);
  for (const std::uint64_t mebibytes : {38, 40, 256}) {
    const Device limited(instance(), "", {.memory = mebibytes << 20});
    Renderer renderer(limited, file, classification, {});
    if (mebibytes == 256) renderer.requireCubes();
    EXPECT_EQ(renderer.render(camera, settings).pixels, all.pixels) << mebibytes;
    EXPECT_TRUE(renderer.drewInCubes());
    EXPECT_LE(limited.peakBytes(), mebibytes << 20);
  }
}

TEST_F(CubeDrawingTest, AClippedVolumeWhoseBricksBeginBeforeItsBoxIsTheImageOfTheWholeVolume) {
  const Volume volume =
      clippedVolume(randomVolume({90, 70, 50}, shearedTransform({90, 70, 50}), 0.5, 3.0), VoxelBox{{3, 5, 1}, {82, 66, 45}});
  ASSERT_NE(volume.scalars.corner(), glm::ivec3(0));
  FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
  settings.lod = 0.0f;
  EXPECT_GT(compare(volume, {.densityScale = 0.1}, framingCamera(volume, 35.0, 25.0, 1.2, {}), settings), 90.0);
}

TEST_F(CubeDrawingTest, PartsAddUpToTheSameBitsAndTheirImageIsThatOfTheFrame) {
  const Volume volume = makeProcedural("cloud", 100);
  const Classification classification{.densityScale = 8.0};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  const FrameSettings settings = litSettings(std::vector<Light>(5, {.place = {1.0, 0.7, 0.2}, .intensity = 0.3}));
  const auto renderer = inCubes(bake(volume, classification), classification);
  const FixedSums whole = renderer->renderShares(camera, settings, {0, 1});
  for (const int parts : {2, 3, 7}) {
    FixedSums all = renderer->renderShares(camera, settings, {0, parts});
    for (int part = 1; part < parts; ++part) all += renderer->renderShares(camera, settings, {part, parts});
    EXPECT_EQ(all.values, whole.values) << parts;
  }
  const Image image = resolveSums(whole, true), expected = renderer->render(camera, settings);
  EXPECT_GT(psnr(image, expected), 80.0);
  EXPECT_EQ(image.depth.size(), expected.depth.size());
}

TEST_F(CubeDrawingTest, ALimitBelowTheLeastIsAnErrorThatNamesALimitWhichIsEnough) {
  const Volume volume = makeProcedural("cloud", 100);
  const Classification classification{.densityScale = 8.0};
  const auto source = std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(volume));
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.2, {});
  for (const glm::ivec2 size : {glm::ivec2(64, 48), glm::ivec2(900, 700)}) {
    FrameSettings settings = litSettings({{.place = {1.0, 0.7, 0.2}}});
    settings.size = size;
    std::string sentence;
    const Device little(instance(), "", {.memory = std::uint64_t(6) << 20});
    try {
      Renderer(little, source, classification, {}).render(camera, settings);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::OutOfMemory);
      sentence = error.what();
    }
    const std::size_t place = sentence.find("at least ");
    ASSERT_NE(place, std::string::npos) << sentence;
    const Device enough(instance(), "", {.memory = std::stoull(sentence.substr(place + 9)) << 20});
    EXPECT_NO_THROW(Renderer(enough, source, classification, {}).render(camera, settings)) << sentence;
  }
}

/// A volume at a place of a box of a million voxels along each axis, in the world where it was; and a brick of `density` at each corner of
/// `others`.
Volume farAway(const Volume& volume, glm::ivec3 place, std::span<const glm::ivec3> others, float density) {
  const glm::ivec3 size(1'000'008);
  Volume far{.source = "far", .dimensions = size, .scalars = ScalarBricks(size)};
  far.indexToWorld = glm::translate(volume.indexToWorld, -glm::dvec3(place));
  glm::ivec3 v;
  for (v.z = 0; v.z < volume.dimensions.z; ++v.z)
    for (v.y = 0; v.y < volume.dimensions.y; ++v.y)
      for (v.x = 0; v.x < volume.dimensions.x; ++v.x)
        if (const float scalar = volume.scalars.at(v); scalar != kInactiveVoxel) far.scalars.set(place + v, scalar);
  for (const glm::ivec3 corner : others) far.scalars.makeBrick(corner / ScalarBricks::kEdge).fill(density);
  summariseValues(far);
  return far;
}

TEST_F(CubeDrawingTest, AnIslandInABoxOfAMillionVoxelsIsDrawnAsAlone) {
  const Volume alone = randomVolume({41, 36, 43}, shearedTransform({41, 36, 43}), 0.5, 3.0);
  const Classification classification{.densityScale = 0.1};
  FrameSettings settings{.size = {40, 32}};
  settings.gather().sampleTolerance = 0.0f;
  settings.lighting = Lighting{.lights = {{.place = {1.0, 0.7, 0.2}}}, .attenuation = LightAttenuation::Exact};
  const std::array<glm::ivec3, 2> corners{glm::ivec3(0), glm::ivec3(1'000'000)};  // out of sight
  for (const bool lit : {false, true}) {
    if (!lit) settings.lighting.reset();
    for (const bool orthographic : {false, true}) {
      const Camera camera = framingCamera(alone, 35.0, 25.0, 1.2, {.orthographic = orthographic});
      const Image expected = Renderer(device(), alone, classification, {}).render(camera, settings);
      // Across borders of regions, too.
      for (const glm::ivec3 place : {glm::ivec3(700'001, 640'003, 91'234), glm::ivec3(8192 * 50 - 20, 8192 * 3 - 17, 8192 * 100 - 9)}) {
        const Volume far = farAway(alone, place, corners, 1.0f);
        Renderer renderer(device(), far, classification, {});
        EXPECT_GT(psnr(renderer.render(camera, settings), expected), 60.0) << lit << orthographic << place.x;
        EXPECT_TRUE(renderer.drewInCubes());
      }
    }
    settings.lighting = Lighting{.lights = {{.place = {1.0, 0.7, 0.2}}}, .attenuation = LightAttenuation::Exact};
  }
}

TEST_F(CubeDrawingTest, AnIslandFarAwayCastsItsShadow) {
  const Volume alone = randomVolume({7, 7, 7}, glm::dmat4(1.0), 0.5, 3.0);
  const glm::ivec3 place(500'000, 500'000, 16);
  const std::vector<glm::ivec3> corner{glm::ivec3(0)};  // out of sight
  std::vector<glm::ivec3> wall = corner;                // and 5 x 5 bricks between the volume and the light
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) wall.emplace_back(place + glm::ivec3(8 * i, 8 * j, 900'000));
  const Classification classification{.densityScale = 0.1};
  FrameSettings settings{.size = {24, 24}};
  settings.gather().sampleTolerance = 0.0f;
  settings.lighting = Lighting{.lights = {{.place = {0.0, 0.0, 1.0}}}, .attenuation = LightAttenuation::Exact};
  const Camera camera = framingCamera(alone, 35.0, 25.0, 1.0, {});
  const Volume far = farAway(alone, place, wall, 0.75f);
  const Image shadowed = Renderer(device(), far, classification, {}).render(camera, settings);
  const double intensity = settings.lighting->lights.front().intensity;
  settings.lighting->lights.front().intensity = intensity * std::exp(-0.1 * 0.75 * 8.0);
  const Volume free = farAway(alone, place, corner, 0.75f);
  Renderer unshadowed(device(), free, classification, {});
  EXPECT_GT(psnr(shadowed, unshadowed.render(camera, settings)), 45.0);
  settings.lighting->lights.front().intensity = intensity;
  EXPECT_LT(psnr(shadowed, unshadowed.render(camera, settings)), 40.0);
}

TEST_F(CubeDrawingTest, SplatsOfMoreVoxelsThanCanBeNumberedAreRefused) {
  const std::array<glm::ivec3, 2> corners{glm::ivec3(0), glm::ivec3(1'000'000)};
  const Volume far = farAway(randomVolume({5, 5, 5}, glm::dmat4(1.0), 0.5, 3.0), glm::ivec3(64), corners, 1.0f);
  FrameSettings settings{.size = {8, 8}};
  settings.method = SplatSettings{};
  Renderer renderer(device(), far, {}, {});
  const Camera camera = framingCamera(far, 35.0, 25.0, 1.0, {});
  test::expectRefusal([&] { renderer.render(camera, settings); }, ErrorKind::OutOfMemory,
                      {"1000008x1000008x1000008", fmt::format("{} of which have data", far.activeVoxels), "splats"});
}

TEST_F(CubeDrawingTest, WhatNeedsTheWholeVolumeIsSaid) {
  const auto why = [&](const FrameSettings& settings) { return CubeDrawing::whyNot(settings).value_or(""); };
  const FrameSettings settings = litSettings(std::vector<Light>(4));
  EXPECT_EQ(why(settings), "");
  FrameSettings other = settings;
  other.method = SplatSettings{};
  EXPECT_NE(why(other), "");
  other = settings;
  other.lighting->attenuation = LightAttenuation::Table;
  EXPECT_NE(why(other), "");
}

}  // namespace
}  // namespace freevoxels
