#pragma once
// One fraction of a whole frame, of the fractions of its parts.

#include <algorithm>
#include <chrono>
#include <memory>
#include <string_view>

#include "engine/core/stages.h"

namespace freevoxels {

/// A fraction that never decreases. A frame consists of submissions whose number is not known beforehand, and each counts from 0 to 1:
/// one takes up to half of what was left when it began, so that there is always room for the next.
class WholeFraction {
 public:
  double next(double ofPart) {
    if (ofPart < ofPart_) begun_ = shown_;
    ofPart_ = ofPart;
    return shown_ = std::max(shown_, begun_ + 0.5 * ofPart * (1.0 - begun_));
  }

 private:
  double begun_ = 0.0, ofPart_ = 0.0, shown_ = 0.0;
};

/// A progress function that passes such fractions on. An empty function stays empty.
inline Progress wholeProgress(const Progress& progress) {
  if (!progress) return {};
  return [progress, fraction = std::make_shared<WholeFraction>()](std::string_view stage, double ofPart) {
    progress(stage, fraction->next(ofPart));
  };
}

/// A progress function for a part that begins where `begun` of the whole is done and ends after `share` of it. An empty function stays empty.
inline Progress partOf(const Progress& progress, double begun, double share) {
  if (!progress) return {};
  return [progress, begun, share](std::string_view stage, double fraction) { progress(stage, begun + share * fraction); };
}

/// A progress function that may be called often, and passes on a call in 50 ms at most. An empty function stays empty.
inline Progress pacedProgress(const Progress& progress) {
  if (!progress) return {};
  using Clock = std::chrono::steady_clock;
  return [progress, next = std::make_shared<Clock::time_point>()](std::string_view stage, double fraction) {
    if (Clock::now() < *next) return;
    progress(stage, fraction);
    *next = Clock::now() + std::chrono::milliseconds(50);
  };
}

}  // namespace freevoxels
