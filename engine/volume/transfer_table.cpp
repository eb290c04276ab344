#include "engine/volume/transfer_table.h"

#include <algorithm>
#include <cmath>

#include "engine/volume/voxel_classifier.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

constexpr int kIntervals = shader::kTransferIntervals;
/// Scalars that are farther outside of the function's points than this many times their extent get the code
/// of the range's end.
constexpr double kMaxOutside = 4.0;

}  // namespace

TransferTable::TransferTable(const TransferFunction& function, float minimum, float maximum)
    : low_(minimum), high_(maximum) {
  const double first = std::min(function.opacity.front().scalar, function.color.front().scalar);
  const double last = std::max(function.opacity.back().scalar, function.color.back().scalar);
  const double outside = kMaxOutside * (last - first);
  if (outside > 0.0) {
    low_ = std::clamp(low_, first - outside, last + outside);
    high_ = std::clamp(high_, first - outside, last + outside);
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
