#include "engine/validation/light_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/image/metrics.h"
#include "engine/reference/oracle.h"
#include "engine/renderer.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/max_error.h"
#include "engine/validation/quality_images.h"
#include "engine/validation/sky_environment.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

constexpr double kBallRadius = 3.0;  ///< voxels
/// The fraction of the light that a ball takes from the fog that may be missing beside its shadow. A shadow
/// in voxels is wider than the ball's by the footprints of the fog.
constexpr double kMaxBeside = 0.1;
constexpr double kMaxLeak = 1e-3;
constexpr int kSkyRows = 128;

struct Shadows {
  const char* name;
  LightAttenuation attenuation;
  double goal;
};
constexpr std::array<Shadows, 2> kShadows{{{"table", LightAttenuation::Table, kTableLightPsnr},
                                           {"exact", LightAttenuation::Exact, kExactLightPsnr}}};

Lighting sideLight(LightAttenuation attenuation) {
  return {.lights = {{.place = {1.0, 1.0, 0.3}}}, .attenuation = attenuation};
}

/// A view from the side that shows all of a box of edge 1.
const Camera kBoxCamera{
    .position = {0.0, 0.0, 3.0}, .lookAt = {0.0, 0.0, 0.0}, .orthographic = true, .orthographicHeight = 1.0};

/// Fog of optical depth 0.2 with or without an opaque ball in the middle.
Volume foggyBall(int resolution, bool withBall) {
  const glm::ivec3 n(resolution);
  const glm::dvec3 middle = 0.5 * glm::dvec3(n - 1);
  return makeVolume(n, cubeTransform(n), [&](int x, int y, int z) {
    const double inside = kBallRadius + 0.5 - glm::length(glm::dvec3(x, y, z) - middle);
    return 0.2 + (withBall ? 8.0 * resolution * std::clamp(inside, 0.0, 1.0) : 0.0);
  });
}

/// The fraction of the missing light that is not behind the ball. `way` is the direction of the light in the
/// image, of length 1; the ball itself does not count.
double partBeside(const Image& fog, const Image& ball, int resolution, glm::dvec2 way) {
  double beside = 0.0, all = 0.0;
  for (int y = 0; y < fog.size.y; ++y)
    for (int x = 0; x < fog.size.x; ++x) {
      const auto pixel = std::size_t(x) + std::size_t(fog.size.x) * std::size_t(y);
      const glm::dvec2 place =
          double(resolution) *
          ((glm::dvec2(x, -y) + glm::dvec2(0.5, -0.5)) / double(fog.size.x) - glm::dvec2(0.5, -0.5));
      if (glm::length(place) < kBallRadius + 2.0) continue;
      const double missing = std::abs(double(fog.pixels[pixel].r - ball.pixels[pixel].r));
      all += missing;
      const double across = std::abs(place.x * way.y - place.y * way.x);
      if (glm::dot(place, way) > 0.0 || across > kBallRadius + 2.0) beside += missing;
    }
  return all > 0.0 ? beside / all : 1.0;
}

void checkBall(const Device& device, int resolution, ReportSection& section) {
  const glm::dvec3 direction(1.0, 0.4, 0.2);
  const glm::dvec2 way = glm::normalize(glm::dvec2(direction));
  const Classification medium{.densityScale = 1.0};
  const Volume fogAlone = foggyBall(resolution, false), fogAndBall = foggyBall(resolution, true);
  Renderer fog(device, fogAlone, medium, {}), ball(device, fogAndBall, medium, {});
  ImageRow row{.caption = "A ball in fog", .images = {}};
  for (const Shadows& shadows : kShadows) {
    FrameSettings settings{.size = glm::ivec2(4 * resolution), .method = SplatSettings{}};
    settings.lighting = Lighting{.lights = {{.place = direction}}, .attenuation = shadows.attenuation};
    const Image empty = fog.render(kBoxCamera, settings), shaded = ball.render(kBoxCamera, settings);
    row.images.push_back({fmt::format("{}: {:g} times what is missing", shadows.name, kDifferenceGain), visibleDifference(empty, shaded)});
    const double beside = partBeside(empty, shaded, resolution, way);
    section.tables.front().rows.push_back({shadows.name, fmt::format("{:.3f}", beside)});
    if (shadows.attenuation == LightAttenuation::Exact)
      section.checks.push_back({.name = "a ball in fog: light that is missing beside its shadow, exact",
                                .figure = beside,
                                .tolerance = kMaxBeside,
                                .unit = "of all that is missing",
                                .where = ""});
  }
  section.imageRows.push_back(std::move(row));
}

