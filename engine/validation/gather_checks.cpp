#include "engine/validation/gather_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/reference/reference_gather.h"
#include "engine/reference/reference_refinement.h"
#include "engine/renderer_stages.h"
#include "engine/validation/gather_sample_checks.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

constexpr double kSampleTolerance = 1e-4, kStencilTolerance = 2e-5;
constexpr double kDistanceTolerance = 1e-4;
/// The tolerance of scalars, which may round to the next interval of the transfer function's table, or to more or less than the least change
/// whose mean is an integral.
constexpr double kScalarTolerance = 3e-3;
/// Within this part of the tolerance and 16 rounding errors of 24 bits, of which a fourth difference has as many, the device may find a
/// cell rough or smooth.
constexpr double kRoughnessBand = 1e-3, kRoughnessRounding = 16.0 / double(1 << 23);
/// Least tolerance for the check of adaptive sampling: that of a homogeneous volume would be no more than rounding.
constexpr double kMinRoughness = 1e-4;
/// Second difference of distances, in voxels, that is as rough as the tolerance.
constexpr double kRoughVoxels = 2.0;
constexpr double kRefinementTolerance = 1e-4;
/// At which rays end where their early end is checked.
constexpr float kEndTransmittance = 0.5f;
enum class View { Framed, Orthographic, Inside, Wide, Near };

struct Frame {
  const char* name;
  ClassificationOrder order = ClassificationOrder::Pre;
  View view = View::Framed;
  float lod = 0.0f;
};
constexpr std::array<Frame, 8> kFrames{
    {{"perspective"},
     {.name = "orthographic", .view = View::Orthographic},
     {.name = "eye inside", .view = View::Inside},
     {.name = "rays along several axes", .view = View::Wide},
     {.name = "levels of detail", .view = View::Near, .lod = 8.0f},
     {.name = "classified after", .order = ClassificationOrder::Post},
     {.name = "classified after, eye inside", .order = ClassificationOrder::Post, .view = View::Inside},
     {.name = "classified after, levels of detail", .order = ClassificationOrder::Post, .view = View::Near, .lod = 8.0f}}};

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

/// Adaptive sampling with the median roughness of C and E as the tolerance, or kMinRoughness. All samples of `all` are marched.
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
  settings.gather().sampleTolerance = float(std::max(rough[rough.size() / 2], kMinRoughness));
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
  const FrameSettings settings{
      .size = size, .method = GatherSettings{.endTransmittance = 0.0f, .sampleTolerance = 0.0f}, .lod = frame.lod, .depth = true};
  const Camera camera = cameraOf(scene.volume, frame.view, double(size.x) / size.y);
  const GatherStages stages = device.frame(camera, settings);
  const ReferenceGather reference(scene.volume, classification, camera, settings);
  section.checks.push_back(checkLattice(stages.lattice, reference.lattice(), frame.name));
  if (stages.lattice.samples != reference.lattice().samples) return;
  if (std::ranges::any_of(stages.blocks, &GatherBlocks::exists)) checkBlocks(stages, scene, false, frame.name, section.checks);
  checkSamples(device, scene, classification, camera, settings, stages, reference, frame.name, section);
}

constexpr const char* kExplanation =
    "Every stage of the gather on the device against a double-precision version on the CPU that is given what the device made "
    "in the stage before: blocks as they are stored, the sums of the lattice's samples, the sums after the stencil, and the "
    "image. Sums are relative to the sample's own, or to 5 % of the largest where that is more. Rays go on to the end of the "
    "volume, but for the check of their early end, where they are to end at a transmittance of a half. All of them are marched, "
    "but for the check of adaptive sampling, whose tolerance is the median roughness.";

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

ReportSection gatherChecks(const GatherMaker& make, const ValidationScene& scene, glm::ivec2 size) {
  ReportSection section{.title = fmt::format("Gather: {}", scene.name), .text = kExplanation};
  for (const ClassificationOrder order : {ClassificationOrder::Pre, ClassificationOrder::Post}) {
    Classification classification = scene.classification;
    classification.order = order;
    if (order == ClassificationOrder::Post && !classification.isPost(scene.volume)) continue;
    const auto device = make(scene.volume, classification);
    for (const Frame& frame : kFrames)
      if (frame.order == order) checkFrame(*device, scene, classification, frame, size, section);
  }
  return section;
}

}  // namespace freevoxels
