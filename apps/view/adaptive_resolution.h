#pragma once
// Chooses the resolution of images while something moves, so that enough of them are shown a second.

#include <cstddef>

namespace freevoxels {

class AdaptiveResolution {
 public:
  /// Largest number of voxels along the longest edge of the volume.
  int voxelsAlongEdge() const;
  /// Scale of the image's edges, in 0.2..1.
  double scale() const { return scale_; }
  /// Reports the time of the last image.
  void took(double milliseconds);

 private:
  std::size_t step_ = 1;  ///< index into the numbers of voxels
  double scale_ = 0.5;
  int pictures_ = 0;  ///< consecutive images that call for another number of voxels
  int rest_ = 0;      ///< images before more voxels are tried
};

}  // namespace freevoxels
