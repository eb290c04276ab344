#pragma once
// A transfer function tabulated with its integrals over the scalar, for classification after interpolation.
// Where the scalar changes linearly from a to b along a stretch of a ray, the mean extinction of the stretch
// is (K(b) - K(a)) / (b - a), with K the integral of the extinction over the scalar; likewise for extinction
// times colour (pre-integrated classification: Engel, Kraus and Ertl 2001, Section 3.2, without
// self-attenuation).

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/classification.h"

namespace freevoxels {

/// Scalars become 16-bit codes, equally spaced between the two ends of the table's range.
class TransferTable {
 public:
  /// Tabulates the scalars from `minimum` to `maximum`, except for those far outside of the function's
  /// points: a few outliers shall not take the precision of the others.
  TransferTable(const TransferFunction& function, float minimum, float maximum);

  /// The scalars of the least and the greatest code.
  double low() const { return low_; }
  double high() const { return high_; }
  /// The code of a scalar, 1 to 65535, or 0 for kInactiveVoxel. Scalars beyond the range have the code of its
  /// end.
  std::uint16_t code(float scalar) const;
  /// Two texels for each of the shader::kTransferIntervals intervals: the integral up to its beginning, of
  /// extinction times colour (rgb) and of extinction (a), in units of intervals; and their means over the
  /// interval. Extinctions are per world unit, times `extinctionScale`.
  std::vector<glm::vec4> texels(double extinctionScale) const;

 private:
  double low_ = 0.0, high_ = 0.0;
  std::vector<glm::dvec4> means_;  ///< of each interval: extinction times colour (rgb), extinction (a)
};

}  // namespace freevoxels
