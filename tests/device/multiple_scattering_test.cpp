// Light of all orders beside path-traced images (tests/path_traced/README.md), and against the equations solved on the CPU.

#include "engine/image/flip.h"
#include "engine/lighting/scattering_solver.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/sky_environment.h"
#include "engine/volume/vdb.h"
#include "tests/device/splat_fixture.h"

namespace freevoxels {
namespace {

class MultipleScatteringTest : public SplatTest {
 protected:
  /// The largest error of a solution of the device, relative to its largest value.
  double errorOf(const Volume& volume, const Classification& classification, const Lighting& lighting, ScatteringSolver* solver = nullptr) {
    std::vector<StageTime> times;
    ScatteringSolver own(device(), ScatteringMedium(volume, classification));
    ScatteringSolver& used = solver != nullptr ? *solver : own;
    used.solve(lighting, 0, times, {});
    const ScatteredField found = used.download(), expected = referenceScattering(used.medium(), lighting, 1e-6);
    double worst = 0.0;
    for (std::size_t i = 0; i < expected.mean.size(); ++i) worst = std::max(worst, glm::length(found.mean[i] - expected.mean[i]));
    for (std::size_t i = 0; i < expected.fluxes.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) worst = std::max(worst, glm::length(found.fluxes[i][axis] - expected.fluxes[i][axis]));
    EXPECT_EQ(found.fluxes.size(), expected.fluxes.size());
    return worst / expected.brightest();
  }
};

double meanOf(const Image& image) {
  double sum = 0.0;
  for (const glm::vec4& pixel : image.pixels) sum += pixel.r + pixel.g + pixel.b;
  return sum / (3.0 * double(image.pixels.size()));
}

/// One light or several, of all kinds, colours, a sky, a phase function, a tint, and boxes of odd sizes and other cells than cubes.
TEST_F(MultipleScatteringTest, TheDeviceSolvesTheEquationsThatTheReferenceSolves) {
  const Volume cloud = makeProcedural("cloud", 32);
  const Classification white{.densityScale = 20.0, .albedo = glm::vec3(0.99f)};
  const Lighting sun{.lights = {{.place = {1.0, 0.4, 0.2}}}, .scattering = kAllOrders};
  EXPECT_LT(errorOf(cloud, white, sun), 0.01);
  Lighting all = sun;
  all.lights.push_back({.place = {0.1, 0.05, -0.1}, .atInfinity = false, .color = {1.0, 0.5, 0.2}, .intensity = 0.3});
  all.environment = std::make_shared<Environment>(makeSky(16));
  all.tint = {0.6, 1.0, 1.5};
  const Volume odd = randomVolume({19, 7, 34}, shearedTransform({19, 7, 34}), 0.6, 3.0);
  EXPECT_LT(errorOf(odd, {.densityScale = 0.3, .albedo = {0.99f, 0.8f, 0.5f}}, all), 0.01);
  all.surface = 0.7;
  EXPECT_LT(errorOf(odd, {.densityScale = 0.3, .albedo = {0.99f, 0.8f, 0.5f}}, all), 0.01);
  all.surface = 0.0;
  all.phaseG = 0.7;
  EXPECT_LT(errorOf(cloud, white, all), 0.01);
  all.phaseG = -0.5;
  EXPECT_LT(errorOf(odd, {.densityScale = 0.3, .albedo = {0.99f, 0.8f, 0.5f}}, all), 0.01);
}

/// Rays along an axis pass through the centres of cells, so that direct light has no error of interpolation.
TEST_F(MultipleScatteringTest, AGivenNumberOfOrdersIsThatManyIterations) {
  const Volume cloud = makeProcedural("cloud", 24);
  ScatteringSolver solver(device(), ScatteringMedium(cloud, {.densityScale = 20.0, .albedo = glm::vec3(0.99f)}));
  Lighting lighting{.lights = {{.place = {1.0, 0.0, 0.0}}}, .ambient = glm::dvec3(0.2)};
  for (const int orders : {1, 2, 7}) {
    lighting.scattering = orders;
    EXPECT_LT(errorOf(cloud, {}, lighting, &solver), 1e-4) << orders;
    EXPECT_EQ(solver.facts().sets, orders);
  }
}

/// Whatever was solved before.
TEST_F(MultipleScatteringTest, TheSameLightHasTheSameBits) {
  const Volume cloud = makeProcedural("cloud", 40);
  const Classification white{.densityScale = 30.0, .albedo = glm::vec3(0.995f)};
  ScatteringSolver solver(device(), ScatteringMedium(cloud, white));
  std::vector<StageTime> times;
  Lighting lighting{.lights = {{.place = {1.0, 0.4, 0.2}}}, .scattering = kAllOrders};
  solver.solve(lighting, 0, times, {});
  const ScatteredField first = solver.download();
  const std::uint64_t version = solver.version();
  solver.solve(lighting, 0, times, {});
  EXPECT_EQ(solver.version(), version);
  Lighting other = lighting;
  other.lights[0].place = {-1.0, 0.3, 0.5};
  solver.solve(other, 0, times, {});
  EXPECT_NE(solver.download().mean, first.mean);
  solver.solve(lighting, 0, times, {});
  EXPECT_EQ(solver.download().mean, first.mean);
}

TEST_F(MultipleScatteringTest, ADraftsLightIsNearThatOfTheWholeImage) {
  const Volume cloud = makeProcedural("cloud", 40);
  ScatteringSolver solver(device(), ScatteringMedium(cloud, {.densityScale = 20.0, .albedo = glm::vec3(0.9f)}));
  std::vector<StageTime> times;
  const Lighting lighting{.lights = {{.place = {1.0, 0.4, 0.2}}}, .ambient = glm::dvec3(0.2), .scattering = kAllOrders};
  const auto solved = [&](int coarseness) {
    solver.solve(lighting, coarseness, times, {});
    return solver.download();
  };
  const auto meanOf = [](const ScatteredField& field) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& light : field.mean) sum += light;
    return sum / double(field.mean.size());
  };
  const ScatteredField whole = solved(0), draft = solved(1);
  EXPECT_EQ(draft.edge, 2 * whole.edge);
  EXPECT_EQ(draft.cells, (whole.cells + 1) / 2);
  EXPECT_NEAR(meanOf(draft).g / meanOf(whole).g, 1.0, 0.05);
  EXPECT_EQ(solved(0).mean, whole.mean);
  EXPECT_EQ(solver.medium().grid().edge, whole.edge);
  solved(1000);
  EXPECT_LE(solver.medium().grid().count(), 512u) << "on the fewest cells that there are";
}

