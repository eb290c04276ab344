#include "engine/image/fixed_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace freevoxels {

double FixedSums::value(SumChannel channel, std::size_t i) const {
  const auto c = std::size_t(channel);
  return std::ldexp(double(values[c * pixelCount() + i]), -digits[c]);
}

bool FixedSums::isLike(const FixedSums& other) const {
  return size == other.size && lattice == other.lattice && first == other.first && extent == other.extent && channels == other.channels &&
         std::equal(digits.begin(), digits.begin() + channels, other.digits.begin()) && method == other.method;
}

bool FixedSums::canAdd(const FixedSums& other) const {
  FV_CHECK_EQ(values.size(), other.values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::int64_t sum = 0; __builtin_add_overflow(values[i], other.values[i], &sum)) return false;
  return true;
}

FixedSums& FixedSums::operator+=(const FixedSums& other) {
  FV_CHECK_EQ(isLike(other), true);
  FV_CHECK_EQ(values.size(), other.values.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += other.values[i];
  return *this;
}

namespace {

glm::dvec3 colorOf(const FixedSums& sums, std::size_t i) {
  return {sums.value(SumChannel::Red, i), sums.value(SumChannel::Green, i), sums.value(SumChannel::Blue, i)};
}

/// Light (rgb) and alpha of a pixel.
glm::dvec4 resolved(const FixedSums& sums, std::size_t i, bool normalised) {
  const double energy = sums.value(SumChannel::Energy, i);
  const glm::dvec3 color = colorOf(sums, i);
  if (!normalised) return {color, energy};
  const double alpha = -std::expm1(-sums.value(SumChannel::OpticalDepth, i));
  return {color * (energy > 0.0 ? alpha / energy : 1.0), alpha};
}

Image resolveSamples(const FixedSums& sums) {
  const SampleLattice& lattice = *sums.lattice;
  FV_CHECK_EQ(sums.channels, kSumChannels);  // the interpolation needs distances
  std::vector<LatticeSample> samples(std::size_t(lattice.samples.x) * std::size_t(lattice.samples.y));
  for (std::size_t i = 0; i < sums.pixelCount(); ++i) {
    const glm::ivec2 place = sums.first + glm::ivec2(int(i) % sums.extent.x, int(i) / sums.extent.x);
    const double alpha = -std::expm1(-sums.value(SumChannel::OpticalDepth, i)), energy = sums.value(SumChannel::Energy, i);
    const double scale = energy > 0.0 ? alpha / energy : 1.0;
    samples[std::size_t(place.x) + std::size_t(lattice.samples.x) * std::size_t(place.y)] = {{scale * colorOf(sums, i), alpha},
                                                                                             scale * sums.value(SumChannel::Distance, i)};
  }
  return resolveLattice(lattice, sums.size, samples);
}

}  // namespace

Image resolveSums(const FixedSums& sums, bool normalised) {
  if (sums.lattice) return resolveSamples(sums);
  Image image{.size = sums.size};
  const auto pixels = std::size_t(sums.size.x) * std::size_t(sums.size.y);
  const bool hasDistance = sums.channels == kSumChannels;
  image.pixels.resize(pixels, glm::vec4(0.0f));
  if (hasDistance) image.depth.resize(pixels, std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < sums.pixelCount(); ++i) {
    const auto x = std::size_t(sums.first.x) + i % std::size_t(sums.extent.x);
    const auto y = std::size_t(sums.first.y) + i / std::size_t(sums.extent.x);
    const std::size_t pixel = x + std::size_t(sums.size.x) * y;
    const double energy = sums.value(SumChannel::Energy, i);
    image.pixels[pixel] = glm::vec4(resolved(sums, i, normalised));
    if (hasDistance && energy > 0.0) image.depth[pixel] = float(sums.value(SumChannel::Distance, i) / energy);
  }
  return image;
}

}  // namespace freevoxels
