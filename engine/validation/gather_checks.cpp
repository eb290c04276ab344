#include "engine/validation/gather_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/reference/reference_gather.h"
#include "engine/reference/reference_hierarchy.h"
#include "engine/reference/reference_refinement.h"
#include "engine/reference/reference_scattering.h"
#include "engine/renderer_stages.h"
#include "engine/validation/gather_sample_checks.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// Half a step of the 11 bits that a half has, and of 9 bits.
constexpr double kExtinctionTolerance = 5e-4, kSourceTolerance = 2e-3;
/// Optical depths of a voxel that halves hold with fewer bits.
constexpr double kMinDepth = 1e-6;
constexpr double kPitchTolerance = 1e-6;
/// Steps of the codes of 16 bits, of the rays and of the blocks.
constexpr double kLightCodeTolerance = 3.0 / 65535.0;
/// Half a step of 8 bits and a sign, which may be of up to twice the largest component.
constexpr double kGradientTolerance = 1.0 / 255.0;
constexpr double kSampleTolerance = 1e-4, kStencilTolerance = 2e-5;
constexpr double kImageTolerance = 1e-5, kDistanceTolerance = 1e-4;
/// The tolerance of scalars, which may round to the next interval of the transfer function's table, or to more or less than the least change
/// whose mean is an integral.
constexpr double kScalarTolerance = 3e-3;
/// Of the largest value: iterations on the device end at kScatteringTolerance.
constexpr double kScatteredTolerance = 1e-2;
/// Within this part of the tolerance and 16 rounding errors of 24 bits, of which a fourth difference has as many, the device may find a
/// cell rough or smooth.
constexpr double kRoughnessBand = 1e-3, kRoughnessRounding = 16.0 / double(1 << 23);
/// Least tolerance for the check of adaptive sampling: that of a homogeneous volume would be no more than rounding.
constexpr double kLeastRoughness = 1e-4;
/// Second difference of distances, in voxels, that is as rough as the tolerance.
constexpr double kRoughVoxels = 2.0;
constexpr double kRefinementTolerance = 1e-4;
/// At which rays end where their early end is checked.
constexpr float kEndTransmittance = 0.5f;
enum class View { Framed, Orthographic, Inside, Wide, Near };
enum class Light { None, FromBehind, AllKinds, Surfaces };

struct Frame {
  const char* name;
  ClassificationOrder order = ClassificationOrder::Pre;
  View view = View::Framed;
  float lod = 0.0f;
  Composite composite = Composite::Normalised;
  Light light = Light::None;
};
constexpr std::array<Frame, 8> kFrames{
    {{"perspective"},
     {.name = "orthographic, additive", .view = View::Orthographic, .composite = Composite::Additive},
     {.name = "eye inside", .view = View::Inside},
     {.name = "rays along several axes", .view = View::Wide},
     {.name = "levels of detail", .view = View::Near, .lod = 8.0f},
     {.name = "classified after", .order = ClassificationOrder::Post},
     {.name = "classified after, eye inside", .order = ClassificationOrder::Post, .view = View::Inside},
     {.name = "classified after, levels of detail", .order = ClassificationOrder::Post, .view = View::Near, .lod = 8.0f}}};

constexpr std::array<Frame, 9> kLitFrames{
    {{.name = "lit from behind", .light = Light::FromBehind},
     {.name = "lights of all kinds", .light = Light::AllKinds},
     {.name = "lights of all kinds, eye inside", .view = View::Inside, .light = Light::AllKinds},
     {.name = "lights of all kinds, levels of detail", .view = View::Near, .lod = 8.0f, .light = Light::AllKinds},
     {.name = "lit surfaces", .light = Light::Surfaces},
     {.name = "classified after, lit from behind", .order = ClassificationOrder::Post, .light = Light::FromBehind},
     {.name = "classified after, lights of all kinds", .order = ClassificationOrder::Post, .light = Light::AllKinds},
     {.name = "classified after, lights of all kinds, eye inside",
      .order = ClassificationOrder::Post,
      .view = View::Inside,
      .light = Light::AllKinds},
     {.name = "classified after, lit surfaces", .order = ClassificationOrder::Post, .light = Light::Surfaces}}};

