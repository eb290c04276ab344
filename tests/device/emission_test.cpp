// Light that voxels send out, and grids of albedos, on the device: against the double-precision reference.

#include <cmath>
#include <random>

#include "engine/reference/reference_hierarchy.h"
#include "engine/reference/reference_sorted.h"
#include "engine/renderer_stages.h"
#include "engine/validation/emission_checks.h"
#include "engine/validation/level_checks.h"
#include "engine/validation/stage_checks.h"
#include "engine/volume/packed_light.h"
#include "engine/volume/subject.h"
#include "engine/volume/voxel_classifier.h"
#include "tests/device/splat_fixture.h"

namespace freevoxels {
namespace {

/// Hot here and there, also where there is no density: each of both, of one, or of nothing.
Volume hotVolume(bool sheared, glm::ivec3 size = {11, 14, 9}, double dense = 0.6) {
  Volume volume = randomVolume(size, sheared ? shearedTransform(size) : cubeTransform(size), dense, 1.0);
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  volume.temperature = TemperatureGrid{.name = "t", .values = ScalarBricks(volume.dimensions)};
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (uniform(generator) < 0.5f)
          volume.temperature->values.set({x, y, z}, 900.0f + 1200.0f * uniform(generator));
  summariseValues(*volume.temperature);
  coverBricks(volume, volume.temperature->values);
  return volume;
}

Classification hot(const Volume& volume, float opacity = 0.4f) {
  Classification classification = coloured(volume, opacity);
  classification.emission = Emission{.strength = 8.0};
  return classification;
}

class EmissionTest : public SplatTest {
 protected:
  static std::vector<double> extinctionOf(const Renderer& renderer) {
    const std::vector<float> device = RendererStages(renderer).downloadExtinction();
    return {device.begin(), device.end()};
  }
  struct View {
    Camera camera;
    FrameSettings settings;
  };
  /// Given the light that the device keeps, which has nine bits.
  static void expectSameImages(const Volume& volume, const Classification& classification, const std::vector<View>& frames) {
    Renderer renderer(device(), volume, classification, {});
    const auto extinction = extinctionOf(renderer);
    const auto table = RendererStages(renderer).downloadTable();
    const auto levels = RendererStages(renderer).downloadLevels();
    const auto emission = RendererStages(renderer).downloadEmission();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      SCOPED_TRACE(i);
      const auto& [camera, settings] = frames[i];
      const Image image = renderer.render(camera, settings);
      const std::optional<ScatteredField> scattered = RendererStages(renderer).downloadScattered();
      const auto sums = referenceBlockSums(volume, classification,
                                           {.extinction = extinction,
                                            .table = table,
                                            .tableSettings = {},
                                            .coarser = levels,
                                            .emission = emission,
                                            .scattered = settings.lighting && scattered ? &*scattered : nullptr},
                                           camera, settings, RendererStages(renderer).downloadDrawnBlocks());
      const Image expected = referenceResolve(sums, settings);
      EXPECT_LE(largestPixelDifference(image, expected), 2e-3);
      EXPECT_GE(psnr(image, expected), 70.0);
      float brightest = 0.0f;
      for (const glm::vec4& pixel : image.pixels) brightest = std::max(brightest, pixel.r);
      EXPECT_GT(brightest, 0.8f);  // it shines
    }
  }
};

TEST_F(EmissionTest, EveryVoxelWithExtinctionOrLightIsKept) {
  const Volume volume = hotVolume(true, {11, 14, 9}, 0.1);
  const Classification classification = hot(volume);
  Renderer renderer(device(), volume, classification, {});
  const auto emission = RendererStages(renderer).downloadEmission();
  ASSERT_EQ(emission.size(), volume.voxelCount());
  const double faintest = brightestLight(classification, volume) * kFaintest / kBrightest;
  const VoxelClassifier classifier(classification, volume);
  std::size_t voxel = 0, alone = 0;
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x, ++voxel) {
        const ClassifiedVoxel expected = classifier.at({x, y, z});
        const double largest = std::max({expected.emission.r, expected.emission.g, expected.emission.b});
        if (largest < faintest) {
          EXPECT_EQ(emission[voxel], glm::dvec3(0.0));
          continue;
        }
        EXPECT_LE(glm::length(emission[voxel] - expected.emission), largest / 290.0);
        if (expected.extinction == 0.0) ++alone;
      }
  EXPECT_GT(alone, 100u);
  EXPECT_EQ(RendererStages(renderer).downloadBlockList(), referenceVisibleVoxels(extinctionOf(renderer), emission));
  EXPECT_EQ(renderer.memory().emission % sizeof(std::uint32_t), 0u);
  EXPECT_GT(renderer.memory().emission, 0u);
}

