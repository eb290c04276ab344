#pragma once
// The largest of many figures and where it was, and places as a report names them.

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
  /// `where()` is asked for the place only if this is the worst so far. NaN is worse than anything.
  template <typename Where>
  void take(double figure, const Where& where) {
    if (figure <= figure_ || std::isnan(figure_)) return;
    figure_ = figure;
    where_ = where();
  }
  double figure() const { return figure_; }

  /// The figure against the most that it may be.
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

/// "voxel (1, 2, 3)", of an index into Volume::values
std::string voxelText(const Volume& volume, std::size_t voxel);
/// "direction (1, 0, -0.5)"
std::string directionText(DirectionSet set, int direction);
/// "pixel (1, 2)", of an index in reading order
std::string pixelText(glm::ivec2 imageSize, std::size_t pixel);

/// Largest difference of two pictures of one size, in premultiplied RGBA; colours of flames, which are
/// brighter than 1, relative to the brightest component of `b`.
MaxError largestDifference(const Image& a, const Image& b);

}  // namespace freevoxels
