// Lit images on the device: against the double-precision reference, against closed forms, and what lights
// do to each other.

#include <cmath>
#include <numbers>

#include "engine/attenuation/ray_sweep.h"
#include "engine/reference/reference_light.h"
#include "engine/reference/reference_sorted.h"
#include "engine/renderer_stages.h"
#include "engine/validation/sky_environment.h"
#include "engine/volume/subject.h"
#include "tests/device/splat_fixture.h"

namespace freevoxels {
namespace {

/// One of each kind, all of which scatter forwards.
Lighting everything() {
  return {.lights =
              {{.place = {1.0, 0.7, 0.2}, .color = {1.0, 0.6, 0.3}, .intensity = 9.0},
               {.place = {-0.9, 0.4, 1.2}, .atInfinity = false, .color = {0.2, 0.5, 1.0}, .intensity = 20.0}},
          .ambient = {0.2, 0.25, 0.3},
          .phaseG = 0.4,
          .attenuation = LightAttenuation::Table};
}

class LightingTest : public SplatTest {
 protected:
  static std::vector<glm::dvec3> colours(Renderer& renderer, const Camera& camera, FrameSettings settings,
                                         const Lighting& lighting) {
    settings.lighting = lighting;
    std::vector<glm::dvec3> result;
    for (const SplatSums& sums : RendererStages(renderer).renderSums(camera, settings)) result.push_back(sums.color);
    return result;
  }
  static double largest(const std::vector<glm::dvec3>& colours) {
    double result = 0.0;
    for (const glm::dvec3& c : colours) result = std::max({result, c.x, c.y, c.z});
    return result;
  }
};

/// Small balls far from each other, whose scalars are 0.9 in a box of 0.2: a function that shows 0.5 alone shows their shells.
Volume balls(glm::ivec3 dimensions, double beside) {
  return makeVolume(dimensions, shearedTransform(dimensions), [&](int x, int y, int z) {
    for (const glm::dvec3 middle : {glm::dvec3(9.0, 30.0, 12.0), glm::dvec3(47.0, 8.0, 40.0), glm::dvec3(30.0, 33.0, 61.0)})
      if (glm::distance(glm::dvec3(x, y, z), middle) < 5.5) return 0.9;
    return beside;
  });
}

/// Sources of all kinds, one of them in a ball's shadow inside the volume; without cells all rays look at all voxels.
TEST_F(LightingTest, RaysThatPassOverEmptyCellsHaveTheSameBits) {
  const glm::ivec3 dimensions(61, 45, 70);
  const Volume medium = balls(dimensions, 0.0), scan = balls(dimensions, 0.2);
  const Classification density{.densityScale = 0.4};
  Classification shells;
  shells.transferFunction = TransferFunction{.opacity = {{0.0f, 0.0f}, {0.4f, 0.0f}, {0.5f, 0.3f}, {0.6f, 0.0f}, {1.0f, 0.0f}},
                                             .color = {{0.0f, glm::vec3(1.0f)}},
                                             .unitDistance = scan.voxelSize()};
  shells.order = ClassificationOrder::Post;
  using Case = std::pair<const Volume*, const Classification*>;
  for (const auto& [volume, classification] : {Case(&medium, &density), Case(&scan, &shells)}) {
    std::vector<StageTime> times;
    const BuiltVolume built = buildVolume(device(), *volume, *classification, times);
    const OccupiedCells cells(device(), metCells(*volume, *classification, OccupiedCells::kEdge));
    const bool scalars = built.volume.scalarBricks.has_value();
    EXPECT_EQ(scalars, volume == &scan);
    const auto nearOnes = std::ranges::count(spread(cells.met(), -1, 1).values, 1);
    EXPECT_GT(nearOnes, 0);
    EXPECT_LT(nearOnes, 3 * std::ptrdiff_t(cells.met().values.size()) / 4);
    for (const RaySource& source :
         {RaySource{.place = {1.0, 0.3, -0.8}, .atInfinity = true}, RaySource{.place = {0.0, 0.0, 1.0}, .atInfinity = true},
          RaySource{.place = {-20.0, 60.0, 30.0}}, RaySource{.place = {25.3, 20.1, 33.7}}}) {
      RaySweep sweep(device());
      const RayCodes all = sweep.sweep(built.volume, source, scalars), passing = sweep.sweep(built.volume, source, scalars, &cells);
      EXPECT_EQ(all, passing);
      std::uint16_t largest = 0;
      for (const std::vector<std::uint16_t>& face : all)
        if (!face.empty()) largest = std::max(largest, *std::ranges::max_element(face));
      EXPECT_GT(largest, 0);
    }
  }
}

TEST_F(LightingTest, EveryKindOfLightMatchesTheReference) {
  const Volume v = volume(true);
  for (const Composite composite : {Composite::Normalised, Composite::Additive})
    expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.25, {}),
                    {.size = {75, 60}, .method = SplatSettings{.composite = composite}, .lighting = everything()});
}