std::optional<Lighting> lightingOf(const Volume& volume, Light light) {
  if (light == Light::None) return {};
  Lighting lighting{.attenuation = LightAttenuation::Exact};
  if (light == Light::FromBehind) lighting.lights = {{.place = {-1.0, -0.3, -1.0}}};
  if (light == Light::FromBehind) return lighting;
  const auto placed = [&](glm::dvec3 part) {
    return glm::dvec3(volume.indexToWorld * glm::dvec4(part * glm::dvec3(volume.dimensions), 1.0));
  };
  lighting.ambient = {0.3, 0.4, 0.5};
  lighting.lights = {{.place = {1.0, 0.4, 0.2}, .color = {1.0, 0.8, 0.6}, .intensity = 3.0},
                     {.place = placed({1.6, -0.7, 0.4}), .atInfinity = false, .color = {0.4, 0.7, 1.0}, .intensity = 4.0}};
  if (light == Light::AllKinds) {
    lighting.lights.push_back({.place = placed({0.46, 0.57, 0.53}), .atInfinity = false, .intensity = 0.1});
    lighting.tint = {0.7, 1.0, 1.6};
    lighting.phaseG = 0.4;
    lighting.scattering = kAllOrders;
  } else {
    lighting.surface = 0.8;
  }
  return lighting;
}

/// Near: perspective makes near voxels several times as large on the image as far ones. Wide: no ray's largest component is
/// that of all others.
Camera cameraOf(const Volume& volume, View view, double aspect) {
  Camera camera = framingCamera(volume, kDefaultAzimuth, kDefaultElevation, aspect, {.orthographic = view == View::Orthographic});
  if (view == View::Inside || view == View::Wide) camera = cameraInside(volume, camera);
  if (view == View::Wide) camera.verticalFov = 110.0;
  if (view == View::Near) {
    const glm::dvec3 diagonal = glm::dmat3(volume.indexToWorld) * glm::dvec3(volume.dimensions);
    camera.position = camera.lookAt + 0.6 * glm::length(diagonal) * glm::normalize(camera.position - camera.lookAt);
    camera.verticalFov = 60.0;
  }
  return camera;
}

Check checkLattice(const GatherLattice& lattice, const GatherLattice& reference, const char* frame) {
  MaxError worst;
  const auto where = [&] {
    return fmt::format("{} x {} samples, reference {} x {}", lattice.samples.x, lattice.samples.y, reference.samples.x,
                       reference.samples.y);
  };
  worst.take(relativeDifference(lattice.pitch, reference.pitch), where);
  worst.take(glm::length(lattice.first - reference.first) / double(reference.samples.x), where);
  if (lattice.samples != reference.samples) worst.take(1.0, where);
  return worst.atMost(kPitchTolerance, fmt::format("gather lattice: {}", frame), "relative");
}

/// Checks the blocks of all levels that the frame reads.
void checkBlocks(const GatherStages& stages, const ValidationScene& scene, const Frame& frame, std::vector<Check>& checks) {
  MaxError extinction, source, emission;
  const double least = kMinDepth / scene.volume.voxelSize();
  for (std::size_t level = 0; level < stages.blocks.size(); ++level) {
    const GatherBlocks& blocks = stages.blocks[level];
    if (!blocks.exists()) continue;
    LevelData medium = stages.medium[level];
    if (level == 0) medium = referenceVoxelLevel(scene.volume, scene.classification, medium.extinction, {}, medium.emission);
    const GatherBlocks expected =
        referenceGatherBlocks(medium, int(level), scene.volume.dimensions, scene.classification.albedo, frame.light != Light::None);
    FV_CHECK_EQ(blocks.extinction.size(), expected.extinction.size());
    FV_CHECK_EQ(blocks.emission.size(), expected.emission.size());
    for (std::size_t i = 0; i < blocks.extinction.size(); ++i) {
      const auto where = [&] {
        const glm::ivec3 n = blocks.dimensions;
        return fmt::format("block ({}, {}, {}) of level {}", int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y, level);
      };
      extinction.take(std::abs(blocks.extinction[i] - expected.extinction[i]) / std::max(expected.extinction[i], least), where);
      const auto apart = [&](glm::dvec3 stored, glm::dvec3 wanted) {
        return largestComponent(glm::abs(stored - wanted)) / std::max(largestComponent(wanted), least);
      };
      source.take(apart(blocks.source[i], expected.source[i]), where);
      if (!expected.emission.empty()) emission.take(apart(blocks.emission[i], expected.emission[i]), where);
    }
  }
  checks.push_back(extinction.atMost(kExtinctionTolerance, fmt::format("gather blocks: extinction, {}", frame.name), "relative"));
  checks.push_back(source.atMost(kSourceTolerance, fmt::format("gather blocks: source, {}", frame.name), "relative"));
  if (scene.classification.emission && frame.light != Light::None)
    checks.push_back(emission.atMost(kSourceTolerance, fmt::format("gather blocks: emission, {}", frame.name), "relative"));
}

