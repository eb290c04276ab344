#pragma once
// How many images a second are shown while something moves, and the resolution that they have for it.

#include <chrono>
#include <cstddef>
#include <deque>
#include <limits>

#include "engine/scene/draft_quality.h"

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
  explicit AdaptiveResolution(Voxels voxels);

  /// Largest number of voxels along the longest edge of the volume.
  int voxelsAlongEdge() const;
  /// FrameSettings::quality of an image in the window's size.
  double quality() const { return draft_.quality(); }
  /// Chooses the quality of the first images from the time that a whole image took, of all voxels, until the first of them is reported.
  void beginFrom(double wholeMilliseconds) {
    draft_.beginFrom(wholeMilliseconds, 1.0);
    begins_ = true;
  }
  /// Reports the time of the last image.
  void took(double milliseconds);

 private:
  static constexpr std::size_t kFirstStep = 1;

  bool all_;
  std::size_t step_;  ///< index into the numbers of voxels
  DraftQuality draft_;
  bool begins_ = false;  ///< whether the quality is an estimate from a whole image
  int images_ = 0;  ///< consecutive images that call for another number of voxels
  int rest_ = 0;      ///< images before more voxels are tried
};

}  // namespace freevoxels
