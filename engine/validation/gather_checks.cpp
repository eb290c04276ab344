#include "engine/validation/gather_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/reference/reference_gather.h"
#include "engine/reference/reference_hierarchy.h"
#include "engine/renderer_stages.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// Half a step of the 11 bits that a half has, and of 9 bits.
constexpr double kExtinctionTolerance = 5e-4, kSourceTolerance = 2e-3;
/// Optical depths of a voxel that halves hold with fewer bits.
constexpr double kLeastDepth = 1e-6;
constexpr double kPitchTolerance = 1e-6;
constexpr double kSampleTolerance = 1e-4, kStencilTolerance = 2e-5;
constexpr double kImageTolerance = 1e-5, kDistanceTolerance = 1e-4;
/// The tolerance of scalars, which may round to the next interval of the transfer function's table, or to more or less than the least change
/// whose mean is an integral.
constexpr double kScalarTolerance = 3e-3;
/// At which rays end where their early end is checked.
constexpr float kEndTransmittance = 0.5f;
/// An error in a sample counts relative to the sample, but to no less than this part of the largest.
constexpr double kFloor = 5e-2;
constexpr double kLeastEnergy = 1e-3;  ///< of samples and pixels whose distance is compared

enum class View { Framed, Orthographic, Inside, Wide, Near };

struct Frame {
  const char* name;
  ClassificationOrder order = ClassificationOrder::Pre;
  View view = View::Framed;
  float lod = 0.0f;
  Composite composite = Composite::Normalised;
};
constexpr std::array<Frame, 8> kFrames{{{"perspective"},
                                        {.name = "orthographic, additive", .view = View::Orthographic, .composite = Composite::Additive},
                                        {.name = "eye inside", .view = View::Inside},
                                        {.name = "rays along several axes", .view = View::Wide},
                                        {.name = "levels of detail", .view = View::Near, .lod = 8.0f},
                                        {.name = "classified after", .order = ClassificationOrder::Post},
                                        {.name = "classified after, eye inside", .order = ClassificationOrder::Post, .view = View::Inside},
                                        {.name = "classified after, levels of detail",
                                         .order = ClassificationOrder::Post,
                                         .view = View::Near,
                                         .lod = 8.0f}}};

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

struct Channel {
  const char* name;
  glm::dvec3 (*of)(const GatherSums&);
};
constexpr std::array<Channel, 3> kChannels{{{"C", [](const GatherSums& s) { return s.color; }},
                                            {"E", [](const GatherSums& s) { return glm::dvec3(s.energy); }},
                                            {"sum of e z", [](const GatherSums& s) {
                                               const bool known = s.distance >= 0.0 && s.energy >= kLeastEnergy;
                                               return glm::dvec3(known ? s.distance : 0.0);
                                             }}}};

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
void checkBlocks(const GatherStages& stages, const ValidationScene& scene, const char* frame, std::vector<Check>& checks) {
  MaxError extinction, source;
  const double least = kLeastDepth / scene.volume.voxelSize();
  for (std::size_t level = 0; level < stages.blocks.size(); ++level) {
    const GatherBlocks& blocks = stages.blocks[level];
    if (!blocks.exists()) continue;
    LevelData medium = stages.medium[level];
    if (level == 0) medium = referenceVoxelLevel(scene.volume, scene.classification, medium.extinction, {}, medium.emission);
    const GatherBlocks expected =
        referenceGatherBlocks(medium, int(level), scene.volume.dimensions, scene.classification.albedo);
    FV_CHECK_EQ(blocks.extinction.size(), expected.extinction.size());
    for (std::size_t i = 0; i < blocks.extinction.size(); ++i) {
      const auto where = [&] {
        const glm::ivec3 n = blocks.dimensions;
        return fmt::format("block ({}, {}, {}) of level {}", int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y, level);
      };
      extinction.take(std::abs(blocks.extinction[i] - expected.extinction[i]) / std::max(expected.extinction[i], least), where);
      const double difference = largestComponent(glm::abs(blocks.source[i] - expected.source[i]));
      source.take(difference / std::max(largestComponent(expected.source[i]), least), where);
    }
  }
  checks.push_back(extinction.atMost(kExtinctionTolerance, fmt::format("gather blocks: extinction, {}", frame), "relative"));
  checks.push_back(source.atMost(kSourceTolerance, fmt::format("gather blocks: source, {}", frame), "relative"));
}

std::string sampleText(glm::ivec2 samples, std::size_t i) {
  return fmt::format("sample ({}, {})", int(i) % samples.x, int(i) / samples.x);
}

