#pragma once
// Numbers that are not finite.

#include <limits>

namespace freevoxels::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace freevoxels::test
