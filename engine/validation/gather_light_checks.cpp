#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "engine/core/error.h"
#include "engine/reference/oracle.h"
#include "engine/reference/reference_gather.h"
#include "engine/reference/reference_scattering.h"
#include "engine/validation/gather_checks.h"
#include "engine/validation/gather_sample_checks.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// Steps of the codes of 16 bits, of the rays and of the blocks.
constexpr double kLightCodeTolerance = 3.0 / 65535.0;
/// Half a step of 8 bits and a sign, which may be of up to twice the largest component.
constexpr double kGradientTolerance = 1.0 / 255.0;
/// Largest relative difference of the sum of a channel's pixels from the oracle's, largest root mean square of the pixels' differences
/// relative to that of the pixels, and the oracle's own tolerance.
constexpr double kBrightnessTolerance = 1e-2, kPixelTolerance = 2e-2, kOracleTolerance = 4e-3;
/// Of the largest value: iterations on the device end at kScatteringTolerance.
constexpr double kScatteredTolerance = 1e-2;

enum class LitBy { FromBehind, AllKinds, AllOrders };
struct LitFrame {
  const char* name;
  LitBy light;
};
constexpr std::array<LitFrame, 2> kLitFrames{
    {{.name = "lit from behind", .light = LitBy::FromBehind}, {.name = "lights of all kinds", .light = LitBy::AllKinds}}};
constexpr std::array<LitFrame, 1> kScatteringFrames{{{.name = "light of all orders", .light = LitBy::AllOrders}}};

Lighting lightingOf(const Volume& volume, LitBy light) {
  Lighting lighting{.attenuation = LightAttenuation::Exact};
  if (light == LitBy::FromBehind) lighting.lights = {{.place = {-1.0, -0.3, -1.0}}};
  if (light == LitBy::FromBehind) return lighting;
  const auto placed = [&](glm::dvec3 part) {
    return glm::dvec3(volume.indexToWorld * glm::dvec4(part * glm::dvec3(volume.dimensions), 1.0));
  };
  if (light == LitBy::AllOrders) lighting.ambient = {0.3, 0.4, 0.5};
  lighting.lights = {{.place = {1.0, 0.4, 0.2}, .color = {1.0, 0.8, 0.6}, .intensity = 3.0},
                     {.place = placed({1.6, -0.7, 0.4}), .atInfinity = false, .color = {0.4, 0.7, 1.0}, .intensity = 4.0}};
  lighting.lights.push_back({.place = placed({0.4, 0.5, -1.2}), .atInfinity = false, .intensity = 2.0});
  lighting.tint = {0.7, 1.0, 1.6};
  lighting.phaseG = 0.4;
  if (light == LitBy::AllOrders) lighting.scattering = kAllOrders;
  return lighting;
}