TEST_F(EmissionTest, EveryCompositeAndLookUpMatchesTheReference) {
  const Volume volume = hotVolume(true);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.25, {});
  FrameSettings lit{.size = {40, 32}, .method = SplatSettings{}, .lod = 0.0f, .lighting = Lighting{.ambient = glm::dvec3(0.5)}};
  lit.lighting->lights.push_back({.place = {1.0, 0.7, 0.2}});
  lit.lighting->surface = 0.5;
  expectSameImages(volume, hot(volume),
                   {{camera, {.size = {60, 48}, .method = SplatSettings{}, .lod = 0.0f}},
                    {camera, {.size = {60, 48}, .method = SplatSettings{.composite = Composite::Additive}, .lod = 0.0f}},
                    {camera, {.size = {40, 32}, .method = SplatSettings{}, .lod = 0.0f}},
                    {camera, lit}});
}

/// No extinction at all: sums without E and T, and blocks of nothing but light.
TEST_F(EmissionTest, FlamesWithoutSmokeMatchTheReference) {
  const Volume volume = hotVolume(true);
  const Classification classification{.densityScale = 0.0, .emission = Emission{.strength = 5.0}};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  Camera inside = camera;
  inside.position = {0.02, 0.03, 0.01};
  inside.lookAt = {0.3, 0.1, -0.2};
  expectSameImages(volume, classification,
                   {{camera, {.size = {40, 40}, .method = SplatSettings{}, .lod = 0.0f}},
                    {camera, {.size = {40, 40}, .method = SplatSettings{}, .lod = 9.0f}},
                    {inside, {.size = {40, 40}, .method = SplatSettings{}}},
                    {inside, {.size = {40, 40}, .method = SplatSettings{}}}});
  Renderer renderer(device(), volume, classification, {});
  for (const glm::vec4& pixel : renderer.render(camera, {.size = {40, 40}, .method = SplatSettings{}}).pixels) EXPECT_EQ(pixel.a, 0.0f);
}

TEST_F(EmissionTest, LevelsAndTheirImagesMatchTheReference) {
  const Volume volume = hotVolume(true, {19, 23, 17});
  const Classification classification = hot(volume);
  Renderer renderer(device(), volume, classification, {});
  const LevelData voxels = referenceVoxelLevel(volume, classification, extinctionOf(renderer),
                                               RendererStages(renderer).downloadTable(), RendererStages(renderer).downloadEmission());
  for (const Check& check : compareLevels(volume, voxels, RendererStages(renderer).downloadLevels(), {}, "depth8"))
    EXPECT_TRUE(check.passed()) << check.name << ": " << check.figure << " " << check.where;
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  expectSameImages(volume, classification,
                   {{camera, {.size = {30, 30}, .method = SplatSettings{.culling = false}, .lod = 6.0f}},
                    {camera, {.size = {30, 30}, .method = SplatSettings{.culling = false}, .lod = 20.0f}}});
}

TEST_F(EmissionTest, SortedImagesMatchTheReference) {
  const Volume volume = hotVolume(true);
  const Classification classification = hot(volume);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  const FrameSettings settings{.size = {50, 50}, .method = SplatSettings{.composite = Composite::Sorted}};
  Renderer renderer(device(), volume, classification, {});
  const Image image = renderer.render(camera, settings);
  const Image expected = referenceSortedImage(volume, classification, camera, settings, RendererStages(renderer).downloadBlockList());
  EXPECT_GE(psnr(image, expected), 60.0);
}

