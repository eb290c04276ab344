#pragma once
// What the values of a volume's voxels are, summed up in one pass over its bricks.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "engine/volume/scalar_bricks.h"

namespace freevoxels {

struct ValueSummary {
  static constexpr std::size_t kMagnitudes = 256;  ///< exponents of floats; the first has 0 and the denormals

  std::uint64_t active = 0, nan = 0, negative = 0;
  std::uint64_t missing = 0;  ///< voxels that hold no data by their value: NaN, infinite or that of no data
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();
  std::array<std::uint64_t, kMagnitudes> counts{};  ///< of active voxels by the exponent of their value
  std::array<float, kMagnitudes> largest{};         ///< absolute value of each exponent

  void add(const ValueSummary& other);
};

/// Sums up the active voxels. Those that are NaN or infinite, or have the value of no data, become voxels without data.
ValueSummary summarise(ScalarBricks& scalars, std::optional<float> noData = {});
/// The same, of scalars that stay as they are.
ValueSummary summaryOf(const ScalarBricks& scalars);

/// Values that stray from all others: at most a thousandth of the voxels and kMaxOutliers, with absolute values more than 1024 times
/// as large as the largest of the rest.
struct Outliers {
  std::uint64_t voxels = 0;
  float limit = std::numeric_limits<float>::infinity();  ///< the largest absolute value of the rest
};
inline constexpr std::uint64_t kMaxOutliers = 100;
Outliers outliersOf(const ValueSummary& summary);
/// The smallest and the largest value, with outliers limited; 0 without active voxels.
std::pair<float, float> rangeOf(const ValueSummary& summary, const Outliers& outliers);
std::pair<float, float> rangeOf(const ScalarBricks& scalars);

/// Limits the absolute values of active voxels.
void limitValues(ScalarBricks& scalars, float limit);

}  // namespace freevoxels