/// Checks what the frame's samples read of the light, of all levels that it reads. The depths of scalars come from a sweep that is checked
/// elsewhere.
void checkLight(const GatherStages& stages, const ValidationScene& scene, const ReferenceGather& reference, const Lighting& lighting,
                const char* frame, std::vector<Check>& checks) {
  MaxError depth, gradient;
  for (std::size_t level = 0; level < stages.light.size(); ++level) {
    const GatherLight& light = stages.light[level];
    const bool scalars = level == 0 && reference.hasScalars();
    const glm::ivec3 n = (scene.volume.dimensions + (1 << level) - 1) >> int(level);
    const auto where = [&](std::size_t i) {
      return fmt::format("block ({}, {}, {}) of level {}", int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y, level);
    };
    for (std::size_t l = 0; l < light.depths.size() && !scalars; ++l) {
      const std::vector<double> expected =
          referenceLightDepths(scene.volume, stages.medium.front().extinction, stages.medium[level], int(level), lighting.lights[l]);
      FV_CHECK_EQ(light.depths[l].size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        depth.take(std::abs(std::sqrt(light.depths[l][i]) - std::sqrt(expected[i])) / std::sqrt(kOpaqueDepth), [&] { return where(i); });
    }
    const std::vector<glm::dvec3> expected =
        light.gradients.empty() ? std::vector<glm::dvec3>()
                                : referenceGradients(scalars ? reference.scalars() : stages.medium[level].extinction, n, scalars);
    for (std::size_t i = 0; i < expected.size(); ++i)
      gradient.take(largestComponent(glm::abs(light.gradients[i] - expected[i])) / std::max(largestComponent(glm::abs(expected[i])), 1e-3),
                    [&] { return where(i); });
  }
  if (!reference.hasScalars())
    checks.push_back(depth.atMost(kLightCodeTolerance, fmt::format("gather light: depths, {}", frame), "of the largest, as roots"));
  if (lighting.surface > 0.0)
    checks.push_back(gradient.atMost(kGradientTolerance, fmt::format("gather light: gradients, {}", frame), "relative"));
}

void checkImage(const Image& image, const Image& reference, const std::string& stage, const char* frame,
                std::vector<Check>& checks) {
  checks.push_back(largestDifference(image, reference).atMost(kImageTolerance, fmt::format("{}: RGBA, {}", stage, frame)));
  const auto isCompared = [&](std::size_t i) { return reference.pixels[i].a >= float(kMinComparedEnergy); };
  double farthest = 0.0;
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if (isCompared(i) && std::isfinite(reference.depth[i])) farthest = std::max(farthest, double(reference.depth[i]));
  MaxError worst;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const double found = image.depth[i], expected = reference.depth[i];
    if (isCompared(i) && found != expected)
      worst.take(std::isfinite(expected) ? std::abs(found - expected) / std::max(expected, kErrorFloor * farthest) : expected,
                 [&] { return pixelText(image.size, i); });
  }
  checks.push_back(worst.atMost(kDistanceTolerance, fmt::format("{}: distance, {}", stage, frame), "relative"));
}

/// A ray whose transmittance falls to that at which rays end counts as opaque; all others are whole. `samples` are of whole rays.
Check checkEnd(GatherOutputs& device, const Camera& camera, const FrameSettings& whole, const std::vector<GatherSums>& samples,
               double tolerance, bool shines, const char* frame) {
  FrameSettings settings = whole;
  settings.gather().endTransmittance = kEndTransmittance;
  const GatherStages stages = device.frame(camera, settings);
  MaxError worst;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double expected = samples[i].energy, energy = stages.gathered[i].energy;
    double difference = std::abs(energy - expected) / std::max(expected, kErrorFloor);
    // Volumes that shine have rays of a lower transmittance: what is behind them may be brighter than 1.
    const bool ends = 1.0 - expected < kEndTransmittance * (1.0 - tolerance) && !shines;
    const bool mayEnd = 1.0 - expected < kEndTransmittance * (1.0 + tolerance);
    const double ofEnded = std::abs(energy - 1.0);
    if (mayEnd) difference = ends ? ofEnded : std::min(difference, ofEnded);
    worst.take(difference, [&] { return sampleText(stages.lattice.samples, i); });
  }
  return worst.atMost(tolerance, fmt::format("gather samples: E with rays that end early, {}", frame), "relative");
}