/// What freevoxels-validate says of them.
TEST_F(EmissionTest, TheChecksOfAFirePass) {
  Volume fire = makeProcedural("fire", 16);
  cropToActive(fire);
  const ValidationScene scene = makeValidationScene(std::move(fire), SceneColor::Density, 16);
  for (const ReportSection& section :
       {stageChecks(deviceStages(device()), scene, {24, 24}), emissionChecks(device(), 24, 24)})
    for (const Check& check : section.checks)
      EXPECT_TRUE(check.passed()) << section.title << ": " << check.name << ": " << check.figure << " "
                                  << check.where;
}

/// What is hidden by its transmittance alone may be bright enough to show.
TEST_F(EmissionTest, CullingLeavesALampInSmokeThere) {
  const glm::ivec3 size(48);
  Volume volume = makeVolume(size, cubeTransform(size), [](int, int, int) { return 1.0; });
  volume.temperature = TemperatureGrid{
      .name = "t", .values = ScalarBricks::make(size, [&](glm::ivec3 v) {
                     const double radius = glm::length(glm::dvec3(v) - 0.5 * glm::dvec3(size - 1));
                     return radius < 6.0 ? 2500.0f : kInactiveVoxel;
                   })};
  summariseValues(*volume.temperature);
  const Classification classification{.densityScale = 20.0, .emission = Emission{.strength = 4000.0}};
  Renderer renderer(device(), volume, classification, {});
  const Camera camera = framingCamera(volume, 20.0, 15.0, 1.0, {});
  FrameSettings settings{.size = {64, 64}, .method = SplatSettings{}};
  const Image image = renderer.render(camera, settings);
  settings.splats().culling = false;
  const Image expected = renderer.render(camera, settings);
  EXPECT_LE(largestPixelDifference(image, expected), 1e-2);
  EXPECT_GT(expected.pixels[32 * 64 + 32].r, 1.5f);
}

/// Lights are evaluated along stretches between slices, emission alone in layers around them.
TEST_F(EmissionTest, AFaintLightLeavesEmissionAsItIs) {
  const Volume volume = hotVolume(true, {19, 23, 17});
  Renderer renderer(device(), volume, hot(volume, 1.0f), {});
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  FrameSettings settings{.size = {64, 64}, .method = SplatSettings{}, .lighting = Lighting{}};
  const Image alone = renderer.render(camera, settings);
  settings.lighting = Lighting{.lights = {{.place = {0.3, 1.0, 0.4}, .intensity = 1e-9}}};
  EXPECT_GE(psnr(renderer.render(camera, settings), alone), 65.0);
}

TEST_F(EmissionTest, AlbedoGridsMatchTheReference) {
  Volume volume = randomVolume({11, 14, 9}, shearedTransform({11, 14, 9}), 0.6, 1.0);
  volume.albedo = AlbedoGrid{.name = "Cd", .values = {}};
  for (int c = 0; c < 3; ++c)
    volume.albedo->values[std::size_t(c)] = ScalarBricks::make(volume.dimensions, [&](glm::ivec3 v) {
      return float((v.x * (5 + c) + v.y * (3 - c) + v.z * 7 * (c + 1)) % 17) / 16.0f;  // nine bits keep it
    });
  const Classification classification{.densityScale = 6.0};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  Renderer renderer(device(), volume, classification, {});
  const auto extinction = extinctionOf(renderer);
  const auto table = RendererStages(renderer).downloadTable();
  const auto levels = RendererStages(renderer).downloadLevels();
  for (const float lod : {0.0f, 9.0f}) {
    const FrameSettings settings{.size = {40, 40}, .method = SplatSettings{.culling = false}, .lod = lod};
    const Image image = renderer.render(camera, settings);
    const auto sums =
        referenceBlockSums(volume, classification,
                           {.extinction = extinction, .table = table, .tableSettings = {}, .coarser = levels},
                           camera, settings, RendererStages(renderer).downloadDrawnBlocks());
    EXPECT_GE(psnr(image, referenceResolve(sums, settings)), 70.0);
  }
  const LevelData voxels = referenceVoxelLevel(volume, classification, extinction, table);
  for (const Check& check : compareLevels(volume, voxels, levels, {}, "depth8"))
    EXPECT_TRUE(check.passed()) << check.name << ": " << check.figure << " " << check.where;
}

}  // namespace
}  // namespace freevoxels