TEST_F(LightingTest, EveryLookUpMatchesTheReference) {
  const Volume v = volume(true);
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  expectSameImage(v, camera, {.size = {50, 50}, .method = SplatSettings{}, .lighting = everything()});
  expectSameImage(v, camera, {.size = {50, 50}, .method = SplatSettings{}, .lighting = everything()},
                  {.directions = DirectionSet::Directions98});
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {.orthographic = true}),
                  {.size = {50, 50},
                   .method = SplatSettings{.composite = Composite::Additive, .attenuation = AttenuationLookup::Nearest, .gradient = false},
                   .lighting = everything()},
                  {AttenuationCode::Linear8, false});
}

TEST_F(LightingTest, SurfacesMatchTheReference) {
  const Volume v = volume(true);
  Lighting lighting = everything();
  lighting.surface = 0.8;
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting});
}

/// For every look-up, with surfaces and an environment, and several orders of scattering.
TEST_F(LightingTest, TintsMatchTheReference) {
  const Volume v = volume(true);
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  Lighting lighting = everything();
  lighting.tint = {0.4, 1.0, 2.5};
  lighting.surface = 0.5;
  lighting.scattering = 3;
  lighting.environment = std::make_shared<Environment>(makeSky(64));
  expectSameImage(v, camera, {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting});
  expectSameImage(v, camera, {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting}, {.code = AttenuationCode::Linear8});
  lighting.attenuation = LightAttenuation::Exact;
  expectSameImage(v, camera, {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting});
}

TEST_F(LightingTest, ATintLetsNothingThroughAnOpaqueWall) {
  constexpr int kEdge = 24;
  const glm::ivec3 n(kEdge);
  const Volume v = makeVolume(n, cubeTransform(n), [](int x, int, int) {
    return x < 4 ? 0.5 : x < 12 ? 100.0 * kEdge : 0.0;
  });
  Renderer renderer(device(), v, {.densityScale = 1.0, .albedo = glm::vec3(1.0f)}, {});
  const Camera camera{
      .position = {-3, 0, 0}, .lookAt = {0, 0, 0}, .orthographic = true, .orthographicHeight = 1.0};
  for (const LightAttenuation attenuation : {LightAttenuation::Table, LightAttenuation::Exact}) {
    const Lighting lighting{
        .lights = {{.place = {1, 0, 0}}}, .tint = glm::dvec3(kMinTint), .attenuation = attenuation};
    for (const glm::vec4& pixel : renderer.render(camera, {.size = {24, 24}, .method = SplatSettings{}, .lighting = lighting}).pixels)
      EXPECT_LT(pixel.r, 1e-3f);
  }
}

/// A sky whose sun is from the side; and turned.
TEST_F(LightingTest, EnvironmentsMatchTheReference) {
  const Volume v = volume(true);
  Lighting lighting = everything();
  auto sky = std::make_shared<Environment>(makeSky(64));
  sky->rotation = 77.0;
  lighting.environment = sky;
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting});
  lighting.lights.clear();
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting},
                  {.directions = DirectionSet::Directions98});
}

