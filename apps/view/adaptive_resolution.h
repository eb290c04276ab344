#pragma once
// How coarse pictures are while something moves, so that enough of them are seen a second.

#include <cstddef>

namespace freevoxels {

class AdaptiveResolution {
 public:
  /// Along the longest edge of the volume, at most.
  int voxelsAlongEdge() const;
  /// Of the picture's edges, in 0.2..1.
  double scale() const { return scale_; }
  /// How long the last picture took.
  void took(double milliseconds);

 private:
  std::size_t step_ = 1;  ///< of the numbers of voxels
  double scale_ = 0.5;
  int pictures_ = 0;  ///< in a row, that want other voxels
  int rest_ = 0;      ///< pictures before more voxels are tried
};

}  // namespace freevoxels
