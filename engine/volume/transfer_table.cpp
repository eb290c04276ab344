#include "engine/volume/transfer_table.h"

#include <algorithm>
#include <cmath>

#include "engine/volume/voxel_classifier.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

constexpr int kIntervals = shader::kTransferIntervals;
/// Scalars up to this many times the extent of the function's points outside of these have codes of their own.
constexpr double kOutside = 4.0;

}  // namespace

TransferTable::TransferTable(const TransferFunction& function, float minimum, float maximum)
    : low_(minimum), high_(maximum) {
  const double first = std::min(function.opacity.front().scalar, function.color.front().scalar);
  const double last = std::max(function.opacity.back().scalar, function.color.back().scalar);
  if (last > first) {
    // In steps, so that a function that is edited keeps the codes most of the time.
    const double outside = kOutside * (last - first), size = std::exp2(std::ceil(std::log2(last - first + 2.0 * outside))),
                 step = size / 4.0;
    const double begin = step * std::floor((first - outside) / step), end = begin + size + step;
    low_ = std::clamp(low_, begin, end);
    high_ = std::clamp(high_, begin, end);
  }
  const TransferIntegral integral(function, float(low_), float(high_));
  const double interval = (high_ - low_) / kIntervals;
  for (int i = 0; i < kIntervals; ++i) means_.push_back(integral.mean(low_ + i * interval, low_ + (i + 1) * interval));
}

std::uint16_t TransferTable::code(float scalar) const {
  if (scalar == kInactiveVoxel) return 0;
  if (!(high_ > low_)) return 1;
  const double part = (double(scalar) - low_) / (high_ - low_);
  return std::uint16_t(1.5 + std::clamp(part, 0.0, 1.0) * shader::kScalarCodes);
}

std::vector<glm::vec4> TransferTable::texels(double extinctionScale) const {
  std::vector<glm::vec4> result;
  glm::dvec4 integral(0.0);
  for (const glm::dvec4& mean : means_) {
    result.emplace_back(extinctionScale * integral);
    result.emplace_back(extinctionScale * mean);
    integral += mean;
  }
  return result;
}

}  // namespace freevoxels
