#pragma once
// How many images a second are shown while something moves, and the resolution that they have for it.

#include <chrono>
#include <cstddef>
#include <deque>
#include <limits>

namespace freevoxels {

/// More voxels along an edge than any volume has.
inline constexpr int kAllVoxels = std::numeric_limits<int>::max();

class ImageRate {
 public:
  using Clock = std::chrono::steady_clock;

  /// Counts an image. After a pause of half a second the count starts again.
  void add(Clock::time_point now);
  /// The rate over the last two seconds; 0 with fewer than three images.
  double perSecond() const;

 private:
  std::deque<Clock::time_point> shown_;
};

class AdaptiveResolution {
 public:
  enum class Voxels { All, Fewer };
  /// Images have all voxels, as while only the camera moves, so that they show the volume itself; or fewer, as while all that is made of
  /// the voxels changes.
  explicit AdaptiveResolution(Voxels voxels) : all_(voxels == Voxels::All), step_(all_ ? 0 : kFirstStep) {}

  /// Largest number of voxels along the longest edge of the volume.
  int voxelsAlongEdge() const;
  /// Scale of the image's edges, in 0.1..1.
  double scale() const { return scale_; }
  /// Chooses the scale of the first image from the time that a whole image took, of all voxels in full size.
  void beginFrom(double wholeMilliseconds);
  /// Reports the time of the last image.
  void took(double milliseconds);

 private:
  static constexpr std::size_t kFirstStep = 1;

  bool all_;
  std::size_t step_;  ///< index into the numbers of voxels
  double scale_ = 0.5;
  int images_ = 0;  ///< consecutive images that call for another number of voxels
  int rest_ = 0;      ///< images before more voxels are tried
};

}  // namespace freevoxels
