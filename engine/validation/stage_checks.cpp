#include "engine/validation/stage_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "engine/core/error.h"
#include "engine/reference/reference_rays.h"
#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "engine/validation/lattice_steps.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"
#include "engine/volume/packed_light.h"
#include "engine/volume/subject.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

namespace {

/// Tolerance for a transfer function's -log(1 - alpha) in 32-bit floats, which loses up to 1 / (1 -
/// kMaxOpacity) = 4096 units in the last place of alpha, of 8.3 that remain.
constexpr double kExtinctionTolerance = 1e-4;
/// Half a step of 9 bits.
constexpr double kEmissionTolerance = 2e-3;
constexpr double kCodeTolerance = 1.0;
/// Codes of smaller depths along rays are finer than 32-bit floats can add up.
constexpr double kShallowDepth = 1e-3;
constexpr double kSumsTolerance = 1e-4;
constexpr double kDepthTolerance = 1e-5;

/// An error in a pixel's sum is relative to that sum, but to no less than this fraction of the image's
/// largest sum: at the rim of a single footprint a sum is (1 - r²/R²)⁴ for an r that is nearly R, of which
/// 32-bit floats keep few digits, and which is invisible.
constexpr double kSumsFloor = 5e-2;
/// Mean distances are compared in pixels with at least this alpha.
constexpr float kMinAlpha = 1e-3f;

struct TableVariant {
  const char* name;
  TableSettings settings;
};
constexpr std::array<TableVariant, 5> kTables{
    {{"depth8", {AttenuationCode::Depth8, true}},
     {"depth8, steps of one length", {AttenuationCode::Depth8, false}},
     {"linear8", {AttenuationCode::Linear8, true}},
     {"linear8, steps of one length", {AttenuationCode::Linear8, false}},
     {"depth8, 98 directions", {AttenuationCode::Depth8, true, DirectionSet::Directions98}}}};

/// In orthographic projection all voxels have the same direction to the eye, so that rounding cannot choose
/// another nearest one.
struct Method {
  const char* name;
  std::size_t table;  ///< index into kTables
  bool orthographic;
  Composite composite;
  AttenuationLookup attenuation;
  bool gradient, depth;
  bool inside = false;  ///< whether the eye is in the middle of the volume
};
constexpr std::array<Method, 4> kMethods{{{"default", 0, false, Composite::Normalised, AttenuationLookup::Bilinear, true, true},
                                          {"eye inside", 0, false, Composite::Normalised, AttenuationLookup::Bilinear, true, true, true},
                                          {"the paper's", 3, true, Composite::Additive, AttenuationLookup::Nearest, false, false},
                                          {"98 directions", 4, false, Composite::Normalised, AttenuationLookup::Bilinear, true, false}}};

/// The device's results for one scene and one table variant.
struct Outcome {
  const ValidationScene& scene;
  TableSettings settings;
  StageOutputs& device;
  std::vector<double> extinction;
  std::vector<glm::dvec3> emission;  ///< empty where there is none
  TableBytes table;

  bool isOccupied(std::size_t voxel) const {
    return extinction[voxel] > 0.0 || (!emission.empty() && emission[voxel] != glm::dvec3(0.0));
  }
  std::vector<std::uint32_t> visible;
};

Check checkExtinction(const Outcome& outcome) {
  const Volume& volume = outcome.scene.volume;
  const std::vector<double> reference = referenceExtinction(volume, outcome.scene.classification);
  FV_CHECK_EQ(outcome.extinction.size(), reference.size());
  MaxError worst;
  for (std::size_t i = 0; i < reference.size(); ++i)
    worst.take(relativeDifference(outcome.extinction[i], reference[i]), [&] { return voxelText(volume, i); });
  return worst.atMost(kExtinctionTolerance, "classify: extinction", "relative");
}

/// The error relative to the voxel's largest component, or to the faintest emission that is stored.
Check checkEmission(const Outcome& outcome) {
  const Volume& volume = outcome.scene.volume;
  const Classification& classification = outcome.scene.classification;
  const double faintest = brightestLight(classification, volume) * kFaintest / kBrightest;
  const VoxelClassifier classifier(classification, volume);
  MaxError worst;
  std::size_t voxel = 0;
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x, ++voxel) {
        const glm::dvec3 expected = classifier.at({x, y, z}).emission;
        if (largestComponent(expected) < faintest && outcome.emission[voxel] == glm::dvec3(0.0)) continue;
        worst.take(
            largestComponent(glm::abs(outcome.emission[voxel] - expected)) / largestComponent(expected),
            [&] { return voxelText(volume, voxel); });
      }
  return worst.atMost(kEmissionTolerance, "classify: emission", "relative");
}