/// One renderer takes them in turn.
TEST_F(LightingTest, AConstantEnvironmentIsAmbientLight) {
  const Volume v = volume(true);
  Renderer renderer(device(), v, coloured(v), {});
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  const FrameSettings settings{.size = {40, 40}, .method = SplatSettings{}};
  const auto constant = std::make_shared<Environment>(
      Environment{.size = {2, 1}, .radiance = {glm::vec3(0.5f), glm::vec3(0.5f)}, .intensity = 3.0});
  const Lighting exact{.lights = {}, .attenuation = LightAttenuation::Exact};
  Lighting ambient = exact, around = exact;
  ambient.ambient = glm::dvec3(1.5);
  around.environment = constant;
  const auto dark = colours(renderer, camera, settings, exact);
  EXPECT_EQ(largest(dark), 0.0);
  const auto expected = colours(renderer, camera, settings, ambient);
  const auto found = colours(renderer, camera, settings, around);
  EXPECT_GT(largest(expected), 0.0);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], expected[i][c], 1e-6 * expected[i][c] + 1e-30);
  EXPECT_EQ(largest(colours(renderer, camera, settings, exact)), 0.0);
}

TEST_F(LightingTest, LightsInsideMatchTheReference) {
  const Volume v = volume(false);
  Lighting lighting = everything();
  lighting.lights = {
      {.place = {0.05, 0.12, -0.08}, .atInfinity = false, .intensity = 2.0},
      {.place = {-0.2, 0.1, 0.1}, .atInfinity = false, .color = {1.0, 0.0, 0.0}, .intensity = 2.0}};
  expectSameImage(v, framingCamera(v, -110.0, -40.0, 1.0, {}), {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting});
}

TEST_F(LightingTest, ExactLightsMatchTheReference) {
  const Volume v = volume(true);
  Lighting lighting = everything();
  lighting.attenuation = LightAttenuation::Exact;
  lighting.lights.push_back({.place = {0.05, 0.12, -0.08}, .atInfinity = false, .intensity = 0.2});
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {50, 50}, .method = SplatSettings{}, .lighting = lighting});
}

/// Turning the camera sweeps nothing again, moving a light does. The gather makes no table without ambient light.
TEST_F(LightingTest, ExactLightsAreSweptOnceWhileTheyStandStill) {
  const Volume v = volume(false);
  Renderer renderer(device(), v, coloured(v), {});
  FrameSettings settings{.size = {20, 20}, .lighting = Lighting{}};
  settings.lighting->lights.resize(2);
  settings.lighting->attenuation = LightAttenuation::Exact;
  const auto sweeps = [&](double azimuth) {
    renderer.render(framingCamera(v, azimuth, 25.0, 1.0, {}), settings);
    std::vector<std::string> names;
    for (const StageTime& time : renderer.timings()) names.push_back(time.name);
    EXPECT_EQ(std::ranges::count(names, "attenuation sweeps"), 0);
    return std::ranges::count(names, "light sweep");
  };
  EXPECT_EQ(sweeps(0.0), 1);
  EXPECT_EQ(sweeps(40.0), 0);
  settings.lighting->lights[1].place.x += 0.1;
  EXPECT_EQ(sweeps(40.0), 1);
}

TEST_F(LightingTest, AutoShadowsExactlyWhereTheEyeIsNotLookedUpNearest) {
  const Volume v = volume(true);
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  Renderer renderer(device(), v, coloured(v), {});
  const auto pixels = [&](LightAttenuation attenuation, std::size_t lights, AttenuationLookup lookup = AttenuationLookup::Bilinear) {
    Lighting lighting{.lights = std::vector<Light>(lights), .attenuation = attenuation};
    for (std::size_t i = 0; i < lights; ++i) lighting.lights[i].place = {double(i) - 1.4, 0.7, 0.3};
    return renderer.render(camera, {.size = {32, 32}, .method = SplatSettings{.attenuation = lookup}, .lighting = lighting}).pixels;
  };
  using enum LightAttenuation;
  for (const std::size_t lights : {4u, 6u}) {  // found at samples, and by voxel
    ASSERT_NE(pixels(Table, lights), pixels(Exact, lights));
    EXPECT_EQ(pixels(Auto, lights), pixels(Exact, lights));
  }
  EXPECT_EQ(pixels(Auto, 1, AttenuationLookup::Nearest), pixels(Table, 1, AttenuationLookup::Nearest));
}

