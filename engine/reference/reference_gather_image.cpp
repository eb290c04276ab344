// The part of ReferenceGather from the sums of the samples to the image.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/reference/reference_gather.h"

namespace freevoxels {

namespace {

/// Variance in squared voxels of a splat's round kernel along one axis. A slice's tent has it across the
/// slice.
constexpr double kKernelVariance = 0.1624;
constexpr double kMaxVariance = 0.8;  ///< largest variance that a stencil of 3x3 samples can add, in squares of the pitch
constexpr double kMinTransmittance = 1e-6;
constexpr double kNegligible = 1e-6;  ///< energy of samples that do not widen the range of mean distances
constexpr double kUnknown = -1.0;

/// Adds samples with weights of both signs. The mean distance of the result stays between those of the samples.
class WeightedSum {
 public:
  void add(double weight, const GatherSums& sample) {
    sum_.color += weight * sample.color;
    sum_.energy += weight * sample.energy;
    if (!(sample.energy > 0.0) || sample.distance < 0.0) return;
    sum_.distance += weight * sample.distance;
    if (sample.energy < kNegligible) return;
    nearest_ = std::min(nearest_, sample.distance / sample.energy);
    farthest_ = std::max(farthest_, sample.distance / sample.energy);
  }
  GatherSums result() const {
    GatherSums sum = sum_;
    const bool known = sum.energy > 0.0 && nearest_ <= farthest_;
    sum.distance = known ? std::clamp(sum.distance, sum.energy * nearest_, sum.energy * farthest_) : kUnknown;
    return sum;
  }

 private:
  GatherSums sum_;
  double nearest_ = std::numeric_limits<double>::max(), farthest_ = 0.0;
};

/// Adds Catmull-Rom weights at `position` of the samples from `first` on, times `factor`.
void addCubicWeights(std::array<double, 6>& weights, int first, double position, double factor) {
  const int low = int(std::floor(position));
  const double x = position - low, x2 = x * x, x3 = x2 * x;
  const std::array<double, 4> cubic{-0.5 * x + x2 - 0.5 * x3, 1.0 - 2.5 * x2 + 1.5 * x3, 0.5 * x + 2.0 * x2 - 1.5 * x3,
                                    -0.5 * x2 + 0.5 * x3};
  // If the position is that of a sample, the first or the last of the four may be beyond the six; its weight is 0.
  for (int i = 0; i < 4; ++i)
    if (const int place = low - 1 + i - first; place >= 0 && place < 6) weights[std::size_t(place)] += factor * cubic[std::size_t(i)];
}

}  // namespace

/// The missing covariance (xx, xy, yy) in squares of the pitch: a tent seen obliquely lacks the kernel's
/// variance along the image of the axis.
glm::dvec3 ReferenceGather::missingCovariance(glm::dvec2 position, double distance) const {
  const int axis = axisOf(position, rayThrough(position));
  const double scale = rays_.orthographic ? 1.0 : 1.0 / distance;
  const glm::dvec3 step = toPixel_[axis];
  const glm::dvec2 tilt = scale * (glm::dvec2(step) - (rays_.orthographic ? 0.0 : step.z) * position);
  const double perSquare = kKernelVariance / (lattice_.pitch * lattice_.pitch);
  const glm::dvec3 covariance = perSquare * glm::dvec3(tilt.x * tilt.x, tilt.x * tilt.y, tilt.y * tilt.y);
  const double sum = covariance.x + covariance.z;
  return sum > kMaxVariance ? kMaxVariance / sum * covariance : covariance;
}

GatherSums ReferenceGather::smoothedAt(const std::vector<GatherSums>& samples, glm::ivec2 sample) const {
  const auto neighbour = [&](int x, int y) -> const GatherSums& {
    const glm::ivec2 place = glm::clamp(sample + glm::ivec2(x, y), glm::ivec2(0), lattice_.samples - 1);
    return samples[std::size_t(place.x) + std::size_t(lattice_.samples.x) * std::size_t(place.y)];
  };
  double energy = 0.0, distances = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      energy += neighbour(x, y).energy;
      distances += neighbour(x, y).distance;
    }
  glm::dvec3 covariance(0.0);
  if (energy > 1e-20 && distances > 0.0) covariance = missingCovariance(positionOf(sample), distances / energy);
  WeightedSum sum;
  double depth = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      // Half the second derivative along each direction: the mean of a quadratic over a distribution of this
      // covariance.
      const double weight = x == 0 && y == 0 ? 1.0 - covariance.x - covariance.z
                            : x != 0 && y != 0 ? 0.25 * x * y * covariance.y
                            : x != 0           ? 0.5 * covariance.x
                                               : 0.5 * covariance.z;
      sum.add(weight, neighbour(x, y));
      depth -= weight * std::log(std::max(1.0 - neighbour(x, y).energy, kMinTransmittance));
    }
  GatherSums result = sum.result();
  // Footprints add up optical depths.
  if (result.energy <= kMinTransmittance) return result;
  const double scale = -std::expm1(-std::max(depth, 0.0)) / result.energy;
  return {.color = scale * result.color, .energy = scale * result.energy, .distance = scale * result.distance};
}

std::vector<GatherSums> ReferenceGather::smoothed(const std::vector<GatherSums>& samples) const {
  if (hasScalars()) return samples;
  std::vector<GatherSums> result;
  for (int y = 0; y < lattice_.samples.y; ++y)
    for (int x = 0; x < lattice_.samples.x; ++x) result.push_back(smoothedAt(samples, {x, y}));
  return result;
}

/// Makes rows or columns of pixels of those of samples: the mean over a pixel, by Simpson's rule, of the interpolation.
std::vector<GatherSums> ReferenceGather::resampled(const std::vector<GatherSums>& from, glm::ivec2 fromSize, int side) const {
  glm::ivec2 size = fromSize;
  size[side] = size_[side];
  const int taps = lattice_.pitch >= 1.0 ? 5 : 6;  // whose distances limit that of the pixel
  std::vector<GatherSums> result;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      glm::ivec2 place(x, y);
      const double position = place[side] / lattice_.pitch + 1.0;  // the lattice begins one sample before the first pixel
      const int first = int(std::floor(position - 0.5 / lattice_.pitch)) - 1;
      std::array<double, 6> weights{};
      for (const int end : {-1, 0, 1})
        addCubicWeights(weights, first, position + 0.5 * end / lattice_.pitch, end == 0 ? 4.0 / 6.0 : 1.0 / 6.0);
      WeightedSum sum;
      for (int i = 0; i < taps; ++i) {
        place[side] = std::clamp(first + i, 0, lattice_.samples[side] - 1);
        sum.add(weights[std::size_t(i)], from[std::size_t(place.x) + std::size_t(fromSize.x) * std::size_t(place.y)]);
      }
      result.push_back(sum.result());
    }
  return result;
}

Image ReferenceGather::image(const std::vector<GatherSums>& smoothed) const {
  const std::vector<GatherSums> rows = resampled(smoothed, lattice_.samples, 0);
  const std::vector<GatherSums> pixels = resampled(rows, {size_.x, lattice_.samples.y}, 1);
  Image image;
  image.size = size_;
  for (const GatherSums& pixel : pixels) {
    const double alpha = std::clamp(pixel.energy, 0.0, 1.0);
    image.pixels.emplace_back(glm::max(pixel.color, glm::dvec3(0.0)), alpha);
    const bool known = alpha > 0.0 && pixel.distance >= 0.0;
    image.depth.push_back(known ? float(pixel.distance / alpha) : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace freevoxels
