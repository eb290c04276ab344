#include "engine/validation/gather_sample_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/reference/reference_hierarchy.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"

namespace freevoxels {

namespace {

/// Half a step of the 11 bits that a half has, and of 9 bits.
constexpr double kExtinctionTolerance = 5e-4, kSourceTolerance = 2e-3;
/// Optical depths of a voxel that halves hold with fewer bits.
constexpr double kMinDepth = 1e-6;
constexpr double kPitchTolerance = 1e-6;
constexpr double kBeside = 1e-5;  ///< distance of rays beside a sample's, as a part of the image's width

/// A sum of samples, of which a small energy of the reference leaves the distance out.
struct Channel {
  const char* name;
  glm::dvec3 (*of)(const GatherSums&, double energy);
};
constexpr std::array<Channel, 3> kChannels{{{"C", [](const GatherSums& s, double) { return s.color; }},
                                            {"E", [](const GatherSums& s, double) { return glm::dvec3(s.energy); }},
                                            {"sum of e z", [](const GatherSums& s, double energy) {
                                               const bool known = s.distance >= 0.0 && energy >= kMinComparedEnergy;
                                               return glm::dvec3(known ? s.distance : 0.0);
                                             }}}};

double largestOf(const Channel& channel, const std::vector<GatherSums>& sums) {
  double largest = 0.0;
  for (const GatherSums& s : sums) largest = std::max(largest, largestComponent(channel.of(s, s.energy)));
  return largest;
}

/// Relative to the reference's sum, or to a part of the largest.
double errorOf(const Channel& channel, const GatherSums& sums, const GatherSums& reference, double largest) {
  const glm::dvec3 expected = channel.of(reference, reference.energy);
  const double difference = largestComponent(glm::abs(channel.of(sums, reference.energy) - expected));
  return difference == 0.0 ? 0.0 : difference / std::max(largestComponent(expected), kErrorFloor * largest);
}

}  // namespace

std::string sampleText(glm::ivec2 samples, std::size_t i) {
  return fmt::format("sample ({}, {})", int(i) % samples.x, int(i) / samples.x);
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

void checkBlocks(const GatherStages& stages, const ValidationScene& scene, bool lit, const char* frame, std::vector<Check>& checks) {
  MaxError extinction, source, emission;
  const double least = kMinDepth / scene.volume.voxelSize();
  for (std::size_t level = 0; level < stages.blocks.size(); ++level) {
    const GatherBlocks& blocks = stages.blocks[level];
    if (!blocks.exists()) continue;
    LevelData medium = stages.medium[level];
    if (level == 0) medium = referenceVoxelLevel(scene.volume, scene.classification, medium.extinction, {}, medium.emission);
    const GatherBlocks expected = referenceGatherBlocks(medium, int(level), scene.volume.dimensions, scene.classification.albedo, lit);
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
  checks.push_back(extinction.atMost(kExtinctionTolerance, fmt::format("gather blocks: extinction, {}", frame), "relative"));
  checks.push_back(source.atMost(kSourceTolerance, fmt::format("gather blocks: source, {}", frame), "relative"));
  if (scene.classification.emission && lit)
    checks.push_back(emission.atMost(kSourceTolerance, fmt::format("gather blocks: emission, {}", frame), "relative"));
}

std::vector<GatherSums> comparedSamples(const ReferenceGather& reference, const GatherStages& stages, double tolerance, glm::ivec2 size) {
  std::vector<GatherSums> samples = reference.samples(stages.blocks);
  if (stages.gathered.size() != samples.size()) return samples;
  std::array<double, kChannels.size()> largest;
  for (std::size_t c = 0; c < kChannels.size(); ++c) largest[c] = largestOf(kChannels[c], samples);
  const auto worst = [&](std::size_t i, const GatherSums& sums) {
    double error = 0.0;
    for (std::size_t c = 0; c < kChannels.size(); ++c) error = std::max(error, errorOf(kChannels[c], stages.gathered[i], sums, largest[c]));
    return error;
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (worst(i, samples[i]) <= tolerance) continue;
    const glm::ivec2 sample(int(i) % stages.lattice.samples.x, int(i) / stages.lattice.samples.x);
    for (const glm::dvec2 way : {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      const GatherSums beside = reference.sumsAt(reference.positionOf(sample) + kBeside * size.x * way, stages.blocks);
      if (worst(i, beside) <= tolerance) samples[i] = beside;
    }
  }
  return samples;
}

void checkSums(const std::vector<GatherSums>& sums, const std::vector<GatherSums>& reference, glm::ivec2 samples, double tolerance,
               const char* stage, const char* frame, std::vector<Check>& checks) {
  FV_CHECK_EQ(sums.size(), reference.size());
  for (const Channel& channel : kChannels) {
    const double largest = largestOf(channel, reference);
    MaxError worst;
    for (std::size_t i = 0; i < sums.size(); ++i)
      worst.take(errorOf(channel, sums[i], reference[i], largest), [&] { return sampleText(samples, i); });
    checks.push_back(worst.atMost(tolerance, fmt::format("{}: {}, {}", stage, channel.name, frame), "relative"));
  }
}

}  // namespace freevoxels