/// Depths towards the lights as they are stored, of all levels that the frame reads. Those of scalars come from a sweep that is checked
/// elsewhere.
Check checkLightDepths(const GatherStages& stages, const ValidationScene& scene, bool scalars, const Lighting& lighting,
                       const char* frame) {
  MaxError depth;
  for (std::size_t level = scalars ? 1 : 0; level < stages.light.size(); ++level) {
    const GatherLight& light = stages.light[level];
    for (std::size_t l = 0; l < light.depths.size(); ++l) {
      const std::vector<double> expected =
          referenceLightDepths(scene.volume, stages.medium.front().extinction, stages.medium[level], int(level), lighting.lights[l]);
      FV_CHECK_EQ(light.depths[l].size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        depth.take(std::abs(std::sqrt(light.depths[l][i]) - std::sqrt(expected[i])) / std::sqrt(kOpaqueDepth),
                   [&] { return blockText(stages.medium[level].dimensions, i, level); });
    }
  }
  return depth.atMost(kLightCodeTolerance, fmt::format("gather light: depths, {}", frame), "of the largest, as roots");
}

/// Gradients as they are stored: of scalars, or of the extinction of voxels.
Check checkGradients(const GatherStages& stages, const ValidationScene& scene, const Classification& classification) {
  const bool scalars = classification.isPost(scene.volume);
  const std::vector<glm::dvec3>& gradients = stages.light.front().gradients;
  const std::vector<glm::dvec3> expected = referenceGradients(
      scalars ? referenceScalars(scene.volume, classification) : stages.medium.front().extinction, scene.volume.dimensions, scalars);
  FV_CHECK_EQ(gradients.size(), expected.size());
  MaxError worst;
  for (std::size_t i = 0; i < expected.size(); ++i)
    worst.take(largestComponent(glm::abs(gradients[i] - expected[i])) / std::max(largestComponent(glm::abs(expected[i])), 1e-3),
               [&] { return blockText(scene.volume.dimensions, i, 0); });
  return worst.atMost(kGradientTolerance, fmt::format("gather surfaces: gradients, {}", scene.name), "relative");
}

/// The light of all orders against the same equations solved on the CPU.
Check checkScattered(const ScatteredField& device, const Volume& volume, const Classification& classification, const Lighting& lighting,
                     const char* frame) {
  const ScatteredField expected = referenceScattering(ScatteringMedium(volume, classification), lighting);
  FV_CHECK_EQ(device.mean.size(), expected.mean.size());
  FV_CHECK_EQ(device.fluxes.size(), expected.fluxes.size());
  const double largest = expected.brightest();
  MaxError worst;
  for (std::size_t i = 0; i < expected.mean.size(); ++i) {
    const auto where = [&] { return fmt::format("cell {}", i); };
    worst.take(glm::length(device.mean[i] - expected.mean[i]) / largest, where);
    for (std::size_t axis = 0; axis < 3 && !expected.fluxes.empty(); ++axis)
      worst.take(glm::length(device.fluxes[i][axis] - expected.fluxes[i][axis]) / largest, where);
  }
  return worst.atMost(kScatteredTolerance, fmt::format("gather scattered: {}", frame), "of the largest");
}

/// The image beside the oracle's: the sum of each channel, and the root of the mean squared difference of pixels.
void checkAgainstOracle(const Image& image, const ValidationScene& scene, const Classification& classification, const Camera& camera,
                        const FrameSettings& settings, const char* frame, ReportSection& section) {
  const Oracle oracle =
      renderOracle(scene.volume, classification, camera,
                   {.size = settings.size, .tolerance = kOracleTolerance, .maximumSamples = 4, .lighting = settings.lighting});
  glm::dvec3 sum(0.0), expected(0.0), squares(0.0), expectedSquares(0.0);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 own(image.pixels[i]), wanted(oracle.image.pixels[i]);
    sum += own;
    expected += wanted;
    squares += (own - wanted) * (own - wanted);
    expectedSquares += wanted * wanted;
  }
  MaxError brightness, pixels;
  for (int c = 0; c < 3; ++c) {
    const auto where = [&] { return fmt::format("channel {}", c); };
    brightness.take(relativeDifference(sum[c], expected[c]), where);
    pixels.take(std::sqrt(squares[c] / expectedSquares[c]), where);
  }
  section.checks.push_back(brightness.atMost(kBrightnessTolerance, fmt::format("gather image: brightness, {}", frame), "of the oracle's"));
  section.checks.push_back(
      pixels.atMost(kPixelTolerance, fmt::format("gather image: pixels beside the oracle's, {}", frame), "of their root mean square"));
  section.imageRows.push_back(comparedImages(image, oracle.image, fmt::format("Frame: {}", frame), "oracle"));
}

void checkFrames(const GatherMaker& make, const ValidationScene& scene, ClassificationOrder order, std::span<const LitFrame> frames,
                 glm::ivec2 size, ReportSection& section) {
  Classification classification = scene.classification;
  classification.order = order;
  const auto device = make(scene.volume, classification);
  const Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, double(size.x) / size.y, {});
  for (const LitFrame& frame : frames) {
    const FrameSettings settings{.size = size,
                                 .method = GatherSettings{.endTransmittance = 0.0f, .sampleTolerance = 0.0f},
                                 .lod = 0.0f,
                                 .depth = true,
                                 .lighting = lightingOf(scene.volume, frame.light)};
    const GatherStages stages = device->frame(camera, settings);
    const ReferenceGather reference(scene.volume, classification, camera, settings);
    section.checks.push_back(checkLattice(stages.lattice, reference.lattice(), frame.name));
    if (std::ranges::any_of(stages.blocks, &GatherBlocks::exists)) checkBlocks(stages, scene, true, frame.name, section.checks);
    section.checks.push_back(checkLightDepths(stages, scene, reference.hasScalars(), *settings.lighting, frame.name));
    if (stages.scattered)
      section.checks.push_back(checkScattered(*stages.scattered, scene.volume, classification, *settings.lighting, frame.name));
    checkAgainstOracle(stages.image, scene, classification, camera, settings, frame.name, section);
  }
}

