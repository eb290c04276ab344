#include "engine/volume/scan.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/image/srgb.h"
#include "engine/volume/histogram.h"

namespace freevoxels {

namespace {

constexpr int kClasses = 4;
constexpr std::size_t kBins = 64;
constexpr int kFineBins = 4096;
constexpr double kOutliers = 0.0005;  // fraction of the voxels with the highest values, which are not distinguished

/// Opacity per 1/128 of the box's longest side, by the number of classes between a class and the transparent
/// one.
constexpr std::array<float, kClasses> kOpacities{0.0f, 0.03f, 0.12f, 0.6f};
constexpr double kLengthsAlongBox = 128.0;
/// Half the width of the opacity ramp at a threshold, as a fraction of the threshold's distance to the nearer
/// of the two classes' means.
constexpr double kRamp = 0.25;

constexpr float kHuge = std::numeric_limits<float>::max();

const std::array<glm::vec3, kClasses> kColors{glm::vec3(0.30f, 0.45f, 0.75f), glm::vec3(0.85f, 0.42f, 0.28f),
                                              glm::vec3(0.95f, 0.72f, 0.42f), glm::vec3(0.98f, 0.94f, 0.85f)};

/// The classes' means and the thresholds between them, in bins.
struct Classes {
  std::array<double, kClasses> means{};
  std::array<double, kClasses - 1> thresholds{};
};

/// The classes with the least variance, by dynamic programming: `best[k][end]` is the largest sum of weight x
/// mean^2 of k classes that make up the bins before `end`.
Classes classesOf(std::span<const double> weights) {
  const std::size_t n = weights.size();
  FV_CHECK_LE(std::size_t(kClasses), n);
  std::vector<double> sums(n + 1), moments(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    sums[i + 1] = sums[i] + weights[i];
    moments[i + 1] = moments[i] + weights[i] * (double(i) + 0.5);
  }
  const auto meanOf = [&](std::size_t begin, std::size_t end) {
    const double weight = sums[end] - sums[begin];
    return weight > 0.0 ? (moments[end] - moments[begin]) / weight : 0.5 * double(begin + end);
  };
  const auto gain = [&](std::size_t begin, std::size_t end) {
    const double mean = meanOf(begin, end);
    return (sums[end] - sums[begin]) * mean * mean;
  };
  std::vector<double> best(n + 1, 0.0);
  for (std::size_t end = 1; end <= n; ++end) best[end] = gain(0, end);
  std::array<std::vector<std::size_t>, kClasses> begins;
  for (std::size_t k = 1; k < kClasses; ++k) {
    std::vector<double> next(n + 1, 0.0);
    begins[k].resize(n + 1);
    for (std::size_t end = k + 1; end <= n; ++end)
      for (std::size_t begin = k; begin < end; ++begin) {
        const double value = best[begin] + gain(begin, end);
        if (begins[k][end] != 0 && value <= next[end]) continue;
        next[end] = value;
        begins[k][end] = begin;
      }
    best = std::move(next);
  }
  Classes classes;
  std::size_t end = n;
  for (std::size_t k = kClasses - 1; k > 0; --k) {
    const std::size_t begin = begins[k][end];
    classes.means[k] = meanOf(begin, end);
    classes.thresholds[k - 1] = double(begin);
    end = begin;
  }
  classes.means[0] = meanOf(0, end);
  return classes;
}

/// Adds the values of the active voxels of a column of bricks along x that are on the six sides of the box; those at the ends of rows,
/// where these do not reach the sides. `column` has the numbers of the bricks that exist, in ascending order.
void addValuesOnSides(const ScalarBricks& scalars, std::span<const std::size_t> column, std::vector<float>& values) {
  constexpr int n = ScalarBricks::kEdge;
  const glm::ivec3 last = scalars.dimensions() - 1, place = scalars.firstVoxel(column.front());
  for (int z = std::max(-place.z, 0); z < n && place.z + z <= last.z; ++z)
    for (int y = std::max(-place.y, 0); y < n && place.y + y <= last.y; ++y) {
      // Adds the value of a voxel of the row. Returns whether it is active.
      const auto add = [&](std::size_t brick, int x) {
        const float value = scalars.scalarAt(brick, ScalarBricks::indexInBrick({x, y, z}));
        if (value != kInactiveVoxel) values.push_back(value);
        return value != kInactiveVoxel;
      };
      const bool isOnSide = place.z + z == 0 || place.z + z == last.z || place.y + y == 0 || place.y + y == last.y;
      bool isFound = false;
      for (auto brick = column.begin(); brick != column.end() && !isFound; ++brick) {
        const int first = scalars.firstVoxel(*brick).x;
        for (int x = std::max(-first, 0); x < n && first + x <= last.x && !isFound; ++x) isFound = add(*brick, x) && !isOnSide;
      }
      if (!isFound) continue;
      isFound = false;
      for (auto brick = column.rbegin(); brick != column.rend() && !isFound; ++brick) {
        const int first = scalars.firstVoxel(*brick).x;
        for (int x = std::min(n - 1, last.x - first); x >= std::max(-first, 0) && !isFound; --x) isFound = add(*brick, x);
      }
    }
}

std::vector<float> valuesOnSides(const Volume& volume) {
  const ScalarBricks& scalars = volume.scalars;
  const std::vector<std::size_t> order = scalars.inOrder();
  const auto isSameColumn = [&](std::size_t a, std::size_t b) {
    return glm::ivec2(scalars.cell(a).y, scalars.cell(a).z) == glm::ivec2(scalars.cell(b).y, scalars.cell(b).z);
  };
  std::vector<float> values;
  for (auto first = order.begin(); first != order.end();) {
    const auto end = std::find_if_not(first, order.end(), [&](std::size_t brick) { return isSameColumn(brick, *first); });
    addValuesOnSides(scalars, {first, end}, values);
    first = end;
  }
  return values;
}

/// The smallest and the largest of the values of active voxels that are not `without`.
std::pair<float, float> rangeWithout(const Volume& volume, float without) {
  using Range = std::pair<float, float>;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, volume.scalars.count()), Range(kHuge, -kHuge),
      [&](const tbb::blocked_range<std::size_t>& part, Range range) {
        for (std::size_t i = part.begin(); i != part.end(); ++i)
          for (const float value : volume.scalars.brick(i))
            if (value != kInactiveVoxel && value != without) range = {std::min(range.first, value), std::max(range.second, value)};
        return range;
      },
      [](const Range& a, const Range& b) { return Range(std::min(a.first, b.first), std::max(a.second, b.second)); });
}

