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
  return size == other.size && first == other.first && extent == other.extent && channels == other.channels &&
         std::equal(digits.begin(), digits.begin() + channels, other.digits.begin()) && method == other.method;
}

FixedSums& FixedSums::operator+=(const FixedSums& other) {
  FV_CHECK_EQ(isLike(other), true);
  FV_CHECK_EQ(values.size(), other.values.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += other.values[i];
  return *this;
}

Image resolveSums(const FixedSums& sums, bool normalised) {
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
    glm::dvec4 result(sums.value(SumChannel::Red, i), sums.value(SumChannel::Green, i), sums.value(SumChannel::Blue, i), energy);
    if (normalised) {
      const double alpha = -std::expm1(-sums.value(SumChannel::OpticalDepth, i));
      result = glm::dvec4(glm::dvec3(result) * (energy > 0.0 ? alpha / energy : 1.0), alpha);
    }
    image.pixels[pixel] = glm::vec4(result);
    if (hasDistance && energy > 0.0) image.depth[pixel] = float(sums.value(SumChannel::Distance, i) / energy);
  }
  return image;
}

}  // namespace freevoxels
