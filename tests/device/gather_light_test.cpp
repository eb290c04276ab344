// Lit frames by gathering: against closed forms and the oracle, and beside those of splats.

#include <array>
#include <cmath>

#include "engine/validation/gather_checks.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/sky_environment.h"
#include "tests/device/gather_fixture.h"

namespace freevoxels {
namespace {

using GatherLightTest = GatherTest;

TEST_F(GatherLightTest, LitVolumesAreAsNearToTheOracleAsSplats) {
  for (const double phaseG : {0.0, 0.6}) {
    const Scene scene = cloud(32);
    const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
    const FrameSettings splats{.size = {64, 64}, .method = SplatSettings{}, .lighting = Lighting{.lights = {{}}, .phaseG = phaseG}};
    FrameSettings gather = splats;
    gather.method = GatherSettings{};
    const std::vector<double> quality = qualitiesOf(scene, camera, {splats, gather});
    EXPECT_GE(quality[1], quality[0] - 0.3) << phaseG;
  }
}

TEST_F(GatherLightTest, PhaseFunctionActsOnLightFromEverywhere) {
  const Scene scene = cloud(16);
  Environment sky = makeSky(64);
  sky.intensity = 0.3;
  Camera camera = framingCamera(scene.volume, 180.0, 25.0, 1.0, {});
  FrameSettings settings{
      .size = {24, 24},
      .method = SplatSettings{},
      .lighting =
          Lighting{.ambient = glm::dvec3(0.3), .environment = std::make_shared<Environment>(sky), .phaseG = 0.6, .scattering = kAllOrders}};
  FrameSettings gather = settings;
  gather.method = GatherSettings{};
  for (const double quality : qualitiesOf(scene, camera, {settings, gather})) EXPECT_GE(quality, 42.0);
  settings = gather;
  camera.position = camera.lookAt + 0.2 * (camera.position - camera.lookAt);
  settings.lighting = Lighting{.ambient = glm::dvec3(1.0), .phaseG = -0.4};
  EXPECT_GE(qualityOf(scene, camera, settings), 40.0);
}

/// A column of optical depth D with tint t scatters (1 - exp(-(1 + t) D)) / (1 + t) of the unshadowed light if it is lit from the eye's
/// side, and D exp(-D) if it is lit from behind with t = 1.
TEST_F(GatherLightTest, LightThroughAHomogeneousBoxIsItsIntegral) {
  const Volume box = makeVolume({20, 20, 12}, cubeTransform({20, 20, 12}), [](int, int, int) { return 1.0; });
  const glm::ivec2 size(15, 15);
  const Camera camera = alongZ(box, size, 1.0);
  const double length = 12.0 * glm::length(glm::dvec3(box.indexToWorld[2]));
  for (const double depth : {0.3, 2.0, 6.0}) {
    Renderer renderer(device(), box, {.densityScale = depth / length, .albedo = glm::vec3(1.0f)}, {});
    FrameSettings settings = gathering(size);
    settings.lighting = Lighting{.lights = {{.place = {0.0, 0.0, 1.0}}}, .tint = {1.0, 0.5, 2.0}};
    const glm::vec4 front = renderer.render(camera, settings).pixels[7 + 7 * 15];
    for (int c = 0; c < 3; ++c) {
      const double both = 1.0 + settings.lighting->tint[c], expected = (1.0 - std::exp(-both * depth)) / both;
      EXPECT_NEAR(front[c], expected, 0.01 * expected) << depth << ' ' << c;
    }
    settings.lighting = Lighting{.lights = {{.place = {0.0, 0.0, -1.0}}}};
    const glm::vec4 behind = renderer.render(camera, settings).pixels[7 + 7 * 15];
    EXPECT_NEAR(behind.r, depth * std::exp(-depth), 0.02 * depth * std::exp(-depth)) << depth;
  }
}

/// Fog that ends only where the volume does, seen from its lit and from its shadowed sides.
TEST_F(GatherLightTest, LightThatReachesTheBordersOfAFullVolumeMatchesTheOracle) {
  const glm::ivec3 n(12);
  const Scene fog{.volume = makeVolume(n, cubeTransform(n), [](int, int, int) { return 1.0; }), .classification = {.densityScale = 3.0}};
  Scene scan = fog;
  scan.classification = {.transferFunction = TransferFunction{.opacity = {{0.0f, 0.1f}, {2.0f, 0.1f}},
                                                              .color = {{0.0f, glm::vec3(1.0f)}},
                                                              .unitDistance = 0.035}};
  const Camera camera = framingCamera(fog.volume, 35.0, 25.0, 1.0, {});
  for (const Scene* scene : std::array<const Scene*, 2>{&fog, &scan})
    for (const glm::dvec3 toLight : {glm::dvec3(-1.0, -0.2, -1.0), glm::dvec3(1.0, 0.3, 1.0)}) {
      FrameSettings settings = gathering({32, 32});
      settings.lighting = Lighting{.lights = {{.place = toLight}}};
      EXPECT_GE(qualityOf(*scene, camera, settings), 36.0) << toLight.x;
    }
}

/// On an opaque surface light falls off within one voxel, which one value per voxel, as splats have, cannot show.
TEST_F(GatherLightTest, LightOnOpaqueSkinComesNearerToTheOracleThanThatOfSplats) {
  QualityScene head = makeQualityScene({"head", QualityColor::Bone, false}, 32, makeProcedural("head", 32));
  const Scene scene{.volume = head.volume, .classification = head.classification};
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  FrameSettings splats{.size = {64, 64}, .method = SplatSettings{}, .lighting = Lighting{.lights = {{.place = {1.0, 1.0, 1.0}}}}};
  splats.lod = 0.0f;
  FrameSettings gather = splats;
  gather.method = GatherSettings{};
  const std::vector<double> quality = qualitiesOf(scene, camera, {splats, gather});
  EXPECT_GE(quality[1], quality[0] + 5.0);
}

TEST_F(GatherLightTest, LitSurfacesAreSmooth) {
  for (const Check& check : gatherSurfaceChecks(deviceGather(device())).checks)
    EXPECT_TRUE(check.passed()) << check.name << ": " << check.figure << " at " << check.where;
}

TEST_F(GatherLightTest, LightsOfAllKindsMatchTheOracle) {
  Scene scene = cloud(32);
  scene.classification.densityScale *= 5.0;
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  const glm::dvec3 inside(scene.volume.indexToWorld * glm::dvec4(20.2, 21.4, 9.7, 1.0));
  FrameSettings settings = gathering({48, 48});
  settings.lighting = Lighting{.lights = {{.place = {0.3, 1.0, 0.2}, .color = {1.0, 0.8, 0.5}},
                                          {.place = {1.0, 0.7, 0.9}, .atInfinity = false, .intensity = 6.0},
                                          {.place = inside, .atInfinity = false, .color = {0.1, 0.2, 0.3}, .intensity = 0.1},
                                          {.place = {-1.0, 0.1, -0.2}, .intensity = 2.0}},
                               .tint = {0.5, 1.0, 2.0},
                               .phaseG = 0.4,
                               .scattering = kAllOrders};
  EXPECT_GE(qualityOf(scene, camera, settings), 38.0);
  settings.lod = 1.0f;
  settings.lighting->scattering = 1;
  Camera distant = camera;
  distant.position = camera.lookAt + 5.0 * (camera.position - camera.lookAt);
  EXPECT_GE(qualityOf(scene, distant, settings), 33.0);  // as without lights: some ten pixels
}

/// With a tint, and of an environment, which have a channel for each colour; beside a light, and of scalars.
/// Ambient light, and that of a sky with a sun, by gathering and by splats: from far away, and from within the volume's box.
TEST_F(GatherLightTest, LightFromEverywhereMatchesTheOracle) {
  Scene scene = cloud(20);
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  const Lighting uniform{.ambient = {0.9, 0.7, 0.5}};
  Lighting tinted = uniform, sky;
  tinted.tint = {0.5, 1.0, 2.0};
  sky.lights = {{.place = {1.0, 0.2, 0.4}}};
  sky.scattering = kAllOrders;
  sky.environment = std::make_shared<Environment>(makeSky(16));
  FrameSettings settings = gathering({32, 32});
  for (const Lighting& lighting : {tinted, sky}) {
    settings.lighting = lighting;
    EXPECT_GE(qualityOf(scene, camera, settings), 42.0);
  }
  QualityScene head = makeQualityScene({"head", QualityColor::Bone, false}, 20, makeProcedural("head", 20));
  head.classification.order = ClassificationOrder::Post;
  settings.lighting = uniform;
  EXPECT_GE(qualityOf({.volume = head.volume, .classification = head.classification}, framingCamera(head.volume, 35.0, 25.0, 1.0, {}), settings), 30.0);
}

/// Ambient light is computed again if the tint changes, and kept if only its colour does.
TEST_F(GatherLightTest, ChangedLightFromEverywhereIsFoundAgain) {
  const Scene scene = cloud(32);
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  Renderer renderer(device(), scene.volume, scene.classification, {});
  FrameSettings settings = gathering({64, 64});
  settings.gather().sampleTolerance = 0.0f;  // which rays are interpolated depends on the light
  settings.lighting = Lighting{.ambient = glm::dvec3(0.5)};
  const Image half = renderer.render(camera, settings);
  settings.lighting->ambient = glm::dvec3(1.0);
  const Image whole = renderer.render(camera, settings);
  for (std::size_t i = 0; i < half.pixels.size(); ++i)
    EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(glm::vec3(2.0f * half.pixels[i] - whole.pixels[i])), glm::vec3(1e-5f)))) << i;
  settings.lighting->tint = {0.5, 1.0, 2.0};
  EXPECT_LT(psnr(renderer.render(camera, settings), whole), 45.0);
  settings.lighting = Lighting{.ambient = glm::dvec3(0.5)};
  EXPECT_TRUE(renderer.render(camera, settings).pixels == half.pixels);
}