constexpr const char* kLightExplanation =
    "Lit frames: blocks, depths towards lights, gradients of surfaces and light of several orders as they are stored, against versions in "
    "double precision on the CPU, and the image against the oracle, which marches rays to the lights.";

/// 1 in the middle of a grid, 0 at its borders.
double falloff(glm::ivec3 voxel, glm::ivec3 size) {
  const glm::dvec3 place = (glm::dvec3(voxel) + 0.5) / glm::dvec3(size), rises = glm::sin(std::numbers::pi * place);
  return rises.x * rises.y * rises.z;
}

/// Dense enough for shadows, and smooth, so that the oracle and few rays agree.
Volume smoothFog() {
  const glm::ivec3 n(17, 15, 14);
  return makeVolume(n, shearedTransform(n), [n](int x, int y, int z) {
    return falloff({x, y, z}, n) * (0.7 + 0.2 * std::sin(0.5 * x + 0.3 * z) + 0.1 * std::cos(0.4 * y - 0.3 * x));
  });
}

ValidationScene coloredFog() {
  ValidationScene scene{.name = "smooth fog", .volume = smoothFog(), .classification = {}};
  scene.classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, 0.0f}, {1.0f, 0.12f}},
                       .color = {{0.0f, {0.9f, 0.3f, 0.2f}}, {0.5f, {0.3f, 0.8f, 0.4f}}, {1.0f, {0.5f, 0.5f, 1.0f}}},
                       .unitDistance = scene.volume.voxelSize()};
  return scene;
}

}  // namespace

ReportSection gatherLightChecks(const GatherMaker& make, glm::ivec2 size) {
  ReportSection section{.title = "Gather: lights at samples", .text = kLightExplanation};
  checkFrames(make, coloredFog(), ClassificationOrder::Pre, kLitFrames, size, section);
  return section;
}

ReportSection gatherScalarLightChecks(const GatherMaker& make, glm::ivec2 size) {
  ReportSection section{.title = "Gather: lights at samples of scalars", .text = kLightExplanation};
  checkFrames(make, coloredFog(), ClassificationOrder::Post, kLitFrames, size, section);
  return section;
}

ReportSection gatherScatteringChecks(const GatherMaker& make, glm::ivec2 size) {
  ValidationScene scene{.name = "smooth fog", .volume = smoothFog(), .classification = {}};
  scene.classification = {.densityScale = automaticDensityScale(scene.volume, 2.0), .albedo = glm::vec3(0.9f, 0.7f, 0.5f)};
  ReportSection section{.title = "Gather: light of all orders", .text = kLightExplanation};
  checkFrames(make, scene, ClassificationOrder::Pre, kScatteringFrames, size, section);
  return section;
}

ReportSection gatherEmissionChecks(const GatherMaker& make, glm::ivec2 size) {
  Volume embers = smoothFog();
  embers.temperature = TemperatureGrid{.name = "embers", .values = ScalarBricks::make(embers.dimensions, [](glm::ivec3 voxel) {
                                                           return float(1400.0 + 500.0 * std::cos(0.5 * voxel.x + 0.3 * voxel.y));
                                                         })};
  summariseValues(*embers.temperature);
  ValidationScene scene{.name = "embers in smooth fog", .volume = embers, .classification = {}};
  scene.classification = {.densityScale = automaticDensityScale(embers, 1.0), .albedo = glm::vec3(0.8f, 0.5f, 0.3f)};
  scene.classification.emission = Emission{.strength = 0.25 * automaticEmissionStrength(embers, scene.classification, {})};
  ReportSection section{.title = "Gather: emission at samples that are lit", .text = kLightExplanation};
  checkFrames(make, scene, ClassificationOrder::Pre, kLitFrames, size, section);
  return section;
}