/// Scalar 1 in the wall of an opaque hollow ball, which is two voxels thick, 0.5 inside it; no data around
/// it.
Volume hollowBall(int resolution) {
  const glm::ivec3 n(resolution);
  const glm::dvec3 middle = 0.5 * glm::dvec3(n - 1);
  return makeVolume(n, cubeTransform(n), [&](int x, int y, int z) {
    const double radius = glm::length(glm::dvec3(x, y, z) - middle);
    const double outwards = radius - 0.35 * resolution;
    return outwards > 1.0 ? double(kInactiveVoxel) : outwards >= -1.0 ? 1.0 : 0.5;
  });
}

/// White fog and a black wall, so that only the fog's light shows.
Classification fogAndWall(const Volume& volume) {
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.5f, 0.005f}, {0.51f, 1.0f}},
                       .color = {{0.5f, glm::vec3(1.0f)}, {0.51f, glm::vec3(0.0f)}},
                       .unitDistance = volume.voxelSize()};
  return classification;
}

float brightest(const Image& image) {
  float result = 0.0f;
  for (const glm::vec4& pixel : image.pixels) result = std::max(result, pixel.r);
  return result;
}

void checkHollow(const Device& device, int resolution, ReportSection& section) {
  const Volume volume = hollowBall(resolution);
  Renderer renderer(device, volume, fogAndWall(volume), {});
  const Camera inside{.position = {0.02, 0.01, -0.03}, .lookAt = {-1.0, -0.7, -0.4}, .verticalFov = 100.0};
  const double unshadowed = double(brightest(renderer.render(inside, {.size = {48, 48}, .method = SplatSettings{}})));
  std::vector<Light> lights{{.place = {0.6, 1.1, -0.2}, .atInfinity = false}};
  for (const glm::dvec3 direction : {glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0), glm::dvec3(1, 1, 1),
                                     glm::dvec3(-1, 0.3, 0.6), glm::dvec3(0.2, -1, 0.45)})
    lights.push_back({.place = direction});
  for (const Shadows& shadows : kShadows) {
    MaxError worst;
    for (const Light& light : lights) {
      FrameSettings settings{.size = {48, 48}, .method = SplatSettings{}};
      settings.lighting = Lighting{.lights = {light}, .attenuation = shadows.attenuation};
      worst.take(double(brightest(renderer.render(inside, settings))) / unshadowed, [&] {
        return fmt::format("light at ({:g}, {:g}, {:g})", light.place.x, light.place.y, light.place.z);
      });
    }
    section.checks.push_back(
        worst.atMost(kMaxLeak, fmt::format("fog within an opaque hollow ball: light, {}", shadows.name),
                     "of the light outside"));
  }
}

/// The volume with 0 instead of no data: scanners measure air.
Volume filled(const Volume& volume) {
  return makeVolume(volume.dimensions, volume.indexToWorld, [&](int x, int y, int z) {
    const float scalar = volume.scalar(x, y, z);
    return scalar == kInactiveVoxel ? 0.0 : double(scalar);
  });
}

/// One way of lighting a scene.
struct LitCase {
  std::string name;
  Lighting lighting;
  double goal;              ///< least PSNR of the worst view, in dB
  double meanGoal = 0.0;    ///< least mean PSNR over the views; 0 if there is none
  decltype(FrameSettings::method) draw = SplatSettings{};
};

/// The oracle's images, which do not depend on how shadows are computed.
bool looksAlike(const Lighting& a, const Lighting& b) { return a.lights == b.lights && a.environment == b.environment; }

/// Images with each way of lighting.
void compareToOracle(const Device& device, const QualityScene& scene, std::span<const QualityView> views, int imageEdge,
                     const std::vector<LitCase>& cases, ReportSection& section) {
  ReportTable table{.caption = "PSNR against the oracle, dB", .columns = {"view"}, .rows = {}};
  Renderer renderer(device, scene.volume, scene.classification, {});
  section.checks.resize(cases.size());
  std::vector<double> sums(cases.size(), 0.0);
  for (const LitCase& lit : cases) table.columns.push_back(lit.name);
  for (const QualityView& view : views) {
    const Camera camera = viewCamera(scene.volume, view);
    Image oracle;
    ImageRow shown{.caption = viewText(view), .images = {}, .background = {}};
    std::vector<std::string> row{viewText(view)};
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (i == 0 || !looksAlike(cases[i].lighting, cases[i - 1].lighting)) {
        const OracleSettings truth{.size = glm::ivec2(imageEdge), .tolerance = 4e-3, .lighting = cases[i].lighting};
        oracle = renderOracle(scene.volume, scene.classification, camera, truth).image;
        shown.images.push_back({"oracle", oracle});
      }
      const FrameSettings settings{.size = glm::ivec2(imageEdge), .method = cases[i].draw, .lighting = cases[i].lighting};
      const Image image = renderer.render(camera, settings);
      const double psnr = compareImages(image, oracle).psnr;
      row.push_back(fmt::format("{:.1f}", psnr));
      sums[i] += psnr;
      shown.images.push_back({cases[i].name, image});
      shown.images.push_back(
          {fmt::format("{}: {:g} times the difference", cases[i].name, kDifferenceGain), visibleDifference(image, oracle)});
      if (table.rows.empty() || psnr < section.checks[i].figure)
        section.checks[i] = {.name = cases[i].name,
                             .figure = psnr,
                             .bound = Check::Bound::AtLeast,
                             .tolerance = cases[i].goal,
                             .unit = "dB",
                             .where = viewText(view)};
    }
    table.rows.push_back(std::move(row));
    section.imageRows.push_back(std::move(shown));
  }
  section.tables.push_back(std::move(table));
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (cases[i].meanGoal > 0.0)
      section.checks.push_back({.name = fmt::format("{}, mean of all views", cases[i].name),
                                .figure = sums[i] / double(views.size()),
                                .bound = Check::Bound::AtLeast,
                                .tolerance = cases[i].meanGoal,
                                .unit = "dB",
                                .where = ""});
}

}  // namespace