Check checkVisible(const Outcome& outcome) {
  const std::vector<std::uint32_t> reference = referenceVisibleVoxels(outcome.extinction, outcome.emission);
  const std::size_t length = std::max(reference.size(), outcome.visible.size());
  const auto entry = [](const std::vector<std::uint32_t>& list, std::size_t i) {
    return i < list.size() ? std::optional(list[i]) : std::nullopt;
  };
  Check check{.name = "visible voxels: entries that differ", .unit = "entries"};
  for (std::size_t i = 0; i < length; ++i) {
    if (entry(reference, i) == entry(outcome.visible, i)) continue;
    if (check.figure++ == 0.0)
      check.where = fmt::format("from entry {} on, {}", i,
                                voxelText(outcome.scene.volume, entry(reference, i).value_or(0)));
  }
  return check;
}

/// Checks one direction of the table.
struct PlaneDifference {
  int largest = 0;
  std::size_t where = 0, differing = 0, bytes = 0;

  std::string text() const {
    return fmt::format("{} ({:.3g} %)", largest,
                       100.0 * double(differing) / double(std::max<std::size_t>(bytes, 1)));
  }
};

PlaneDifference comparePlanes(const Outcome& outcome, const std::vector<std::uint8_t>& plane,
                              const std::vector<std::uint8_t>& reference) {
  FV_CHECK_EQ(plane.size(), reference.size());
  PlaneDifference result;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    if (!outcome.isOccupied(i)) continue;  // not stored
    ++result.bytes;
    const int difference = std::abs(int(plane[i]) - int(reference[i]));
    if (difference > 0) ++result.differing;
    if (difference > result.largest) {
      result.largest = difference;
      result.where = i;
    }
  }
  return result;
}

/// Adds a column to `rows`, which has a row for each of the 26 directions. Does nothing for other tables.
Check checkTable(const Outcome& outcome, const char* name, std::vector<std::vector<std::string>>& rows) {
  const DirectionSet set = outcome.settings.directions;
  const TableBytes reference = referenceTable(outcome.scene.volume, outcome.extinction, outcome.settings);
  FV_CHECK_EQ(outcome.table.size(), reference.size());
  MaxError worst;
  for (int d = 0; d < directionCount(set); ++d) {
    const PlaneDifference difference =
        comparePlanes(outcome, outcome.table[std::size_t(d)], reference[std::size_t(d)]);
    worst.take(difference.largest, [&] {
      return fmt::format("{}, {}", directionText(set, d), voxelText(outcome.scene.volume, difference.where));
    });
    if (set == kLatticeSteps) rows[std::size_t(d)].push_back(difference.text());
  }
  return worst.atMost(kCodeTolerance, fmt::format("table: {}", name), "codes");
}

struct Channel {
  const char* name;
  glm::dvec3 (*of)(const SplatSums&);
};
constexpr std::array<Channel, 4> kChannels{
    {{"C", [](const SplatSums& s) { return s.color; }},
     {"E", [](const SplatSums& s) { return glm::dvec3(s.energy); }},
     {"T", [](const SplatSums& s) { return glm::dvec3(s.depth); }},
     {"sum of e z", [](const SplatSums& s) { return glm::dvec3(s.distance); }}}};

Check checkSums(const std::vector<SplatSums>& sums, const std::vector<SplatSums>& reference,
                const Channel& channel, glm::ivec2 size, const char* method) {
  FV_CHECK_EQ(sums.size(), reference.size());
  double brightest = 0.0;
  for (const SplatSums& s : reference) brightest = std::max(brightest, largestComponent(channel.of(s)));
  MaxError worst;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::dvec3 expected = channel.of(reference[i]);
    const double difference = largestComponent(glm::abs(channel.of(sums[i]) - expected));
    const double scale = std::max(largestComponent(expected), kSumsFloor * brightest);
    worst.take(difference == 0.0 ? 0.0 : difference / scale, [&] { return pixelText(size, i); });
  }
  return worst.atMost(kSumsTolerance, fmt::format("splat sums: {}, {}", channel.name, method), "relative");
}

Check checkDistance(const Image& image, const Image& reference, const char* method) {
  MaxError worst;
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if (reference.pixels[i].a >= kMinAlpha)
      worst.take(relativeDifference(double(image.depth[i]), double(reference.depth[i])), [&] { return pixelText(image.size, i); });
  return worst.atMost(kDepthTolerance, fmt::format("resolve: distance, {}", method), "relative");
}

/// The difference of the codes; for depths below kShallowDepth, in codes of that.
double rayDifference(std::uint16_t a, std::uint16_t b) {
  const std::uint16_t deeper = std::max(a, b);
  double code = decodeRayDepth(deeper) - decodeRayDepth(std::uint16_t(deeper - 1));
  if (decodeRayDepth(deeper) < kShallowDepth) code = 2.0 * std::sqrt(kOpaqueDepth * kShallowDepth) / 65535.0;
  return std::abs(decodeRayDepth(a) - decodeRayDepth(b)) / code;
}

