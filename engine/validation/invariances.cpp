#include "engine/validation/invariances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "engine/core/error.h"
#include "engine/reference/reference_splats.h"
#include "engine/validation/axis_change.h"
#include "engine/validation/lattice_steps.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_outputs.h"
#include "engine/validation/stepped_renderer.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

/// Tolerance for sums of a few hundred 32-bit floats in another order, relative to the largest in the image.
constexpr double kOrderTolerance = 1e-5;
/// Tolerance for codes that round to the other side when a line is swept by another shader, which changes the
/// colour of a pixel where few voxels mix.
constexpr double kAxesTolerance = 5e-3;

struct CheckedFrame {
  const Device& device;
  const ValidationScene& scene;
  Camera camera;
  FrameSettings settings;
};

using Component = double (*)(const SplatSums&);
constexpr std::array<Component, 5> kComponents{
    [](const SplatSums& s) { return s.color.r; }, [](const SplatSums& s) { return s.color.g; },
    [](const SplatSums& s) { return s.color.b; }, [](const SplatSums& s) { return s.energy; },
    [](const SplatSums& s) { return s.depth; }};

double largestOf(const std::vector<SplatSums>& sums, Component value) {
  double largest = 0.0;
  for (const SplatSums& s : sums) largest = std::max(largest, value(s));
  return largest;
}

/// The difference of every component relative to its largest value in the image.
MaxError sumsDifference(const std::vector<SplatSums>& a, const std::vector<SplatSums>& b, glm::ivec2 size) {
  FV_CHECK_EQ(a.size(), b.size());
  MaxError worst;
  for (const Component value : kComponents) {
    const double largest = largestOf(a, value);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double difference = std::abs(value(a[i]) - value(b[i]));
      worst.take(difference == 0.0 ? 0.0 : difference / largest, [&] { return pixelText(size, i); });
    }
  }
  return worst;
}

void checkOrder(const CheckedFrame& frame, const SteppedVolume& steps, const std::vector<SplatSums>& whole, ReportSection& section) {
  const auto compare = [&](const char* name, const std::vector<std::uint32_t>& voxels) {
    const auto sums = drawVoxels(frame.device, steps, voxels, frame.camera, frame.settings);
    section.checks.push_back(
        sumsDifference(whole, sums, frame.settings.size).atMost(kOrderTolerance, name, "relative"));
  };
  std::vector<std::uint32_t> voxels = steps.voxels;
  std::ranges::reverse(voxels);
  compare("order: drawn backwards", voxels);
  std::shuffle(voxels.begin(), voxels.end(), std::mt19937(3));
  compare("order: drawn in random order", voxels);
}

std::vector<SplatSums> sumOfGroups(const CheckedFrame& frame, const SteppedVolume& steps, unsigned groups) {
  std::vector<std::vector<std::uint32_t>> parts(groups);
  std::mt19937 generator(groups);
  for (const std::uint32_t voxel : steps.voxels) parts[generator() % groups].push_back(voxel);
  std::vector<SplatSums> total(std::size_t(frame.settings.size.x) * std::size_t(frame.settings.size.y));
  for (const auto& part : parts) {
    const auto sums = drawVoxels(frame.device, steps, part, frame.camera, frame.settings);
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += sums[i];
  }
  return total;
}

void checkGroups(const CheckedFrame& frame, const SteppedVolume& steps, const Image& image, ReportSection& section) {
  for (const unsigned groups : {2u, 5u}) {
    const Image added = referenceResolve(sumOfGroups(frame, steps, groups), frame.settings);
    section.checks.push_back(largestDifference(image, added)
                                 .atMost(kImageTolerance, fmt::format("partition: {} random groups, added and resolved once", groups)));
  }
}

Check checkRunToRun(const CheckedFrame& frame, StageOutputs& first, const TableBytes& table, const Image& image) {
  const auto second = deviceStages(frame.device)(frame.scene.volume, frame.scene.classification, {});
  const TableBytes tableAgain = second->table();
  MaxError worst;
  for (int d = 0; d < kLatticeStepCount; ++d)
    worst.take(table[std::size_t(d)] == tableAgain[std::size_t(d)] ? 0.0 : 1.0,
               [&] { return "table, " + directionText(kLatticeSteps, d); });
  for (const Image& again : {first.image(frame.camera, frame.settings), second->image(frame.camera, frame.settings)})
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      worst.take(std::memcmp(&image.pixels[i], &again.pixels[i], sizeof(glm::vec4)) == 0 ? 0.0 : 1.0,
                 [&] { return pixelText(frame.settings.size, i); });
  return worst.atMost(0.0, "run to run: the same bits");
}

Check checkSlabs(const TableBytes& table, const TableBytes& ofSlabs) {
  FV_CHECK_EQ(table.size(), ofSlabs.size());
  MaxError worst;
  for (int d = 0; d < kLatticeStepCount; ++d)
    worst.take(table[std::size_t(d)] == ofSlabs[std::size_t(d)] ? 0.0 : 1.0,
               [&] { return directionText(kLatticeSteps, d); });
  return worst.atMost(0.0, "slabs of eight planes: the same table, bit for bit");
}

/// Largest difference of an optical depth from that of its depth8 byte: half a code, and rounding.
double codeWidth(int byte) {
  const double next = byte + 0.501;
  return kMaxCodedDepth * (next * next - double(byte) * byte) / (255.0 * 255.0);
}