/// The median of the values of active voxels that are not `without`, of a sample.
double medianWithout(const Volume& volume, float without) {
  constexpr std::size_t kSamples = 100'000;
  const std::size_t all = volume.scalars.count() * ScalarBricks::kVoxels,
                    step = (all / kSamples) | 1u;  // odd: in all places of bricks
  std::vector<float> values;
  for (std::size_t i = 0; i < all; i += step) {
    const float value = volume.scalars.brick(i / ScalarBricks::kVoxels)[i % ScalarBricks::kVoxels];
    if (value != kInactiveVoxel && value != without) values.push_back(value);
  }
  if (values.empty()) return without;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Whether the active voxels have few different values beside `without`, as labels have.
bool areLabels(const Volume& volume, float without) {
  constexpr std::size_t kMaxLabels = 32;
  std::set<float> found;
  for (std::size_t i = 0; i < volume.scalars.count(); ++i)
    for (const float value : volume.scalars.brick(i))
      if (value != kInactiveVoxel && value != without && found.insert(value).second && found.size() > kMaxLabels) return false;
  return true;
}

/// The class that most values belong to, or the lowest if no class has half of them.
int commonClass(std::span<const float> values, std::span<const double> thresholds) {
  std::array<std::size_t, kClasses> counts{};
  for (const float value : values)
    ++counts[std::size_t(std::ranges::count_if(thresholds, [&](double threshold) { return threshold <= value; }))];
  const auto most = std::ranges::max_element(counts);
  return 2 * *most > values.size() ? int(most - counts.begin()) : 0;
}

/// The last class whose mean is as good as that of the lowest.
int lastClassOfAir(const Classes& classes) {
  constexpr double kSame = 0.1 * double(kBins);
  const auto isAir = [&](double mean) { return mean <= classes.means[0] + kSame; };
  return int(std::ranges::count_if(classes.means, isAir)) - 1;
}

/// The value at the beginning of a bin.
double beginOf(const Histogram& histogram, std::size_t bin) {
  const double range = double(histogram.maximum) - double(histogram.minimum);
  return histogram.minimum + range * double(bin) / double(histogram.counts.size());
}

/// The value below which all voxels but the outliers are.
double highestUsual(const Histogram& histogram) {
  return beginOf(histogram, histogram.binOfRank((1.0 - kOutliers) * double(histogram.count())) + 1);
}

/// The value above which all voxels but the outliers are.
double lowestUsual(const Histogram& histogram) {
  return beginOf(histogram, histogram.binOfRank(std::floor(kOutliers * double(histogram.count())) + 1.0));
}

/// The values of a scan that projections show as black and white.
std::pair<double, double> visibleRange(const Volume& volume, IntensityProjection projection) {
  const std::vector<TransferFunction::OpacityPoint> classes = scanTransferFunction(volume).opacity;
  const auto visible = std::ranges::find_if(classes, [](const auto& point) { return point.opacity > 0.0f; });
  const bool isLowest = visible == classes.begin() || visible == classes.end();
  const double low = isLowest ? double(volume.minimum) : double(std::prev(visible)->scalar);
  const Histogram histogram = histogramOf(volume, kFineBins);
  if (projection == IntensityProjection::Maximum) return {low, highestUsual(histogram)};
  const double width = (double(histogram.maximum) - double(histogram.minimum)) / double(histogram.counts.size());
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double value = histogram.minimum + (double(i) + 0.5) * width;
    if (value < low) continue;
    sum += value * double(histogram.counts[i]);
    count += double(histogram.counts[i]);
  }
  return {volume.minimum, count > 0.0 ? sum / count : double(volume.maximum)};
}

}  // namespace