/// Thick and white: the equation's spectral radius is nearly 1.
TEST_F(MultipleScatteringTest, AThickWhiteCloudTakesTheWorkOfTwelveFineSets) {
  const Volume cloud = makeProcedural("cloud", 40);
  for (const double scale : {1.0, 20.0, 80.0}) {
    ScatteringSolver solver(device(), ScatteringMedium(cloud, {.densityScale = scale, .albedo = glm::vec3(0.999f)}));
    std::vector<StageTime> times;
    solver.solve({.lights = {{.place = {1.0, 0.4, 0.2}}}, .scattering = kAllOrders}, 0, times, {});
    EXPECT_LE(solver.facts().residual, kScatteringTolerance);
    EXPECT_LE(solver.facts().work, 12.0) << scale;
  }
}

struct PathTraced {
  const char* name;  ///< of the image; up to the first _ that of the volume
  double densityScale;
  glm::vec3 albedo;
  double g;
  glm::dvec3 toLight;  ///< 0: a sky of radiance 1
  double irradiance;
  double flip, least, most;  ///< largest LDR-FLIP of images whose largest value is 1, and range of brightness relative to the path tracer's
};

void PrintTo(const PathTraced& image, std::ostream* stream) {
  *stream << image.name;
}

constexpr glm::vec3 kWhite(0.99f), kWhitest(0.999f), kRed(0.99f, 0.9f, 0.7f);
constexpr glm::dvec3 kKey(-0.32, 0.85, 0.42), kSide(1.0, 0.2, -0.3), kBack(-0.5, 0.4, -1.0), kSky(0.0);