double codedDepth(int byte) {
  return kMaxCodedDepth * byte * byte / (255.0 * 255.0);
}

/// The depth along d, the voxel's own, and the depth along -d add up to that of the whole line, for every
/// voxel of the line.
Check checkOpposites(const Volume& volume, const std::vector<float>& extinction, const TableBytes& table) {
  const glm::ivec3 n = volume.dimensions;
  MaxError worst;
  for (int d = 0; d < kLatticeStepCount / 2; ++d) {
    const glm::ivec3 step = latticeStep(d);
    const double length = stepLength(volume.indexToWorld, step, true);
    const auto& ahead = table[std::size_t(d)];
    const auto& behind = table[std::size_t(kLatticeStepCount - 1 - d)];
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) {
          const glm::ivec3 next = glm::ivec3(x, y, z) + step;
          if (glm::any(glm::lessThan(next, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(next, n)))
            continue;
          const std::size_t v = volume.at(x, y, z), w = volume.at(next.x, next.y, next.z);
          if (!(extinction[v] > 0.0f && extinction[w] > 0.0f)) continue;  // not stored
          const std::array<int, 4> bytes{ahead[v], behind[v], ahead[w], behind[w]};
          if (std::ranges::find(bytes, 255) != bytes.end()) continue;  // its depth is 16 or more
          double allowance = 0.0;
          for (const int byte : bytes) allowance += codeWidth(byte);
          const double atV = codedDepth(bytes[0]) + double(extinction[v]) * length + codedDepth(bytes[1]);
          const double atW = codedDepth(bytes[2]) + double(extinction[w]) * length + codedDepth(bytes[3]);
          worst.take(std::abs(atV - atW) / allowance, [&] {
            return fmt::format("{}, {}", directionText(kLatticeSteps, d), voxelText(volume, v));
          });
        }
  }
  return worst.atMost(1.0, "opposite directions: depth of a line from each of its voxels", "of rounding");
}

MaxError changedTableDifference(const Volume& volume, const TableBytes& table, const Volume& changed,
                             const TableBytes& changedTable, const AxisChange& change) {
  const glm::ivec3 n = volume.dimensions;
  MaxError worst;
  for (int d = 0; d < kLatticeStepCount; ++d) {
    const glm::ivec3 e = change.direction(latticeStep(d));
    const auto& plane = changedTable[std::size_t(directionIndex(kLatticeSteps, e))];
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) {
          const glm::ivec3 w = change.voxel({x, y, z}, n);
          const std::size_t voxel = volume.at(x, y, z);
          worst.take(
              std::abs(int(table[std::size_t(d)][voxel]) - int(plane[changed.at(w.x, w.y, w.z)])), [&] {
                return fmt::format("{}, {}", directionText(kLatticeSteps, d), voxelText(volume, voxel));
              });
        }
  }
  return worst;
}

struct NamedChange {
  const char* name;
  AxisChange change;
};
const std::array<NamedChange, 3> kChanges{
    {{"mirrored along all axes", {{0, 1, 2}, glm::bvec3(true)}},
     {"x, y, z stored as y, z, x", {{1, 2, 0}, glm::bvec3(false)}},
     {"x, y, z stored as z, -y, x", {{2, 1, 0}, {false, true, false}}}}};

void checkAxes(const CheckedFrame& frame, const TableBytes& table, const Image& image, ReportSection& section) {
  for (const NamedChange& named : kChanges) {
    const Volume changed = named.change.apply(frame.scene.volume);
    const auto outputs = deviceStages(frame.device)(changed, frame.scene.classification, {});
    section.checks.push_back(
        changedTableDifference(frame.scene.volume, table, changed, outputs->table(), named.change)
            .atMost(1.0, fmt::format("axes: table, {}", named.name), "codes"));
    section.checks.push_back(largestDifference(image, outputs->image(frame.camera, frame.settings))
                                 .atMost(kAxesTolerance, fmt::format("axes: image, {}", named.name)));
  }
}

}  // namespace

ReportSection invariances(const Device& device, const ValidationScene& scene, glm::ivec2 size) {
  ReportSection section{
      .title = fmt::format("Invariances: {}", scene.name),
      .text =
          "What must change nothing but rounding: the order in which voxels are drawn, "
          "drawing them in groups apart, sweeping slab by slab, running again, and the axes that the same "
          "field is stored along."};
  const CheckedFrame frame{.device = device,
                           .scene = scene,
                           .camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, double(size.x) / size.y, {}),
                           .settings = {.size = size, .method = SplatSettings{}, .lod = 0.0f}};
  const auto outputs = deviceStages(device)(scene.volume, scene.classification, {});
  const TableBytes table = outputs->table();
  const Image image = outputs->image(frame.camera, frame.settings);
  const std::vector<SplatSums> sums = outputs->sums(frame.camera, frame.settings);
  {
    const SteppedVolume steps = prepareSteps(device, scene.volume, scene.classification, {});
    checkOrder(frame, steps, sums, section);
    checkGroups(frame, steps, image, section);
    section.checks.push_back(checkSlabs(table, sweepThinSlabs(device, steps)));
  }
  section.checks.push_back(checkRunToRun(frame, *outputs, table, image));
  section.checks.push_back(checkOpposites(scene.volume, outputs->extinction(), table));
  checkAxes(frame, table, image, section);
  return section;
}

}  // namespace freevoxels
