#pragma once
// The largest of many errors and its place, and the names of places in reports.

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "engine/scene/directions.h"
#include "engine/validation/report.h"
#include "engine/volume/volume.h"

namespace freevoxels {

class MaxError {
 public:
  /// Adds a figure. `where()` is only called if it is the largest so far. NaN is larger than anything.
  template <typename Where>
  void take(double figure, const Where& where) {
    if (figure <= figure_ || std::isnan(figure_)) return;
    figure_ = figure;
    where_ = where();
  }
  double figure() const { return figure_; }

  /// The check that the figure does not exceed its bound.
  Check atMost(double tolerance, std::string name, std::string unit = "") const {
    return {.name = std::move(name),
            .figure = figure_,
            .bound = Check::Bound::AtMost,
            .tolerance = tolerance,
            .unit = std::move(unit),
            .where = where_};
  }

 private:
  double figure_ = 0.0;
  std::string where_;
};

/// "voxel (1, 2, 3)", for an index (Volume::at).
std::string voxelText(const Volume& volume, std::size_t voxel);
/// "direction (1, 0, -0.5)"
std::string directionText(DirectionSet set, int direction);
/// "pixel (1, 2)", for an index in reading order.
std::string pixelText(glm::ivec2 imageSize, std::size_t pixel);

/// The largest difference of two ways to the same image in floats, beside which are a few roundings for each splat or stretch.
inline constexpr double kImageTolerance = 1e-5;

/// Largest difference of two images of equal size in premultiplied RGBA. Colours of flames, which exceed 1,
/// are compared relative to the brightest component of `b`.
MaxError largestDifference(const Image& a, const Image& b);

}  // namespace freevoxels