Image scaled(Image image, float factor) {
  for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(factor * glm::vec3(pixel), 1.0f);
  return image;
}

Image readTruth(const std::string& name) {
  return readExr(std::filesystem::path(FREEVOXELS_PATH_TRACED) / (name + ".exr"));
}

class PathTracedImage : public SplatTest, public testing::WithParamInterface<PathTraced> {
 protected:
  struct Shown {
    Volume volume;
    Camera camera;
  };
  /// Nothing where a file is not there.
  static std::optional<Shown> shown(const std::string& volume) {
    if (volume == "cloud") return Shown{makeProcedural("cloud", 48), {.position = {1.2, 0.8, 1.6}, .lookAt = {0.0, -0.05, 0.0}}};
    const bool smoke = volume == "smoke";
    const std::filesystem::path file = std::filesystem::path(FREEVOXELS_DATA_DIR) / (smoke ? "smoke1.vdb" : "wdas_cloud_sixteenth.vdb");
    if (!std::filesystem::exists(file)) return {};
    const Camera camera = smoke ? Camera{.position = {119.476190, 125.047619, 169.619048}, .lookAt = {-7.380952, 35.190476, 0.476190}}
                                : Camera{.position = {604.3333, 482.3333, 776.3333}, .lookAt = {-11.6667, 46.0, -45.0}};
    return Shown{readVdb(file, "density", std::uint64_t(1) << 30), camera};
  }
};

TEST_P(PathTracedImage, IsMatchedInBrightnessAndLooks) {
  const PathTraced& wanted = GetParam();
  const std::string name = wanted.name;
  const std::optional<Shown> shown = this->shown(name.substr(0, name.find('_')));
  if (!shown) GTEST_SKIP() << "the volume is not there";
  const Image truth = readTruth(name);
  Renderer renderer(device(), shown->volume, {.densityScale = wanted.densityScale, .albedo = wanted.albedo}, {});
  Lighting lighting{.phaseG = wanted.g, .attenuation = LightAttenuation::Exact, .scattering = kAllOrders};
  if (wanted.toLight == kSky)
    lighting.ambient = glm::dvec3(1.0);
  else
    lighting.lights = {{.place = wanted.toLight, .intensity = wanted.irradiance}};
  const Image image = renderer.render(shown->camera, {.size = truth.size, .lighting = lighting});
  float brightest = 0.0f;
  for (const glm::vec4& pixel : truth.pixels) brightest = std::max({brightest, pixel.r, pixel.g, pixel.b});
  const double ratio = meanOf(image) / meanOf(truth);
  const double flip = ldrFlip(scaled(image, 1.0f / brightest), scaled(truth, 1.0f / brightest)).mean();
  RecordProperty("brightness", std::to_string(ratio));
  RecordProperty("flip", std::to_string(flip));
  EXPECT_LT(flip, wanted.flip);
  EXPECT_GT(ratio, wanted.least);
  EXPECT_LT(ratio, wanted.most);
}

