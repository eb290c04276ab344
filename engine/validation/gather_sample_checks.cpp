#include "engine/validation/gather_sample_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/core/error.h"
#include "engine/image/metrics.h"
#include "engine/validation/max_error.h"
#include "engine/validation/stage_frames.h"

namespace freevoxels {

namespace {

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
