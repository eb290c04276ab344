#include "engine/validation/gather_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/reference/oracle.h"
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
/// Largest relative difference of the sum of a channel's pixels from the oracle's, largest root mean square of the pixels' differences
/// relative to that of the pixels, and the oracle's own tolerance.
constexpr double kBrightnessTolerance = 1e-2, kPixelTolerance = 2e-2, kOracleTolerance = 4e-3;
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
enum class LitBy { None, FromBehind, AllKinds, AllOrders };

struct Frame {
  const char* name;
  ClassificationOrder order = ClassificationOrder::Pre;
  View view = View::Framed;
  float lod = 0.0f;
  Composite composite = Composite::Normalised;
  LitBy light = LitBy::None;
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

constexpr std::array<Frame, 2> kLitFrames{
    {{.name = "lit from behind", .light = LitBy::FromBehind}, {.name = "lights of all kinds", .light = LitBy::AllKinds}}};
constexpr std::array<Frame, 2> kLitScalarFrames{
    {{.name = "classified after, lit from behind", .order = ClassificationOrder::Post, .light = LitBy::FromBehind},
     {.name = "classified after, lights of all kinds", .order = ClassificationOrder::Post, .light = LitBy::AllKinds}}};
constexpr std::array<Frame, 1> kScatteringFrames{{{.name = "light of all orders", .light = LitBy::AllOrders}}};

std::optional<Lighting> lightingOf(const Volume& volume, LitBy light) {
  if (light == LitBy::None) return {};
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

std::string blockText(glm::ivec3 n, std::size_t i, std::size_t level) {
  return fmt::format("block ({}, {}, {}) of level {}", int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y, level);
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
        referenceGatherBlocks(medium, int(level), scene.volume.dimensions, scene.classification.albedo, frame.light != LitBy::None);
    FV_CHECK_EQ(blocks.extinction.size(), expected.extinction.size());
    FV_CHECK_EQ(blocks.emission.size(), expected.emission.size());
    for (std::size_t i = 0; i < blocks.extinction.size(); ++i) {
      const auto where = [&] { return blockText(blocks.dimensions, i, level); };
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
  if (scene.classification.emission && frame.light != LitBy::None)
    checks.push_back(emission.atMost(kSourceTolerance, fmt::format("gather blocks: emission, {}", frame.name), "relative"));
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

/// The image beside the oracle's: the sum of each channel, and the root of the mean squared difference of pixels.
void checkAgainstOracle(const Image& image, const ValidationScene& scene, const Classification& classification, const Camera& camera,
                        const FrameSettings& settings, const Frame& frame, ReportSection& section) {
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
  section.checks.push_back(
      brightness.atMost(kBrightnessTolerance, fmt::format("gather image: brightness, {}", frame.name), "of the oracle's"));
  section.checks.push_back(
      pixels.atMost(kPixelTolerance, fmt::format("gather image: pixels beside the oracle's, {}", frame.name), "of their root mean square"));
  section.imageRows.push_back(comparedImages(image, oracle.image, fmt::format("Frame: {}", frame.name), "oracle"));
}

/// The sums of samples, of the stencil and of the image, each from what the device made in the stage before.
void checkSamples(GatherOutputs& device, const ValidationScene& scene, const Classification& classification, const Camera& camera,
                  const FrameSettings& settings, const GatherStages& stages, const ReferenceGather& reference, const char* frame,
                  ReportSection& section) {
  const double tolerance = reference.hasScalars() ? kScalarTolerance : kSampleTolerance;
  const std::vector<GatherSums> samples = comparedSamples(reference, stages, tolerance, settings.size);
  checkSums(stages.gathered, samples, stages.lattice.samples, tolerance, "gather samples", frame, section.checks);
  if (reference.adapts()) checkRefinement(device, camera, settings, scene.volume.voxelSize(), stages, frame, section.checks);
  if (!reference.hasScalars()) {
    const std::vector<GatherSums> smoothed = reference.smoothed(stages.gathered);
    checkSums(stages.smoothed, smoothed, stages.lattice.samples, kStencilTolerance, "gather stencil", frame, section.checks);
  }
  checkImage(stages.image, reference.image(reference.hasScalars() ? stages.gathered : stages.smoothed), "gather image", frame,
             section.checks);
  section.checks.push_back(checkEnd(device, camera, settings, samples, tolerance, classification.emission.has_value(), frame));
  section.imageRows.push_back(comparedImages(stages.image, reference.image(reference.smoothed(samples)), fmt::format("Frame: {}", frame),
                                             "reference, from the device's blocks"));
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
  const ReferenceGather reference(scene.volume, classification, camera, settings);
  section.checks.push_back(checkLattice(stages.lattice, reference.lattice(), frame.name));
  if (stages.lattice.samples != reference.lattice().samples) return;
  if (std::ranges::any_of(stages.blocks, &GatherBlocks::exists)) checkBlocks(stages, scene, frame, section.checks);
  if (!settings.lighting) {
    checkSamples(device, scene, classification, camera, settings, stages, reference, frame.name, section);
    return;
  }
  section.checks.push_back(checkLightDepths(stages, scene, reference.hasScalars(), *settings.lighting, frame.name));
  if (stages.scattered)
    section.checks.push_back(checkScattered(*stages.scattered, scene.volume, classification, *settings.lighting, frame.name));
  checkAgainstOracle(stages.image, scene, classification, camera, settings, frame, section);
}

constexpr const char* kExplanation =
    "Every stage of the gather on the device against a double-precision version on the CPU that is given what the device made "
    "in the stage before: blocks as they are stored, the sums of the lattice's samples, the sums after the stencil, and the "
    "image. Sums are relative to the sample's own, or to 5 % of the largest where that is more. Rays go on to the end of the "
    "volume, but for the check of their early end, where they are to end at a transmittance of a half. All of them are marched, "
    "but for the check of adaptive sampling, whose tolerance is the median roughness.";

constexpr const char* kLightExplanation =
    "Lit frames: blocks, depths towards lights, gradients of surfaces and light of several orders as they are stored, against versions in "
    "double precision on the CPU, and the image against the oracle, which marches rays to the lights.";

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

namespace {

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

}  // namespace

namespace {

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
  checkFrames(make, coloredFog(), kLitFrames, size, section);
  return section;
}

ReportSection gatherScalarLightChecks(const GatherMaker& make, glm::ivec2 size) {
  ReportSection section{.title = "Gather: lights at samples of scalars", .text = kLightExplanation};
  checkFrames(make, coloredFog(), kLitScalarFrames, size, section);
  return section;
}

ReportSection gatherScatteringChecks(const GatherMaker& make, glm::ivec2 size) {
  ValidationScene scene{.name = "smooth fog", .volume = smoothFog(), .classification = {}};
  scene.classification = {.densityScale = automaticDensityScale(scene.volume, 2.0), .albedo = glm::vec3(0.9f, 0.7f, 0.5f)};
  ReportSection section{.title = "Gather: light of all orders", .text = kLightExplanation};
  checkFrames(make, scene, kScatteringFrames, size, section);
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
  checkFrames(make, scene, kLitFrames, size, section);
  return section;
}

ReportSection gatherSurfaceChecks(const GatherMaker& make) {
  constexpr int kEdge = 48, kPixelsPerVoxel = 4, kPixels = kEdge * kPixelsPerVoxel;
  constexpr double kRadius = 20.0;  // voxels
  const glm::dvec3 middle(0.5 * (kEdge - 1));
  const auto inside = [&](int x, int y, int z) { return kRadius - glm::length(glm::dvec3(x, y, z) - middle); };
  const glm::dmat4 transform = cubeTransform(glm::ivec3(kEdge));
  ValidationScene scalars{.name = "scalars", .volume = makeVolume(glm::ivec3(kEdge), transform, inside), .classification = {}};
  scalars.classification.transferFunction = TransferFunction{
      .opacity = {{-0.5f, 0.0f}, {0.5f, 0.99f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = scalars.volume.voxelSize()};
  scalars.classification.order = ClassificationOrder::Post;
  ValidationScene densities{.name = "densities",
                            .volume = makeVolume(glm::ivec3(kEdge), transform,
                                                 [&](int x, int y, int z) { return std::clamp(0.5 + inside(x, y, z) / 3.0, 0.0, 1.0); }),
                            .classification = {.albedo = glm::vec3(1.0f)}};
  densities.classification.densityScale = 3.0 / densities.volume.voxelSize();
  Camera camera;
  camera.lookAt = glm::dvec3(transform * glm::dvec4(middle, 1.0));
  camera.position = camera.lookAt + glm::dvec3(0.0, 0.0, 10.0);
  camera.orthographic = true;
  camera.orthographicHeight = kEdge * scalars.volume.voxelSize();
  const glm::dvec3 toLight = glm::normalize(glm::dvec3(-1.0, 1.0, 1.0)), toEye(0.0, 0.0, 1.0);
  const FrameSettings settings{
      .size = glm::ivec2(kPixels),
      .lod = 0.0f,
      .lighting = Lighting{.lights = {{.place = toLight}}, .surface = 1.0, .attenuation = LightAttenuation::Exact}};
  ReportSection section{.title = "Gather: surfaces",
                        .text =
                            "Opaque spheres of 4 pixels a voxel: away from their rims, what their surfaces send to the eye depends on "
                            "the normal alone, and is known in closed form. On the flank of the highlight 0.1 is a degree."};
  for (const ValidationScene* scene : {&scalars, &densities}) {
    const GatherStages stages = make(scene->volume, scene->classification)->frame(camera, settings);
    MaxError worst, gradients;
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < kPixels; ++y)
      for (int x = 0; x < kPixels; ++x) {
        const glm::dvec2 place = (glm::dvec2(x, kPixels - 1 - y) - 0.5 * (kPixels - 1)) / (kPixelsPerVoxel * kRadius);
        if (glm::length(place) > 0.8) continue;
        const glm::dvec3 normal(place, std::sqrt(1.0 - glm::dot(place, place)));
        if (glm::dot(normal, toLight) < 0.3) continue;
        const double expected = kDefaultIrradiance * 0.5 * surfaceScattering(normal, toLight, toEye);
        const auto pixel = std::size_t(x + kPixels * y);
        const double error = std::abs(double(stages.image.pixels[pixel].g) / expected - 1.0);
        worst.take(error, [&] { return pixelText(settings.size, pixel); });
        sum += error;
        ++count;
      }
    const bool ofScalars = scene == &scalars;
    section.checks.push_back({.name = fmt::format("gather surfaces: mean, {}", scene->name),
                              .figure = sum / count,
                              .tolerance = ofScalars ? 0.015 : 0.025,
                              .unit = "relative",
                              .where = fmt::format("{} pixels", count)});
    section.checks.push_back(worst.atMost(ofScalars ? 0.08 : 0.13, fmt::format("gather surfaces: largest, {}", scene->name), "relative"));
    section.checks.push_back(checkGradients(stages, *scene, scene->classification));
  }
  return section;
}

}  // namespace freevoxels
