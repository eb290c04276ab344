#include "engine/image/sample_lattice.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

using namespace shader;

constexpr double kNoDistance = -1.0;
constexpr int kMaxSamples = 1 << 16;
/// Larger images have no more samples than this as long as that is one a pixel. Their sums take 0.63 GiB.
constexpr double kManySamples = 1 << 24;
/// No image has more samples than this, which a texel buffer can hold.
constexpr double kMostSamples = 1 << 26;

/// A weighted sum of samples, with weights of both signs. Its mean distance stays within the range of those of the samples.
class WeightedSamples {
 public:
  void add(double weight, const LatticeSample& sample) {
    sum_.color += weight * sample.color;
    if (sample.color.a <= 0.0 || sample.distance < 0.0) return;
    sum_.distance += weight * sample.distance;
    if (sample.color.a < double(kMinRangeEnergy)) return;
    const double distance = sample.distance / sample.color.a;
    low_ = std::min(low_, distance);
    high_ = std::max(high_, distance);
  }
  LatticeSample sum() const {
    LatticeSample result = sum_;
    result.distance = result.color.a > 0.0 && low_ <= high_
                          ? std::clamp(sum_.distance, result.color.a * low_, result.color.a * high_)
                          : kNoDistance;
    return result;
  }

 private:
  LatticeSample sum_;
  double low_ = std::numeric_limits<double>::max(), high_ = 0.0;
};

int marchAxis(const SampleLattice& lattice, glm::dvec2 position) {
  const bool seen = glm::all(glm::greaterThanEqual(position, lattice.seenLow)) && glm::all(glm::lessThanEqual(position, lattice.seenHigh));
  glm::dvec3 along;
  for (int axis = 0; axis < 3; ++axis) along[axis] = std::abs(glm::dot(lattice.axes[std::size_t(axis)].along, glm::dvec3(1.0, position)));
  const double largest = std::max({along.x, along.y, along.z});
  if (!seen || along[lattice.mainAxis] >= double(kMinAlong) * largest) return lattice.mainAxis;
  return along.x == largest ? 0 : along.y == largest ? 1 : 2;
}

/// The covariance (xx, xy, yy) that a sample lacks, in squares of the pitch.
glm::dvec3 missingCovariance(const SampleLattice& lattice, glm::dvec2 position, double distance) {
  const SampleLattice::Axis& axis = lattice.axes[std::size_t(marchAxis(lattice, position))];
  const double scale = lattice.orthographic ? 1.0 : 1.0 / distance;
  const glm::dvec2 tilt = scale * (axis.tilt - axis.tiltDepth * position);
  const glm::dvec3 covariance =
      double(kFootprintVariance) / (lattice.pitch * lattice.pitch) * glm::dvec3(tilt.x * tilt.x, tilt.x * tilt.y, tilt.y * tilt.y);
  return covariance * std::min(double(kMaxVariance) / std::max(covariance.x + covariance.z, 1e-20), 1.0);
}

LatticeSample stencilAt(const SampleLattice& lattice, const std::vector<LatticeSample>& samples, glm::ivec2 index) {
  std::array<const LatticeSample*, 9> around;
  double energy = 0.0, distance = 0.0;
  for (int i = 0; i < 9; ++i) {
    const glm::ivec2 place = glm::clamp(index + glm::ivec2(i % 3 - 1, i / 3 - 1), glm::ivec2(0), lattice.samples - 1);
    around[std::size_t(i)] = &samples[std::size_t(place.x) + std::size_t(lattice.samples.x) * std::size_t(place.y)];
    energy += around[std::size_t(i)]->color.a;
    distance += around[std::size_t(i)]->distance;
  }
  glm::dvec3 covariance(0.0);
  if (energy > 1e-20 && distance > 0.0)
    covariance = missingCovariance(lattice, lattice.first + lattice.pitch * glm::dvec2(index), distance / energy);
  const double cross = 0.25 * covariance.y, x = 0.5 * covariance.x, y = 0.5 * covariance.z;
  const std::array<double, 9> weights{cross, y, -cross, x, 1.0 - covariance.x - covariance.z, x, -cross, y, cross};
  WeightedSamples sum;
  double depth = 0.0;
  for (std::size_t i = 0; i < 9; ++i) {
    sum.add(weights[i], *around[i]);
    depth -= weights[i] * std::log(std::max(1.0 - around[i]->color.a, double(kMinTransmittance)));
  }
  LatticeSample result = sum.sum();
  // Footprints add up optical depths.
  if (result.color.a <= double(kMinTransmittance)) return result;
  const double scale = -std::expm1(-std::max(depth, 0.0)) / result.color.a;
  return {scale * result.color, scale * result.distance};
}

std::vector<LatticeSample> stencilled(const SampleLattice& lattice, const std::vector<LatticeSample>& samples) {
  std::vector<LatticeSample> result(samples.size());
  tbb::parallel_for(0, lattice.samples.y, [&](int y) {
    for (int x = 0; x < lattice.samples.x; ++x)
      result[std::size_t(x) + std::size_t(lattice.samples.x) * std::size_t(y)] = stencilAt(lattice, samples, {x, y});
  });
  return result;
}

/// The weight of a sample at distance x from a position.
double catmullRom(double x) {
  x = std::abs(x);
  return x < 1.0 ? 1.0 + x * x * (1.5 * x - 2.5) : x < 2.0 ? 2.0 + x * (-4.0 + x * (2.5 - 0.5 * x)) : 0.0;
}

/// The weight of a sample at distance x from the middle of a pixel, of half a width of `half` samples: Simpson's rule.
double pixelWeight(double x, double half) {
  return (catmullRom(x - half) + 4.0 * catmullRom(x) + catmullRom(x + half)) / 6.0;
}