/// Where the table of a volume finds room and rays of its lights do not; the same in every frame.
TEST_F(LightingTest, AutoShadowsByTheTableWhereMemoryIsShort) {
  const Volume v = makeVolume(glm::ivec3(96), cubeTransform(glm::ivec3(96)), [](int x, int y, int z) {
    return x < 8 && y < 8 && z < 8 ? 1.0 : kInactiveVoxel;
  });
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  FrameSettings settings{.size = {32, 32}, .method = SplatSettings{}, .lighting = Lighting{.lights = {{}}}};
  const auto lightSweeps = [&](std::uint64_t memoryLimit) {
    const Device limited(instance(), "", {.memory = memoryLimit});
    Renderer renderer(limited, v, coloured(v), {});
    const Image first = renderer.render(camera, settings);
    const auto sweeps = std::ranges::count(renderer.timings(), "light sweep", &StageTime::name);
    EXPECT_EQ(renderer.render(camera, settings).pixels, first.pixels) << memoryLimit;
    return sweeps;
  };
  constexpr std::uint64_t kMiB = 1 << 20;
  const std::uint64_t rays = rayBytes(v.dimensions, lightSource(Light{}, v.indexToWorld));
  ASSERT_GT(rays, 4 * kMiB);
  EXPECT_EQ(lightSweeps(64 * kMiB), 1);
  EXPECT_EQ(lightSweeps(4 * rays - kMiB), 0);
}

TEST_F(LightingTest, SortedImagesMatchTheReference) {
  const Volume v = volume(true);
  const Classification classification = coloured(v, 0.5f);
  const auto extinction = referenceExtinction(v, classification);
  const auto table = referenceTable(v, extinction, {});
  const FrameSettings settings{.size = {50, 50}, .method = SplatSettings{.composite = Composite::Sorted}, .lighting = everything()};
  const ScatteredField scattered = referenceScattering(ScatteringMedium(v, classification), *settings.lighting);
  const ReferenceLight light(
      {.volume = v, .extinction = extinction, .table = table, .coarser = {}, .tableSettings = {}, .scattered = &scattered}, settings);
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  Renderer renderer(device(), v, classification, {});
  const Image image = renderer.render(camera, settings);
  const Image expected = referenceSortedImage(v, classification, camera, settings, referenceVisibleVoxels(extinction), &light);
  EXPECT_LE(largestPixelDifference(image, expected), 5e-3);
  EXPECT_GE(psnr(image, expected), 65.0);
}

TEST_F(LightingTest, BlocksMatchTheReference) {
  const Volume v = volume(true);
  const Classification classification = coloured(v, 0.5f);
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  const FrameSettings settings{.size = {30, 30}, .method = SplatSettings{.culling = false}, .lod = 9.0f, .lighting = everything()};
  Renderer renderer(device(), v, classification, {});
  const Image image = renderer.render(camera, settings);
  const std::vector<Block> blocks = RendererStages(renderer).downloadDrawnBlocks();
  ASSERT_GT(blocks.front().level, 0);
  const std::vector<LevelData> levels = RendererStages(renderer).downloadLevels();
  const std::vector<float> device = RendererStages(renderer).downloadExtinction();
  const std::vector<double> extinction(device.begin(), device.end());
  const std::optional<ScatteredField> scattered = RendererStages(renderer).downloadScattered();
  ASSERT_TRUE(scattered);
  const auto sums = referenceBlockSums(v, classification,
                                       {.extinction = extinction,
                                        .table = RendererStages(renderer).downloadTable(),
                                        .tableSettings = {},
                                        .coarser = levels,
                                        .scattered = &*scattered},
                                       camera, settings, blocks);
  EXPECT_GE(psnr(image, referenceResolve(sums, settings)), 90.0);
}

TEST_F(LightingTest, TwoLightsAreTheSumOfEachAlone) {
  const Volume v = volume(false);
  Renderer renderer(device(), v, coloured(v), {});
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  const FrameSettings settings{.size = {40, 40}, .method = SplatSettings{}};
  for (const LightAttenuation attenuation : {LightAttenuation::Table, LightAttenuation::Exact}) {
    Lighting both = everything();
    both.attenuation = attenuation;
    std::array<Lighting, 3> parts{both, both, both};
    for (std::size_t i = 0; i < 2; ++i) {
      parts[i].lights = {both.lights[i]};
      parts[i].ambient = glm::dvec3(0.0);
    }
    parts[2].lights.clear();
    std::vector<glm::dvec3> alone;
    for (const Lighting& one : parts) {
      const auto sums = colours(renderer, camera, settings, one);
      if (alone.empty()) alone.resize(sums.size(), glm::dvec3(0.0));
      for (std::size_t i = 0; i < sums.size(); ++i) alone[i] += sums[i];
    }
    const auto together = colours(renderer, camera, settings, both);
    ASSERT_GT(largest(together), 0.0);
    for (std::size_t i = 0; i < together.size(); ++i)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(together[i][c], alone[i][c], 1e-5 * alone[i][c] + 1e-30);
  }
}