namespace {

/// Opaque spheres in a box of kSphereBox voxels.
constexpr int kSphereBox = 48, kSpherePixelsPerVoxel = 4, kSpherePixels = kSphereBox * kSpherePixelsPerVoxel;
constexpr double kRadius = 20.0;  ///< voxels
constexpr int kFewestComparedPixels = 5000;

double insideSphere(int x, int y, int z) {
  return kRadius - glm::length(glm::dvec3(x, y, z) - 0.5 * (kSphereBox - 1));
}

ValidationScene sphereOfScalars() {
  const glm::ivec3 box(kSphereBox);
  ValidationScene scene{.name = "scalars", .volume = makeVolume(box, cubeTransform(box), insideSphere), .classification = {}};
  scene.classification.transferFunction = TransferFunction{
      .opacity = {{-0.5f, 0.0f}, {0.5f, 0.99f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = scene.volume.voxelSize()};
  scene.classification.order = ClassificationOrder::Post;
  return scene;
}

ValidationScene sphereOfDensities() {
  const glm::ivec3 box(kSphereBox);
  const auto density = [](int x, int y, int z) { return std::clamp(0.5 + insideSphere(x, y, z) / 3.0, 0.0, 1.0); };
  ValidationScene scene{
      .name = "densities", .volume = makeVolume(box, cubeTransform(box), density), .classification = {.albedo = glm::vec3(1.0f)}};
  scene.classification.densityScale = 3.0 / scene.volume.voxelSize();
  return scene;
}

/// Adds the mean and the largest relative error of a sphere's image, seen along -z, away from its rim and where light falls on it.
void checkSphere(const Image& image, glm::dvec3 toLight, double meanTolerance, double tolerance, const std::string& name,
                 std::vector<Check>& checks) {
  MaxError worst;
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < kSpherePixels; ++y)
    for (int x = 0; x < kSpherePixels; ++x) {
      const glm::dvec2 place = (glm::dvec2(x, kSpherePixels - 1 - y) - 0.5 * (kSpherePixels - 1)) / (kSpherePixelsPerVoxel * kRadius);
      if (glm::length(place) > 0.8) continue;
      const glm::dvec3 normal(place, std::sqrt(1.0 - glm::dot(place, place)));
      if (glm::dot(normal, toLight) < 0.3) continue;
      const double expected = kDefaultIrradiance * 0.5 * surfaceScattering(normal, toLight, glm::dvec3(0.0, 0.0, 1.0));
      const auto pixel = std::size_t(x + kSpherePixels * y);
      const double error = std::abs(double(image.pixels[pixel].g) / expected - 1.0);
      worst.take(error, [&] { return pixelText(image.size, pixel); });
      sum += error;
      ++count;
    }
  FV_CHECK_LT(kFewestComparedPixels, count);
  checks.push_back({.name = fmt::format("gather surfaces: mean, {}", name),
                    .figure = sum / count,
                    .tolerance = meanTolerance,
                    .unit = "relative",
                    .where = fmt::format("{} pixels", count)});
  checks.push_back(worst.atMost(tolerance, fmt::format("gather surfaces: largest, {}", name), "relative"));
}

}  // namespace

ReportSection gatherSurfaceChecks(const GatherMaker& make) {
  const ValidationScene scalars = sphereOfScalars(), densities = sphereOfDensities();
  Camera camera;
  camera.lookAt = glm::dvec3(scalars.volume.indexToWorld * glm::dvec4(glm::dvec3(0.5 * (kSphereBox - 1)), 1.0));
  camera.position = camera.lookAt + glm::dvec3(0.0, 0.0, 10.0);
  camera.orthographic = true;
  camera.orthographicHeight = kSphereBox * scalars.volume.voxelSize();
  const glm::dvec3 toLight = glm::normalize(glm::dvec3(-1.0, 1.0, 1.0));
  const FrameSettings settings{
      .size = glm::ivec2(kSpherePixels),
      .lod = 0.0f,
      .lighting = Lighting{.lights = {{.place = toLight}}, .surface = 1.0, .attenuation = LightAttenuation::Exact}};
  ReportSection section{.title = "Gather: surfaces",
                        .text =
                            "Opaque spheres of 4 pixels a voxel: away from their rims, what their surfaces send to the eye depends on "
                            "the normal alone, and is known in closed form. On the flank of the highlight 0.1 is a degree."};
  for (const ValidationScene* scene : {&scalars, &densities}) {
    const GatherStages stages = make(scene->volume, scene->classification)->frame(camera, settings);
    const bool ofScalars = scene == &scalars;
    checkSphere(stages.image, toLight, ofScalars ? 0.015 : 0.025, ofScalars ? 0.08 : 0.13, scene->name, section.checks);
    section.checks.push_back(checkGradients(stages, *scene, scene->classification));
  }
  return section;
}

}  // namespace freevoxels