Check checkSums(const std::vector<GatherSums>& sums, const std::vector<GatherSums>& reference, const Channel& channel,
                glm::ivec2 samples, double tolerance, const std::string& name) {
  FV_CHECK_EQ(sums.size(), reference.size());
  double largest = 0.0;
  for (const GatherSums& s : reference) largest = std::max(largest, largestComponent(channel.of(s)));
  MaxError worst;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::dvec3 expected = channel.of(reference[i]);
    const double difference = largestComponent(glm::abs(channel.of(sums[i]) - expected));
    worst.take(difference == 0.0 ? 0.0 : difference / std::max(largestComponent(expected), kFloor * largest),
               [&] { return sampleText(samples, i); });
  }
  return worst.atMost(tolerance, name, "relative");
}

void checkImage(const Image& image, const Image& reference, const std::string& stage, const char* frame,
                std::vector<Check>& checks) {
  checks.push_back(largestDifference(image, reference).atMost(kImageTolerance, fmt::format("{}: RGBA, {}", stage, frame)));
  MaxError worst;
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if (reference.pixels[i].a >= float(kLeastEnergy))
      worst.take(relativeDifference(double(image.depth[i]), double(reference.depth[i])), [&] { return pixelText(image.size, i); });
  checks.push_back(worst.atMost(kDistanceTolerance, fmt::format("{}: distance, {}", stage, frame), "relative"));
}

/// A ray whose transmittance falls to that at which rays end counts as opaque; all others are whole. `samples` are of whole rays.
Check checkEnd(GatherOutputs& device, const Camera& camera, const FrameSettings& whole, const std::vector<GatherSums>& samples,
               double tolerance, bool shines, const char* frame) {
  FrameSettings settings = whole;
  settings.cullThreshold = kEndTransmittance;
  const GatherStages stages = device.frame(camera, settings);
  MaxError worst;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double expected = samples[i].energy, energy = stages.gathered[i].energy;
    double difference = std::abs(energy - expected) / std::max(expected, kFloor);
    // Volumes that shine have rays of a lower transmittance: what is behind them may be brighter than 1.
    const bool ends = 1.0 - expected < kEndTransmittance * (1.0 - tolerance) && !shines;
    const bool mayEnd = 1.0 - expected < kEndTransmittance * (1.0 + tolerance);
    const double ofEnded = std::abs(energy - 1.0);
    if (mayEnd) difference = ends ? ofEnded : std::min(difference, ofEnded);
    worst.take(difference, [&] { return sampleText(stages.lattice.samples, i); });
  }
  return worst.atMost(tolerance, fmt::format("gather samples: E with rays that end early, {}", frame), "relative");
}

void checkFrame(GatherOutputs& device, const ValidationScene& scene, const Classification& classification, const Frame& frame,
                glm::ivec2 size, ReportSection& section) {
  const FrameSettings settings{
      .size = size, .draw = Draw::Gather, .composite = frame.composite, .lod = frame.lod, .cullThreshold = 0.0f, .depth = true};
  const Camera camera = cameraOf(scene.volume, frame.view, double(size.x) / size.y);
  const GatherStages stages = device.frame(camera, settings);
  const ReferenceGather reference(scene.volume, classification, camera, settings);
  section.checks.push_back(checkLattice(stages.lattice, reference.lattice(), frame.name));
  if (stages.lattice.samples != reference.lattice().samples) return;
  if (std::ranges::any_of(stages.blocks, &GatherBlocks::exists)) checkBlocks(stages, scene, frame.name, section.checks);
  const std::vector<GatherSums> samples = reference.samples(stages.blocks);
  const double tolerance = reference.hasScalars() ? kScalarTolerance : kSampleTolerance;
  for (const Channel& channel : kChannels)
    section.checks.push_back(checkSums(stages.gathered, samples, channel, stages.lattice.samples, tolerance,
                                       fmt::format("gather samples: {}, {}", channel.name, frame.name)));
  const std::vector<GatherSums> smoothed = reference.smoothed(stages.gathered);
  if (stages.lattice.isPixels(size)) {
    checkImage(stages.image, reference.image(smoothed), "gather stencil", frame.name, section.checks);
  } else {
    for (const Channel& channel : kChannels)
      section.checks.push_back(checkSums(stages.smoothed, smoothed, channel, stages.lattice.samples, kStencilTolerance,
                                         fmt::format("gather stencil: {}, {}", channel.name, frame.name)));
    checkImage(stages.image, reference.image(stages.smoothed), "gather image", frame.name, section.checks);
  }
  section.checks.push_back(checkEnd(device, camera, settings, samples, tolerance, classification.emission.has_value(), frame.name));
  section.pictures.push_back(comparedPictures(stages.image, reference.image(reference.smoothed(samples)),
                                              fmt::format("Frame: {}", frame.name), "reference, from the device's blocks"));
}

constexpr const char* kExplanation =
    "Every stage of the gather on the device against a double-precision version on the CPU that is given what the device made "
    "in the stage before: blocks as they are stored, the sums of the lattice's samples, the sums after the stencil, and the "
    "image. Sums are relative to the sample's own, or to 5 % of the largest where that is more. Rays go on to the end of the "
    "volume, but for the check of their early end, where they are to end at a transmittance of a half.";

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
