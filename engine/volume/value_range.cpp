#include "engine/volume/value_range.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace freevoxels {

namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t kGrain = 64;

std::size_t magnitudeOf(float value) {
  constexpr int kFractionBits = 23;
  return std::bit_cast<std::uint32_t>(std::abs(value)) >> kFractionBits;
}

/// Adds a value to the summary, or removes it from the volume if it is no number or equal to `noData`.
void add(ValueSummary& summary, float& value, float noData) {
  if (value == kInactiveVoxel) return;
  const bool isNumber = std::isfinite(value);
  if (!isNumber || value == noData) {
    ++summary.missing;
    if (!isNumber) ++summary.nan;
    value = kInactiveVoxel;
    return;
  }
  ++summary.active;
  if (value < 0.0f) ++summary.negative;
  summary.minimum = std::min(summary.minimum, value);
  summary.maximum = std::max(summary.maximum, value);
  const std::size_t magnitude = magnitudeOf(value);
  ++summary.counts[magnitude];
  summary.largest[magnitude] = std::max(summary.largest[magnitude], std::abs(value));
}

}  // namespace

void ValueSummary::add(const ValueSummary& other) {
  active += other.active;
  nan += other.nan;
  missing += other.missing;
  negative += other.negative;
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  for (std::size_t i = 0; i < kMagnitudes; ++i) {
    counts[i] += other.counts[i];
    largest[i] = std::max(largest[i], other.largest[i]);
  }
}

ValueSummary summarise(std::span<ScalarBricks::Brick> bricks, std::optional<float> noData) {
  const float marker = noData.value_or(kInactiveVoxel);
  return tbb::parallel_reduce(
      Range(0, bricks.size(), kGrain), ValueSummary{},
      [&](const Range& range, ValueSummary partial) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          for (float& scalar : bricks[i]) add(partial, scalar, marker);
        return partial;
      },
      [](ValueSummary a, const ValueSummary& b) {
        a.add(b);
        return a;
      });
}

Outliers outliersOf(const ValueSummary& summary) {
  constexpr std::size_t kGap = 10;             // powers of two without any value, below outliers
  constexpr std::uint64_t kFewestVoxels = 30;  // which have something that is usual
  constexpr std::uint64_t kVoxelsPerOutlier = 1000;
  std::uint64_t above = summary.active - summary.counts[0];
  if (above < kFewestVoxels) return {};
  const std::uint64_t most = std::min(kMaxOutliers, std::max<std::uint64_t>(above / kVoxelsPerOutlier, 1));
  std::size_t last = 0;  // the last magnitude that has values; 0 before the first
  for (std::size_t i = 1; i < ValueSummary::kMagnitudes; ++i) {
    if (summary.counts[i] == 0) continue;
    if (last > 0 && i > last + kGap && above <= most) return {.voxels = above, .limit = summary.largest[last]};
    above -= summary.counts[i];
    last = i;
  }
  return {};
}

void limitValues(std::span<ScalarBricks::Brick> bricks, float limit) {
  tbb::parallel_for(Range(0, bricks.size(), kGrain), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      for (float& scalar : bricks[i])
        if (scalar != kInactiveVoxel && std::abs(scalar) > limit) scalar = std::copysign(limit, scalar);
  });
}

}  // namespace freevoxels