ReportSection lightQuality(const Device& device, const QualityScene& scene, int imageEdge) {
  ReportSection section{.title = fmt::format("Light: {}, {}x{} pixels", scene.name, imageEdge, imageEdge),
                        .text = "One light from the side. The oracle marches a shadow ray from every point of every ray."};
  std::vector<LitCase> cases;
  for (const Shadows& shadows : kShadows)
    cases.push_back(
        {fmt::format("lit, {} shadows", shadows.name), sideLight(shadows.attenuation), shadows.goal});
  cases.push_back({"lit, gathered", sideLight(LightAttenuation::Exact), kExactLightPsnr, 0.0, GatherSettings{}});
  const std::array<QualityView, 2> views{{{}, {.azimuth = 200.0, .elevation = -20.0}}};
  compareToOracle(device, scene, views, imageEdge, cases, section);
  return section;
}

ReportSection opaqueLightQuality(const Device& device, const QualityScene& scene, std::span<const QualityView> views, int imageEdge) {
  ReportSection section{.title = fmt::format("Light on what is opaque: {}, {}x{} pixels", scene.name, imageEdge, imageEdge),
                        .text = "Shadows are exact. The oracle marches a shadow ray from every point of every ray."};
  const std::vector<Light> lights{{.place = {1.0, 1.0, 0.3}, .intensity = 0.6 * kDefaultIrradiance},
                                  {.place = {-0.8, 0.3, 1.0}, .intensity = 0.3 * kDefaultIrradiance},
                                  {.place = {0.1, -1.0, -0.4}, .intensity = 0.3 * kDefaultIrradiance}};
  const Lighting one{.lights = {{.place = {1.0, 1.0, 0.3}}}, .attenuation = LightAttenuation::Exact};
  const Lighting three{.lights = lights, .attenuation = LightAttenuation::Exact};
  const QualityScene scan{.name = scene.name, .volume = filled(scene.volume), .classification = scene.classification};
  compareToOracle(device, scan, views, imageEdge,
                  {{"one light", one, kOpaqueWorstPsnr, kOpaqueMeanPsnr, GatherSettings{}},
                   {"three lights", three, kOpaqueWorstPsnr, kOpaqueMeanPsnr, GatherSettings{}}},
                  section);
  return section;
}

ReportSection environmentQuality(const Device& device, const QualityScene& scene, int imageEdge) {
  ReportSection section{.title = fmt::format("Light from all around: {}, {}x{} pixels", scene.name, imageEdge, imageEdge),
                        .text =
                            "A sky with a sun. The table has it from its 26 directions, the oracle "
                            "from 150."};
  const Lighting sky{.lights = {}, .environment = std::make_shared<Environment>(makeSky(kSkyRows))};
  const QualityView view;
  compareToOracle(device, scene, {&view, 1}, imageEdge, {{"lit by a sky", sky, kEnvironmentPsnr}}, section);
  return section;
}

ReportSection shadowChecks(const Device& device, int resolution) {
  ReportSection section{
      .title = "Light: shadows",
      .text =
          "A small ball in fog has one shadow. From the table it has four, along the directions around the "
          "light's, which only exact shadows do not show: there is no bound for the table's."};
  section.tables.push_back(
      {.caption = "A ball in fog: the part of the missing light that is beside its shadow",
       .columns = {"shadows", "part"},
       .rows = {}});
  checkBall(device, resolution, section);
  checkHollow(device, resolution, section);
  return section;
}

}  // namespace freevoxels