/// Adaptive sampling with the median roughness of C and E as the tolerance, or kLeastRoughness. All samples of `all` are marched.
void checkRefinement(GatherOutputs& device, const Camera& camera, const FrameSettings& whole, double voxelSize, const GatherStages& all,
                     const char* frame, std::vector<Check>& checks) {
  const glm::ivec2 extent = all.lattice.samples;
  const ReferenceRefinement reference(all.gathered, extent);
  std::vector<double> rough;
  for (const ReferenceRoughness& roughness : reference.roughness())
    if (roughness.color > 0.0) rough.push_back(roughness.color);
  if (rough.empty()) return;
  std::ranges::nth_element(rough, rough.begin() + std::ptrdiff_t(rough.size() / 2));
  FrameSettings settings = whole;
  settings.gather().sampleTolerance = float(std::max(rough[rough.size() / 2], kLeastRoughness));
  const GatherStages adaptive = device.frame(camera, settings);
  const double tolerance = double(settings.gather().sampleTolerance), band = kRoughnessBand * tolerance + kRoughnessRounding;
  std::vector<GatherSums> expected = all.gathered;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const glm::ivec2 sample(int(i) % extent.x, int(i) / extent.x);
    const std::optional<double> found = reference.roughnessOfCell(sample, tolerance, kRoughVoxels * voxelSize);
    if (!found || *found > tolerance + band) continue;
    const GatherSums between = reference.interpolated(sample);
    const auto apart = [&](const GatherSums& sums) {
      const GatherSums& drawn = adaptive.gathered[i];
      return glm::length(sums.color - drawn.color) + std::abs(sums.energy - drawn.energy) + std::abs(sums.distance - drawn.distance);
    };
    if (*found < tolerance - band || apart(between) < apart(expected[i])) expected[i] = between;
  }
  checkSums(adaptive.gathered, expected, extent, kRefinementTolerance, "gather refinement", frame, checks);
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

void checkFrame(GatherOutputs& device, const ValidationScene& scene, const Classification& classification, const Frame& frame,
                glm::ivec2 size, ReportSection& section) {
  const FrameSettings settings{.size = size,
                               .method = GatherSettings{.endTransmittance = 0.0f, .sampleTolerance = 0.0f},
                               .lod = frame.lod,
                               .depth = true,
                               .lighting = lightingOf(scene.volume, frame.light)};
  const Camera camera = cameraOf(scene.volume, frame.view, double(size.x) / size.y);
  const GatherStages stages = device.frame(camera, settings);
  const ReferenceGather reference(scene.volume, classification, camera, settings, stages.scattered);
  section.checks.push_back(checkLattice(stages.lattice, reference.lattice(), frame.name));
  if (stages.lattice.samples != reference.lattice().samples) return;
  if (std::ranges::any_of(stages.blocks, &GatherBlocks::exists)) checkBlocks(stages, scene, frame, section.checks);
  if (settings.lighting) checkLight(stages, scene, reference, *settings.lighting, frame.name, section.checks);
  if (stages.scattered)
    section.checks.push_back(checkScattered(*stages.scattered, scene.volume, classification, *settings.lighting, frame.name));
  const double tolerance = reference.hasScalars() ? kScalarTolerance : kSampleTolerance;
  const std::vector<GatherSums> samples = comparedSamples(reference, stages, tolerance, size);
  checkSums(stages.gathered, samples, stages.lattice.samples, tolerance, "gather samples", frame.name, section.checks);
  if (reference.adapts()) checkRefinement(device, camera, settings, scene.volume.voxelSize(), stages, frame.name, section.checks);
  if (!reference.hasScalars()) {
    const std::vector<GatherSums> smoothed = reference.smoothed(stages.gathered);
    checkSums(stages.smoothed, smoothed, stages.lattice.samples, kStencilTolerance, "gather stencil", frame.name, section.checks);
  }
  checkImage(stages.image, reference.image(reference.hasScalars() ? stages.gathered : stages.smoothed), "gather image", frame.name,
             section.checks);
  section.checks.push_back(checkEnd(device, camera, settings, samples, tolerance, classification.emission.has_value(), frame.name));
  section.imageRows.push_back(comparedImages(stages.image, reference.image(reference.smoothed(samples)),
                                             fmt::format("Frame: {}", frame.name), "reference, from the device's blocks"));
}