bool looksLikeScan(const Volume& volume) {
  if (volume.isSolid || !(volume.minimum < volume.maximum)) return false;
  if (double(volume.negativeVoxels) > 0.01 * double(volume.activeVoxels)) return true;
  return !volume.isFog && double(volume.activeVoxels + volume.missingVoxels) >= 0.95 * double(volume.voxelCount());
}

std::optional<float> paddingOf(const Volume& volume) {
  constexpr double kMinOnSides = 0.1, kMinOthers = 0.05, kMinGap = 0.3, kMinGapToHalf = 0.5;
  constexpr double kMinPart = 0.2;  // of the range, which the half of the values may be narrower than
  if (!looksLikeScan(volume)) return std::nullopt;
  const std::vector<float> sides = valuesOnSides(volume);
  for (const float value : {volume.minimum, volume.maximum}) {
    const double share = double(std::ranges::count(sides, value)) / double(sides.size());
    if (value == 0.0f || share < kMinOnSides) continue;
    const auto [least, most] = rangeWithout(volume, value);
    const double width = double(most) - double(least);
    const double gap = value < least ? double(least) - double(value) : double(value) - double(most);
    if (!(width > 0.0) || !(gap > 0.0)) continue;
    // Few values far away, such as those of metal, do not bring the padding nearer.
    const double median = medianWithout(volume, value), half = value < least ? median - least : most - median;
    const bool isFar = gap > kMinGap * width || gap > kMinGapToHalf * std::max(half, kMinPart * width);
    if ((gap > width || (share <= 1.0 - kMinOthers && isFar)) && !areLabels(volume, value)) return value;
  }
  return std::nullopt;
}

std::string paddingRemark(float padding) {
  return fmt::format("the value {:g} around the scan counts as no data ({} keeps it)", padding, Parameter("no-data", "none"));
}

void settleNoData(Volume& volume, const std::optional<NoData>& noData) {
  if (noData) {
    if (looksLikeScan(volume)) volume.padding = noData->scalar();
    return;
  }
  volume.padding = paddingOf(volume);
  if (!volume.padding) return;
  summariseValues(volume, *volume.padding);
  volume.remarks.push_back(paddingRemark(*volume.padding));
}

bool looksLikeFog(const Volume& volume) {
  constexpr double kMaxDensity = 10.0, kMinEmpty = 0.9;
  if (volume.minimum != 0.0f || !(volume.maximum > 0.0f) || double(volume.maximum) > kMaxDensity) return false;
  const std::vector<float> sides = valuesOnSides(volume);
  if (double(std::ranges::count(sides, 0.0f)) < kMinEmpty * double(sides.size())) return false;
  const auto isFraction = [](float value) { return value != kInactiveVoxel && value != std::floor(value); };
  if (!volume.scalars.values().empty() && std::ranges::none_of(volume.scalars.values(), isFraction)) return false;
  for (std::size_t i = 0; i < volume.scalars.count(); ++i)
    if (std::ranges::any_of(volume.scalars.brick(i), isFraction)) return true;
  return false;
}

void orientScan(Volume& volume) {
  if (!looksLikeScan(volume)) return;
  volume.upReason = "it looks like a scan";
  volume.up = {0.0, 0.0, 1.0};
}

ValueWindow usualRange(const Volume& volume) {
  const Histogram fine = histogramOf(volume, kFineBins);
  ValueWindow range{lowestUsual(fine), highestUsual(fine)};
  if (!looksLikeScan(volume) && volume.minimum >= 0.0f) range.low = 0.0;
  if (!(float(range.low) < float(range.high))) range = {volume.minimum, volume.maximum};
  if (!(float(range.low) < float(range.high))) range = {std::min(range.low, 0.0), std::max(range.high, 1.0)};
  return range;
}