/// Checks the depths along rays of a light, which has the place of the eye.
Check checkRays(const Outcome& outcome, const RaySource& source, const char* method) {
  const Volume& volume = outcome.scene.volume;
  const RayCodes codes = outcome.device.rays(source);
  const RayCodes reference = referenceRays(volume, outcome.extinction, source);
  const std::array<FaceRays, 6> fans = faceRays(volume.dimensions, source);
  MaxError worst;
  for (std::size_t f = 0; f < fans.size(); ++f) {
    const FaceRays& fan = fans[f];
    FV_CHECK_EQ(codes[f].size(), reference[f].size());
    for (std::size_t i = 0; i < codes[f].size(); ++i) {
      if (codes[f][i] == reference[f][i]) continue;
      const double difference = rayDifference(codes[f][i], reference[f][i]);
      if (difference <= worst.figure()) continue;
      const std::size_t inPlane = i % fan.rays(), row = std::size_t(fan.rayCount.x);
      const glm::ivec2 ray(inPlane % row, inPlane / row);
      const int plane = int(i / fan.rays());
      if (!isReadAt(fan, volume.dimensions, ray, plane)) continue;
      worst.take(difference,
                 [&] { return fmt::format("fan {}, ray ({}, {}), plane {}", f, ray.x, ray.y, plane); });
    }
  }
  return worst.atMost(kCodeTolerance, fmt::format("rays: {}", method), "codes");
}

void checkFrame(const Outcome& outcome, const Method& method, glm::ivec2 size, ReportSection& section) {
  const ValidationScene& scene = outcome.scene;
  const FrameSettings settings{
      .size = size,
      .method = SplatSettings{.composite = method.composite, .attenuation = method.attenuation, .gradient = method.gradient},
      .lod = 0.0f,
      .depth = method.depth};
  Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, double(size.x) / size.y,
                                {.orthographic = method.orthographic});
  if (method.inside) camera = cameraInside(scene.volume, camera);
  const std::vector<SplatSums> sums = outcome.device.sums(camera, settings);
  const SplatInputs inputs{
      .extinction = outcome.extinction, .table = outcome.table, .tableSettings = outcome.settings, .emission = outcome.emission};
  section.checks.push_back(checkRays(outcome, eyeSource(camera, scene.volume.indexToWorld), method.name));
  const std::vector<SplatSums> reference =
      referenceSplatSums(scene.volume, scene.classification, inputs, camera, settings, outcome.visible);
  for (const Channel& channel : std::span(kChannels).first(method.depth ? 4 : 3))
    section.checks.push_back(checkSums(sums, reference, channel, size, method.name));

  const Image image = outcome.device.image(camera, settings);
  const Image resolved = referenceResolve(sums, settings);
  section.checks.push_back(largestDifference(image, resolved).atMost(kImageTolerance, fmt::format("resolve: RGBA, {}", method.name)));
  if (method.depth) section.checks.push_back(checkDistance(image, resolved, method.name));
  section.imageRows.push_back(comparedImages(image, referenceResolve(reference, settings), fmt::format("Method: {}", method.name),
                                             "reference, from the device's table"));
}

constexpr const char* kExplanation =
    "Every stage on the device against a double-precision version on the CPU that is given what the device "
    "made in the stage before. Extinction is relative to the voxel's own; the splat sums are relative to the "
    "pixel's own, or to 5 % of the image's largest where that is more.";

}  // namespace

ReportSection stageChecks(const StageMaker& make, const ValidationScene& scene, glm::ivec2 size) {
  ReportSection section{.title = fmt::format("Stages: {}", scene.name), .text = kExplanation};
  ReportTable directions{.caption = "Largest difference in codes, and the share of bytes that differ",
                         .columns = {"direction"},
                         .rows = {}};
  for (int d = 0; d < kLatticeStepCount; ++d) {
    const glm::ivec3 v = latticeStep(d);
    directions.rows.push_back({fmt::format("{}, {}, {}", v.x, v.y, v.z)});
  }
  for (std::size_t variant = 0; variant < kTables.size(); ++variant) {
    const TableSettings settings = kTables[variant].settings;
    const auto device = make(scene.volume, scene.classification, settings);
    const std::vector<float> extinction = device->extinction();
    const Outcome outcome{.scene = scene,
                          .settings = settings,
                          .device = *device,
                          .extinction = {extinction.begin(), extinction.end()},
                          .emission = device->emission(),
                          .table = device->table(),
                          .visible = device->visibleVoxels()};
    if (variant == 0) {
      section.checks.push_back(checkExtinction(outcome));
      if (!outcome.emission.empty()) section.checks.push_back(checkEmission(outcome));
      section.checks.push_back(checkVisible(outcome));
    }
    if (settings.directions == kLatticeSteps) directions.columns.push_back(kTables[variant].name);
    section.checks.push_back(checkTable(outcome, kTables[variant].name, directions.rows));
    for (const Method& method : kMethods)
      if (method.table == variant) checkFrame(outcome, method, size, section);
  }
  section.tables.push_back(std::move(directions));
  return section;
}

}  // namespace freevoxels