constexpr const char* kExplanation =
    "Every stage of the gather on the device against a double-precision version on the CPU that is given what the device made "
    "in the stage before: blocks as they are stored, the sums of the lattice's samples, the sums after the stencil, and the "
    "image. Sums are relative to the sample's own, or to 5 % of the largest where that is more. Rays go on to the end of the "
    "volume, but for the check of their early end, where they are to end at a transmittance of a half. All of them are marched, "
    "but for the check of adaptive sampling, whose tolerance is the median roughness.";

constexpr const char* kLightExplanation =
    "As above, with lights whose depths are interpolated at the samples, in a volume without empty voxels: where rays skip empty blocks "
    "the device takes another depth at the block after them, which the reference does not. Depths towards lights and gradients of "
    "surfaces, as they are stored, are compared too.";

class RendererGather : public GatherOutputs {
 public:
  RendererGather(const Device& device, const Volume& volume, const Classification& classification)
      : renderer_(device, volume, classification, {}) {}
  GatherStages frame(const Camera& camera, const FrameSettings& settings) override {
    return RendererStages(renderer_).renderGatherStages(camera, settings);
  }

 private:
  Renderer renderer_;
};

}  // namespace

GatherMaker deviceGather(const Device& device) {
  return [&device](const Volume& volume, const Classification& classification) {
    return std::make_unique<RendererGather>(device, volume, classification);
  };
}

namespace {

/// Draws those of the frames that the scene allows.
template <std::size_t Count>
void checkFrames(const GatherMaker& make, const ValidationScene& scene, const std::array<Frame, Count>& frames, glm::ivec2 size,
                 ReportSection& section) {
  for (const ClassificationOrder order : {ClassificationOrder::Pre, ClassificationOrder::Post}) {
    Classification classification = scene.classification;
    classification.order = order;
    if (order == ClassificationOrder::Post && !classification.isPost(scene.volume)) continue;
    const auto device = make(scene.volume, classification);
    for (const Frame& frame : frames)
      if (frame.order == order) checkFrame(*device, scene, classification, frame, size, section);
  }
}

}  // namespace

ReportSection gatherChecks(const GatherMaker& make, const ValidationScene& scene, glm::ivec2 size) {
  ReportSection section{.title = fmt::format("Gather: {}", scene.name), .text = kExplanation};
  checkFrames(make, scene, kFrames, size, section);
  return section;
}

ReportSection gatherLightChecks(const GatherMaker& make, glm::ivec2 size) {
  const glm::ivec3 n(17, 14, 12);
  const Volume waves = makeVolume(n, shearedTransform(n), [](int x, int y, int z) {
    return 0.5 + 0.2 * std::sin(0.9 * x + 0.4 * z) + 0.15 * std::cos(0.7 * y - 0.5 * x) + 0.1 * std::sin(1.1 * z + 0.3 * y);
  });
  ValidationScene scene{.name = "waves that fill the volume", .volume = waves, .classification = {}};
  scene.classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, 0.02f}, {0.45f, 0.1f}, {0.7f, 0.6f}, {1.0f, 0.7f}},
                       .color = {{0.0f, {0.9f, 0.3f, 0.2f}}, {0.5f, {0.3f, 0.8f, 0.4f}}, {1.0f, {0.5f, 0.5f, 1.0f}}},
                       .unitDistance = waves.voxelSize()};
  ReportSection section{.title = "Gather: lights at samples", .text = kLightExplanation};
  checkFrames(make, scene, kLitFrames, size, section);
  return section;
}

ReportSection gatherEmissionChecks(const GatherMaker& make, glm::ivec2 size) {
  const glm::ivec3 n(17, 14, 12);
  Volume embers = makeVolume(n, shearedTransform(n), [](int x, int y, int z) { return 0.5 + 0.3 * std::sin(0.9 * x + 0.4 * z - 0.6 * y); });
  embers.temperature = TemperatureGrid{.name = "embers", .values = ScalarBricks::make(n, [](glm::ivec3 voxel) {
                                                           return float(1400.0 + 500.0 * std::cos(0.5 * voxel.x + 0.3 * voxel.y));
                                                         })};
  summariseValues(*embers.temperature);
  ValidationScene scene{.name = "embers that fill the volume", .volume = embers, .classification = {}};
  scene.classification = {.densityScale = automaticDensityScale(embers, 2.0), .albedo = glm::vec3(0.8f, 0.5f, 0.3f)};
  scene.classification.emission = Emission{.strength = 0.25 * automaticEmissionStrength(embers, scene.classification, {})};
  ReportSection section{.title = "Gather: emission at samples that are lit", .text = kLightExplanation};
  checkFrames(make, scene, kLitFrames, size, section);
  return section;
}

}  // namespace freevoxels