/// Of volumes with more voxels than a texel buffer can have, quads, gradients and rays are read by their addresses. Rays of the view along
/// a corner end at the borders of a full volume after different numbers of slices. The samples of the image fit into one.
TEST_F(GatherLightTest, MoreVoxelsThanTexelsGiveTheSameImage) {
  const Device limited(instance(), "", {.texels = 1 << 15});
  const QualityScene head = makeQualityScene({"head", QualityColor::Bone, false}, 48, makeProcedural("head", 48));
  const glm::ivec3 n(43, 38, 41);
  const Volume fog = makeVolume(n, cubeTransform(n), [](int x, int y, int z) { return 0.2 + 0.02 * ((x * 7 + y * 5 + z * 3) % 11); });
  const Lighting lighting{.lights = {{.place = {1.0, 0.2, 0.5}}}, .ambient = glm::dvec3(0.1), .surface = 1.0};
  for (const Volume* volume : {&head.volume, &fog})
    for (const ClassificationOrder order : {ClassificationOrder::Pre, ClassificationOrder::Post}) {
      Classification classification = volume == &fog ? coloured(fog, 0.1f) : head.classification;
      classification.order = order;
      Renderer texels(device(), *volume, classification, {}), addresses(limited, *volume, classification, {});
      for (const std::optional<Lighting>& lit : {std::optional<Lighting>(), std::optional(lighting)}) {
        FrameSettings settings = gathering({64, 64});
        settings.lighting = lit;
        const Camera camera = framingCamera(*volume, 42.0, 33.0, 1.0, {});
        EXPECT_GT(psnr(addresses.render(camera, settings), texels.render(camera, settings)), 100.0);
      }
    }
}

/// What was shaded for one light or for none is not shown with another.
TEST_F(GatherLightTest, ChangedLightsAreShadedAgain) {
  const Volume volume = makeProcedural("cloud", 32);
  const Classification classification{.densityScale = automaticDensityScale(volume, 2.0)};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  Renderer renderer(device(), volume, classification, {});
  FrameSettings settings = gathering({64, 64});
  const Image unlit = renderer.render(camera, settings);
  settings.lighting = Lighting{.lights = {{.place = {1.0, 0.2, 0.0}}}};
  const Image right = renderer.render(camera, settings);
  settings.lighting->lights[0].place = {-1.0, 0.2, 0.0};
  const Image left = renderer.render(camera, settings);
  EXPECT_LT(psnr(left, right), 40.0);
  EXPECT_LT(psnr(unlit, right), 40.0);
  settings.lighting->lights[0].place = {1.0, 0.2, 0.0};
  EXPECT_TRUE(renderer.render(camera, settings).pixels == right.pixels);
  settings.lighting.reset();
  EXPECT_TRUE(renderer.render(camera, settings).pixels == unlit.pixels);
}

}  // namespace
}  // namespace freevoxels
