#include "engine/volume/histogram.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

using Counts = std::vector<std::uint64_t>;

/// Index of the bin of a value among `bins` bins.
std::size_t binOf(double value, double minimum, double maximum, std::size_t bins) {
  if (!(maximum > minimum)) return 0;
  const double place = (value - minimum) / (maximum - minimum) * double(bins);
  return std::size_t(std::clamp(place, 0.0, double(bins - 1)));
}

Counts sum(Counts a, const Counts& b) {
  std::ranges::transform(a, b, a.begin(), std::plus<>());
  return a;
}

}  // namespace

std::uint64_t Histogram::countBetween(double low, double high) const {
  if (counts.empty() || high < double(minimum) || low > double(maximum)) return 0;
  const auto at = [this](double value) { return binOf(value, minimum, maximum, counts.size()); };
  return *std::max_element(counts.begin() + std::ptrdiff_t(at(low)),
                           counts.begin() + std::ptrdiff_t(at(high)) + 1);
}

std::uint64_t Histogram::count() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
}

std::size_t Histogram::binOfRank(double rank) const {
  std::size_t bin = 0;
  for (std::uint64_t upTo = counts[0]; bin + 1 < counts.size() && double(upTo) < rank; upTo += counts[bin]) ++bin;
  return bin;
}

Histogram histogramOf(const Volume& volume, int bins) {
  return histogramOf(volume.scalars, volume.minimum, volume.maximum, bins);
}

Histogram histogramOf(const ScalarBricks& scalars, float minimum, float maximum, int bins) {
  FV_CHECK_LT(0, bins);
  using Range = tbb::blocked_range<std::size_t>;
  constexpr std::size_t kGrain = 64;
  const auto add = [&](Counts& counts, float scalar, std::uint64_t voxels) {
    if (scalar != kInactiveVoxel && std::isfinite(scalar)) counts[binOf(scalar, minimum, maximum, counts.size())] += voxels;
  };
  Counts counts((std::size_t(bins)));
  if (const std::span<const float> values = scalars.values(); !values.empty()) {
    const std::vector<std::uint64_t> voxels = scalars.codeCounts();
    for (std::size_t code = 0; code < voxels.size(); ++code)
      if (voxels[code] > 0) add(counts, values[code], voxels[code]);
  } else {
    const auto addBricks = [&](const Range& range, Counts partial) {
      for (std::size_t i = range.begin(); i != range.end(); ++i)
        for (const float scalar : scalars.brick(i)) add(partial, scalar, 1);
      return partial;
    };
    counts = tbb::parallel_reduce(Range(0, scalars.count(), kGrain), std::move(counts), addBricks, sum);
  }
  return {minimum, maximum, std::move(counts)};
}

}  // namespace freevoxels