TEST_F(LightingTest, ALightThatMovesAwayDimsWithTheSquareOfItsDistance) {
  const Volume v = makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), v, {}, {});
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  const glm::dvec3 place(1.0, 2.0, -0.7);
  const auto lit = [&](double far) {
    return largest(colours(renderer, camera, {.size = {20, 20}, .method = SplatSettings{}},
                           {.lights = {{.place = far * place, .atInfinity = false}}, .phaseG = 0.6}));
  };
  const double near = lit(1.0);
  ASSERT_GT(near, 0.0);
  for (const double far : {2.0, 3.5, 10.0}) EXPECT_NEAR(lit(far) * far * far / near, 1.0, 1e-5);
}

/// A light from behind the eye, from the side and from beyond: along a ray through a homogeneous box what it
/// scatters is known.
TEST_F(LightingTest, AHomogeneousBoxScattersWhatTheClosedFormsSay) {
  constexpr int kEdge = 32;
  constexpr double kDepth = 2.0, kPhaseG = 0.3;
  const glm::ivec3 n(kEdge);
  const Volume v = makeVolume(n, cubeTransform(n), [](int, int, int) { return 1.0; });
  const Classification classification{.densityScale = kDepth, .albedo = glm::vec3(0.5f)};
  Renderer renderer(device(), v, classification, {});
  const Camera camera{
      .position = {0, 0, 3}, .lookAt = {0, 0, 0}, .orthographic = true, .orthographicHeight = 1.0};
  const auto middle = [&](glm::dvec3 direction, LightAttenuation attenuation) {
    const Lighting lighting{.lights = {{.place = direction}}, .phaseG = kPhaseG, .attenuation = attenuation};
    const FrameSettings settings{.size = {33, 33}, .method = SplatSettings{}, .lighting = lighting};
    return double(renderer.render(camera, settings).pixels[33 * 16 + 16].r);
  };
  const auto scattered = [](double cosine) {
    return 0.5 * kDefaultIrradiance * phaseFunction(kPhaseG, cosine);
  };
  for (const LightAttenuation by : {LightAttenuation::Table, LightAttenuation::Exact}) {
    EXPECT_NEAR(middle({0, 0, 1}, by) / (scattered(-1.0) * (1.0 - std::exp(-2.0 * kDepth)) / 2.0), 1.0, 5e-3);
    // All of these voxels have one depth to the light, 1, of which half a code of the table is 0.0157.
    EXPECT_NEAR(
        middle({1, 0, 0}, by) / (scattered(0.0) * std::exp(-kDepth / 2.0) * (1.0 - std::exp(-kDepth))), 1.0,
        by == LightAttenuation::Table ? 0.016 : 1e-3);
    EXPECT_NEAR(middle({0, 0, -1}, by) / (scattered(1.0) * kDepth * std::exp(-kDepth)), 1.0, 5e-3);
  }
}

/// What is nowhere shadowed looks in ambient light of radiance 1 as it does without lights.
TEST_F(LightingTest, AThinVolumeIsAsBrightInAmbientLightAsUnlit) {
  const Volume v = volume(true);
  Renderer renderer(device(), v, {.densityScale = 1e-4}, {});
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  const Image unlit = renderer.render(camera, {.size = {40, 40}, .method = SplatSettings{}});
  const Image lit =
      renderer.render(camera, {.size = {40, 40}, .method = SplatSettings{}, .lighting = Lighting{.ambient = glm::dvec3(1.0)}});
  for (std::size_t i = 0; i < lit.pixels.size(); ++i)
    EXPECT_NEAR(lit.pixels[i].r, unlit.pixels[i].r, 2e-3 * unlit.pixels[i].r);
}

}  // namespace
}  // namespace freevoxels
