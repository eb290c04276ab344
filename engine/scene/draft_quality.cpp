#include "engine/scene/draft_quality.h"

#include <algorithm>
#include <cmath>

namespace freevoxels {

namespace {

constexpr double kLeastTime = 0.1;  // milliseconds, so that no ratio of times is without bound

}  // namespace

void DraftQuality::beginFrom(double frameMilliseconds, double quality) {
  quality_ = std::clamp(quality * std::sqrt(milliseconds_ / std::max(frameMilliseconds, kLeastTime)), least_, 1.0);
}

void DraftQuality::took(double frameMilliseconds) {
  const double better = std::pow(milliseconds_ / std::max(frameMilliseconds, kLeastTime), 0.25);
  quality_ = std::clamp(quality_ * std::clamp(better, 0.75, 1.15), least_, 1.0);
}

}  // namespace freevoxels