TransferFunction scanTransferFunction(const Volume& volume) {
  const Histogram fine = histogramOf(volume, kFineBins);
  const double low = volume.minimum, high = highestUsual(fine), width = (high - low) / double(kBins);
  const double fineWidth = (double(volume.maximum) - low) / kFineBins;
  std::array<double, kBins> weights{};
  for (std::size_t i = 0; i < fine.counts.size(); ++i) {
    const double value = low + (double(i) + 0.5) * fineWidth;
    if (value < high) weights[std::min(std::size_t((value - low) / width), kBins - 1)] += double(fine.counts[i]);
  }
  std::ranges::transform(weights, weights.begin(), [](double count) { return std::sqrt(count); });
  const Classes classes = classesOf(weights);
  const auto valueOf = [&](double bin) { return low + bin * width; };

  std::array<double, kClasses - 1> thresholds{};
  std::ranges::transform(classes.thresholds, thresholds.begin(), valueOf);
  // What padding surrounds is in air, the noise of which may make two classes.
  const int transparent = volume.padding ? lastClassOfAir(classes) : commonClass(valuesOnSides(volume), thresholds);
  const auto opacityOf = [&](int number) {
    if (volume.padding) return number > transparent ? kOpacities[std::size_t(number)] : 0.0f;
    return kOpacities[std::size_t(std::abs(number - transparent))];
  };

  TransferFunction function;
  const glm::dvec3 extent = glm::dvec3(volume.dimensions) *
                            glm::dvec3(glm::length(volume.indexToWorld[0]), glm::length(volume.indexToWorld[1]),
                                       glm::length(volume.indexToWorld[2]));
  function.unitDistance = std::max({extent.x, extent.y, extent.z}) / kLengthsAlongBox;
  const auto addOpacity = [&](double bin, float opacity) {
    const auto value = float(valueOf(bin));
    const float least = function.opacity.empty() ? value : std::nextafter(function.opacity.back().scalar, kHuge);
    function.opacity.push_back({std::max(value, least), opacity});
  };
  for (int i = 0; i + 1 < kClasses; ++i) {
    const double threshold = classes.thresholds[std::size_t(i)];
    const double ramp =
        kRamp * std::min(threshold - classes.means[std::size_t(i)], classes.means[std::size_t(i + 1)] - threshold);
    addOpacity(threshold - ramp, opacityOf(i));
    addOpacity(threshold + ramp, opacityOf(i + 1));
  }
  for (std::size_t i = 0; i < kClasses; ++i) {
    const auto value = float(valueOf(classes.means[i]));
    const float least = function.color.empty() ? value : std::nextafter(function.color.back().scalar, kHuge);
    function.color.push_back({std::max(value, least), kColors[i]});
  }
  return function;
}

bool drawsAir(const Volume& volume, const TransferFunction& function) {
  constexpr std::size_t kMostSamples = 4096;
  constexpr double kNearlyAll = 0.8, kLeastOpacity = 0.01;
  if (!looksLikeScan(volume)) return false;
  const Classification automatic{.transferFunction = scanTransferFunction(volume)}, given{.transferFunction = function};
  if (classify(automatic, volume.minimum).extinction > 0.0) return false;  // what surrounds the rest is brighter than that
  const std::vector<float> sides = valuesOnSides(volume);
  const std::size_t step = sides.size() / kMostSamples + 1;
  std::size_t samples = 0, drawn = 0;
  for (std::size_t i = 0; i < sides.size(); i += step, ++samples)
    if (classify(automatic, sides[i]).extinction == 0.0 &&
        classify(given, sides[i]).extinction * automatic.transferFunction->unitDistance > kLeastOpacity)
      ++drawn;
  return double(drawn) > kNearlyAll * double(samples);
}

TransferFunction intensityFunction(const Volume& volume, IntensityProjection projection) {
  constexpr int kSteps = 32;
  auto [low, high] =
      looksLikeScan(volume) ? visibleRange(volume, projection) : std::pair(std::min(double(volume.minimum), 0.0), double(volume.maximum));
  if (!(low < high)) high = low + 1.0;
  TransferFunction function{.opacity = {}, .color = {{float(low), glm::vec3(1.0f)}}, .unitDistance = volume.voxelSize()};
  for (int i = 0; i <= kSteps; ++i) {
    const double part = double(i) / kSteps;
    function.opacity.push_back({float(low + part * (high - low)), linearFromSrgb(float(part))});
  }
  return function;
}

TransferFunction isoFunction(const IsoSurface& surface, const Volume& volume) {
  constexpr double kVoxelsOfUnit = 1.0 / 64.0;
  const auto value = float(surface.value);
  return {
      .opacity = {{std::nextafter(value, -kHuge), 0.0f}, {value, 1.0f}},
      // As wide as the values, which a function's table resolves only near its points.
      .color = {{std::min(volume.minimum, value), glm::vec3(surface.color)}, {std::max(volume.maximum, value), glm::vec3(surface.color)}},
      .unitDistance = kVoxelsOfUnit * volume.voxelSize()};
}

}  // namespace freevoxels
