#include "engine/gathering/gather_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// A sample adds at most this optical depth: what is behind that is invisible.
constexpr double kMostDepth = 16.0;
/// Fractional binary digits of the optical depth; its integer part up to kMostDepth takes four more.
constexpr int kDepthDigits = 55;
/// Sums of some groups of lights stay within 63 binary digits.
constexpr int kMostDigits = 60;

/// A cell's roughness is that of its coarse samples, which reads two more on each side, as many as the interpolation.
constexpr int kCoarseBefore = 2, kCoarseBehind = 3;

SampleLattice latticeOf(const shader::GatherFrame& frame, bool scalars, bool depth) {
  SampleLattice lattice{.samples = frame.samples,
                        .pitch = double(frame.pitch),
                        .first = frame.firstSample,
                        .mainAxis = frame.mainAxis,
                        .orthographic = frame.orthographic != 0,
                        .scalars = scalars,
                        .depth = depth,
                        .raysOfPixel = frame.raysOfPixel,
                        .seenLow = frame.seenLow,
                        .seenHigh = frame.seenHigh};
  for (std::size_t axis = 0; axis < 3; ++axis)
    lattice.axes[axis] = {frame.axes[axis].along, frame.axes[axis].tilt, double(frame.axes[axis].tiltDepth)};
  return lattice;
}

int coarseRows(const shader::GatherFrame& frame) {
  return (frame.seenExtent.y + 1) / 2;
}

}  // namespace

glm::ivec2 rowsOfPart(const shader::GatherFrame& frame, const SharePart& part) {
  const auto rowOf = [&](int share) {
    const auto coarse = int(std::int64_t(coarseRows(frame)) * share / kShares);
    return frame.firstSeen.y + std::min(2 * coarse, frame.seenExtent.y);
  };
  return {rowOf(part.first()), rowOf(part.end())};
}

shader::GatherFrame frameOfRows(const shader::GatherFrame& frame, glm::ivec2 rows) {
  shader::GatherFrame result = frame;
  if (frame.sampleTolerance <= 0.0f) {  // all samples are marched
    result.firstSeen.y = rows.x;
    result.seenExtent.y = rows.y - rows.x;
    return result;
  }
  const glm::ivec2 own((rows.x - frame.firstSeen.y) / 2, (rows.y - frame.firstSeen.y + 1) / 2);
  const int first = std::max(own.x - kCoarseBefore, 0), end = std::min(own.y + kCoarseBehind, coarseRows(frame));
  result.firstSeen.y += 2 * first;
  result.seenExtent.y = 2 * (end - first) - 1;
  result.ownCells = own - first;
  return result;
}

FixedSums sumsOfSamples(const shader::GatherFrame& frame, bool scalars, FixedSums layout) {
  layout.lattice = latticeOf(frame, scalars, layout.channels == kSumChannels);
  layout.channels = kSumChannels;
  layout.method = "gather, " + layout.method;
  layout.digits[std::size_t(SumChannel::OpticalDepth)] = kDepthDigits;
  layout.first = frame.firstSeen;
  layout.extent = frame.seenExtent;
  layout.values.assign(layout.pixelCount() * kSumChannels, 0);
  return layout;
}

void addSamples(FixedSums& sums, const std::vector<GatherSums>& samples, glm::ivec2 rows, bool lightAlone) {
  const auto add = [&](SumChannel channel, std::size_t i, double value) {
    const auto c = std::size_t(channel);
    if (!(std::abs(value) < std::ldexp(1.0, kMostDigits - sums.digits[c])))
      fail(ErrorKind::Input, "light is beyond the range of numbers: use less extreme lights, emission and distances");
    sums.values[c * sums.pixelCount() + i] += std::llround(std::ldexp(value, sums.digits[c]));
  };
  for (int y = rows.x; y < rows.y; ++y)
    for (int x = 0; x < sums.extent.x; ++x) {
      const glm::ivec2 place = {sums.first.x + x, y};
      const GatherSums& sample = samples[std::size_t(place.x) + std::size_t(sums.lattice->samples.x) * std::size_t(y - rows.x)];
      const std::size_t i = std::size_t(x) + std::size_t(sums.extent.x) * std::size_t(y - sums.first.y);
      for (int c = 0; c < 3; ++c) add(SumChannel(c), i, sample.color[c]);
      if (lightAlone) continue;
      add(SumChannel::Energy, i, sample.energy);
      add(SumChannel::OpticalDepth, i, std::min(-std::log1p(-std::min(sample.energy, 1.0)), kMostDepth));
      add(SumChannel::Distance, i, sample.distance);
    }
}

}  // namespace freevoxels
