#include "engine/volume/value_range.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

namespace freevoxels {

namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t kGrain = 64;

std::size_t magnitudeOf(float value) {
  constexpr int kFractionBits = 23;
  return std::bit_cast<std::uint32_t>(std::abs(value)) >> kFractionBits;
}

/// Adds the value of some voxels to the summary, or removes it from the volume if it is no number or equal to `noData`.
void add(ValueSummary& summary, float& value, std::uint64_t voxels, float noData) {
  if (value == kInactiveVoxel || voxels == 0) return;
  const bool isNumber = std::isfinite(value);
  if (!isNumber || value == noData) {
    summary.missing += voxels;
    if (!isNumber) summary.nan += voxels;
    value = kInactiveVoxel;
    return;
  }
  summary.active += voxels;
  if (value < 0.0f) summary.negative += voxels;
  summary.minimum = std::min(summary.minimum, value);
  summary.maximum = std::max(summary.maximum, value);
  const std::size_t magnitude = magnitudeOf(value);
  summary.counts[magnitude] += voxels;
  summary.largest[magnitude] = std::max(summary.largest[magnitude], std::abs(value));
}

ValueSummary sumOfCodes(std::span<float> values, const std::vector<std::uint64_t>& counts, float noData) {
  ValueSummary summary;
  for (std::size_t code = 0; code < counts.size(); ++code) add(summary, values[code], counts[code], noData);
  return summary;
}

/// `brickOf(number)` returns a brick, or a copy of one.
template <typename BrickOf>
ValueSummary sumOfBricks(std::size_t count, const BrickOf& brickOf, float noData) {
  const auto sum = [&](const Range& range, ValueSummary partial) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      for (float& scalar : brickOf(i)) add(partial, scalar, 1, noData);
    return partial;
  };
  const auto join = [](ValueSummary a, const ValueSummary& b) {
    a.add(b);
    return a;
  };
  return tbb::parallel_reduce(Range(0, count, kGrain), ValueSummary{}, sum, join);
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

ValueSummary summarise(ScalarBricks& scalars, std::optional<float> noData) {
  const float marker = noData.value_or(kInactiveVoxel);
  if (const std::span<float> values = scalars.values(); !values.empty()) return sumOfCodes(values, scalars.codeCounts(), marker);
  const std::span<ScalarBricks::Brick> bricks = scalars.editable();
  return sumOfBricks(
      bricks.size(), [&](std::size_t i) -> ScalarBricks::Brick& { return bricks[i]; }, marker);
}

ValueSummary summaryOf(const ScalarBricks& scalars) {
  std::vector<float> values(scalars.values().begin(), scalars.values().end());
  if (!values.empty()) return sumOfCodes(values, scalars.codeCounts(), kInactiveVoxel);
  return sumOfBricks(
      scalars.count(), [&](std::size_t i) { return scalars.brick(i); }, kInactiveVoxel);
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

std::pair<float, float> rangeOf(const ValueSummary& summary, const Outliers& outliers) {
  if (summary.active == 0) return {0.0f, 0.0f};
  return {std::max(summary.minimum, -outliers.limit), std::min(summary.maximum, outliers.limit)};
}

std::pair<float, float> rangeOf(const ScalarBricks& scalars) {
  const ValueSummary summary = summaryOf(scalars);
  return rangeOf(summary, outliersOf(summary));
}

void limitValues(ScalarBricks& scalars, float limit) {
  const auto limitOne = [&](float& scalar) {
    if (scalar != kInactiveVoxel && std::abs(scalar) > limit) scalar = std::copysign(limit, scalar);
  };
  if (const std::span<float> values = scalars.values(); !values.empty()) {
    std::ranges::for_each(values, limitOne);
    return;
  }
  const std::span<ScalarBricks::Brick> bricks = scalars.editable();
  tbb::parallel_for(Range(0, bricks.size(), kGrain), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) std::ranges::for_each(bricks[i], limitOne);
  });
}

}  // namespace freevoxels
