#pragma once
// The number of images a second while something moves.

#include <chrono>
#include <deque>

namespace freevoxels {

class PictureRate {
 public:
  using Clock = std::chrono::steady_clock;

  /// Counts an image. After a pause of half a second the count starts again.
  void add(Clock::time_point now);
  /// The rate over the last two seconds; 0 with fewer than three images.
  double perSecond() const;

 private:
  std::deque<Clock::time_point> shown_;
};

}  // namespace freevoxels
