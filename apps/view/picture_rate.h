#pragma once
// How many pictures a second are seen while something moves.

#include <chrono>
#include <deque>

namespace freevoxels {

class PictureRate {
 public:
  using Clock = std::chrono::steady_clock;

  /// A picture is shown. After a pause of half a second the count begins anew.
  void add(Clock::time_point now);
  /// Over the last two seconds of pictures; 0 of fewer than three.
  double perSecond() const;

 private:
  std::deque<Clock::time_point> shown_;
};

}  // namespace freevoxels