constexpr double k4Pi = kDefaultIrradiance;
/// The two thick ones are limited by their cells: a voxel of cloud_white has an optical depth of up to 1.7, a cell of wdas_white up to 2.3.
INSTANTIATE_TEST_SUITE_P(Of, PathTracedImage,
                         testing::Values(PathTraced{"cloud_key", 20.0, kWhite, 0.0, kKey, k4Pi, 0.012, 0.98, 1.02},
                                         PathTraced{"cloud_side", 20.0, kWhite, 0.0, kSide, k4Pi, 0.012, 0.98, 1.02},
                                         PathTraced{"cloud_back", 20.0, kWhite, 0.0, kBack, k4Pi, 0.012, 0.98, 1.02},
                                         PathTraced{"cloud_white", 80.0, kWhitest, 0.0, kKey, k4Pi, 0.026, 0.94, 1.03},
                                         PathTraced{"cloud_red", 20.0, kRed, 0.0, kKey, k4Pi, 0.012, 0.98, 1.02},
                                         PathTraced{"cloud_g60", 20.0, kWhite, 0.6, kBack, k4Pi, 0.03, 0.97, 1.03},
                                         PathTraced{"cloud_g60_key", 20.0, kWhite, 0.6, kKey, k4Pi, 0.03, 0.97, 1.03},
                                         PathTraced{"cloud_g85", 60.0, kWhite, 0.85, kSide, k4Pi, 0.05, 0.97, 1.03},
                                         PathTraced{"cloud_sky", 20.0, kWhite, 0.0, kSky, 0.0, 0.02, 0.98, 1.02},
                                         PathTraced{"wdas_key", 0.0779221, kWhite, 0.0, kKey, 3.0, 0.014, 0.98, 1.02},
                                         PathTraced{"wdas_back", 0.0779221, kWhite, 0.0, kBack, 6.0, 0.02, 0.98, 1.02},
                                         PathTraced{"wdas_white", 0.2337662, kWhitest, 0.0, kKey, 3.0, 0.027, 0.97, 1.03},
                                         PathTraced{"smoke_key", 0.1135135, kWhite, 0.0, kKey, 8.0, 0.014, 0.98, 1.02},
                                         PathTraced{"smoke_back", 0.1135135, kWhite, 0.0, kBack, 8.0, 0.014, 0.98, 1.02}),
                         [](const auto& image) { return std::string(image.param.name); });

/// The temperature at which a voxel emits this luminance.
float temperatureOf(double luminance, const Emission& emission) {
  if (luminance <= 0.0) return 0.0f;
  double low = 0.0, high = 20000.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const double there = glm::dot(emittedLight(emission, float(middle)), glm::dvec3(0.2126, 0.7152, 0.0722));
    (there < luminance ? low : high) = middle;
  }
  return float(high);
}

/// Fire in its own smoke. Black bodies have colours, which the grey medium keeps, so that luminances are compared.
TEST_F(MultipleScatteringTest, SmokeIsLitByTheFireInItAsByAPathTracer) {
  const Image truth = readTruth("fire");
  const glm::ivec3 n(32);
  const auto place = [](int x, int y, int z) { return (glm::dvec3(x, y, z) + 0.5) / 32.0 - 0.5; };
  Volume volume = makeVolume(n, cubeTransform(n),
                             [&](int x, int y, int z) { return std::clamp((0.45 - glm::length(place(x, y, z))) / 0.08, 0.0, 1.0); });
  const Emission emission{.strength = 1.0};
  volume.temperature = TemperatureGrid{.name = "", .values = ScalarBricks::make(n, [&](glm::ivec3 v) {
                                                     const double r = glm::length(place(v.x, v.y, v.z) - glm::dvec3(0.1, -0.1, 0.05));
                                                     return temperatureOf(30.0 * std::clamp((0.15 - r) / 0.05, 0.0, 1.0), emission);
                                                   })};
  summariseValues(*volume.temperature);
  Renderer renderer(device(), volume, {.densityScale = 12.0, .albedo = glm::vec3(0.8f), .emission = emission}, {});
  const Camera camera{.position = {1.2, 0.8, 1.6}, .lookAt = {0.0, -0.05, 0.0}};
  Image image = renderer.render(camera, {.size = truth.size, .lighting = Lighting{.scattering = kAllOrders}});
  for (glm::vec4& pixel : image.pixels)
    pixel = glm::vec4(glm::vec3(glm::dot(glm::vec3(pixel), glm::vec3(0.2126f, 0.7152f, 0.0722f))), 1.0f);
  const double ratio = meanOf(image) / meanOf(truth), flip = ldrFlip(image, scaled(truth, 1.0f)).mean();
  EXPECT_LT(flip, 0.04);
  EXPECT_NEAR(ratio, 1.0, 0.03);
}

}  // namespace
}  // namespace freevoxels