/// Samples along one side of the image become pixels. `from` is the size of `samples`.
std::vector<LatticeSample> resampled(const SampleLattice& lattice, const std::vector<LatticeSample>& samples, glm::ivec2 from, int side,
                                     int pixels) {
  glm::ivec2 to = from;
  to[side] = pixels;
  std::vector<LatticeSample> result(std::size_t(to.x) * std::size_t(to.y));
  const std::size_t step = side == 0 ? 1 : std::size_t(from.x);
  const int own = lattice.raysOfPixel, taps = own > 0 ? own : lattice.pitch >= 1.0 ? kSparseResampleTaps : kResampleTaps;
  tbb::parallel_for(0, to.y, [&](int y) {
    for (int x = 0; x < to.x; ++x) {
      glm::ivec2 place(x, y);
      const double position = place[side] / lattice.pitch + kLatticeMargin;
      const int low = own > 0 ? place[side] * own + kLatticeMargin : int(std::floor(position - 0.5 / lattice.pitch)) - 1;
      place[side] = 0;
      const std::size_t start = std::size_t(place.x) + std::size_t(from.x) * std::size_t(place.y);
      WeightedSamples sum;
      for (int i = low; i < low + taps; ++i)
        sum.add(own > 0 ? 1.0 / own : pixelWeight(position - i, 0.5 / lattice.pitch),
                samples[start + step * std::size_t(std::clamp(i, 0, lattice.samples[side] - 1))]);
      result[std::size_t(x) + std::size_t(to.x) * std::size_t(y)] = sum.sum();
    }
  });
  return result;
}

/// All numbers of a lattice, in the order of its text.
template <typename Lattice, typename Visit>
void visitNumbers(Lattice& lattice, const Visit& visit) {
  visit(lattice.samples.x), visit(lattice.samples.y), visit(lattice.pitch), visit(lattice.first.x), visit(lattice.first.y);
  for (auto& axis : lattice.axes) {
    for (int i = 0; i < 3; ++i) visit(axis.along[i]);
    visit(axis.tilt.x), visit(axis.tilt.y), visit(axis.tiltDepth);
  }
  visit(lattice.mainAxis), visit(lattice.orthographic), visit(lattice.scalars), visit(lattice.depth), visit(lattice.raysOfPixel);
  for (auto* corner : {&lattice.seenLow, &lattice.seenHigh}) visit(corner->x), visit(corner->y);
}

}  // namespace

glm::ivec2 latticeSamples(glm::ivec2 size, double pitch) {
  return (glm::ivec2(glm::floor(glm::dvec2(size - 1) / pitch)) + 2 * kLatticeMargin + 2) | 1;
}

double leastPitch(glm::ivec2 size) {
  const double pixels = double(size.x) * size.y;
  const double least = std::max(std::clamp(std::sqrt(pixels / kManySamples), double(kMinPitch), 1.0), std::sqrt(pixels / kMostSamples));
  return std::round(least * kPitchUnits) / kPitchUnits;
}

int raysOfHeldOutPixel(glm::ivec2 size) {
  const double pixels = double(size.x) * size.y;
  if (pixels > kMostSamples)
    fail(ErrorKind::Usage, "an image with {} has at most {} pixels, and {}x{} are more: draw a smaller one", Parameter("holdout"),
         int(kMostSamples), size.x, size.y);
  return 4.0 * pixels <= kManySamples ? 2 : 1;
}

std::string latticeText(const SampleLattice& lattice) {
  std::string text;
  visitNumbers(lattice, [&](auto number) { text += fmt::format("{}{}", text.empty() ? "" : " ", double(number)); });
  return text;
}

SampleLattice latticeOf(const std::string& text) {
  SampleLattice lattice;
  std::istringstream words(text);
  bool isValid = true;
  visitNumbers(lattice, [&](auto& number) {
    double value = 0.0;
    isValid = isValid && words >> value && std::isfinite(value) && std::abs(value) < 2e9;
    number = std::remove_reference_t<decltype(number)>(isValid ? value : 0.0);
  });
  std::string rest;
  isValid = isValid && !(words >> rest) && glm::all(glm::greaterThan(lattice.samples, glm::ivec2(3))) &&
            glm::all(glm::lessThan(lattice.samples, glm::ivec2(kMaxSamples))) && lattice.pitch >= double(kMinPitch) &&
            lattice.mainAxis >= 0 && lattice.mainAxis < 3 && (lattice.raysOfPixel == 0 || lattice.pitch * lattice.raysOfPixel == 1.0);
  if (!isValid) throw std::invalid_argument("its lattice of samples is damaged");
  return lattice;
}

Image resolveLattice(const SampleLattice& lattice, glm::ivec2 size, std::vector<LatticeSample> samples) {
  FV_CHECK_EQ(samples.size(), std::size_t(lattice.samples.x) * std::size_t(lattice.samples.y));
  if (!lattice.scalars && lattice.raysOfPixel == 0) samples = stencilled(lattice, samples);
  samples = resampled(lattice, samples, lattice.samples, 0, size.x);
  const std::vector<LatticeSample> pixels = resampled(lattice, samples, {size.x, lattice.samples.y}, 1, size.y);
  Image image{.size = size};
  for (const LatticeSample& pixel : pixels) {
    const double alpha = std::clamp(pixel.color.a, 0.0, 1.0);
    image.pixels.emplace_back(glm::max(glm::dvec3(pixel.color), glm::dvec3(0.0)), alpha);
    if (!lattice.depth) continue;
    const bool known = alpha > 0.0 && pixel.distance >= 0.0;
    image.depth.push_back(known ? float(pixel.distance / alpha) : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace freevoxels
