#include "apps/view/adaptive_resolution.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace freevoxels {

namespace {

/// Beside the window's own frames, 15 pictures a second on two cores.
constexpr double kMilliseconds = 32.0;
constexpr std::array kVoxels{64, 48, 32, 24, 16};
constexpr double kLeastScale = 0.2, kFirstScale = 0.5;
/// Splats cost more than pixels: beyond these there are fewer or more of them.
constexpr double kCoarsensBelow = 0.35, kRefinesAbove = 0.95;
/// Each number of voxels has a table of its own: none is chosen for a single slow picture, nor the one that
/// was too slow again soon.
constexpr int kLeastPictures = 3, kRestingPictures = 200;

}  // namespace

int AdaptiveResolution::voxelsAlongEdge() const {
  return kVoxels[step_];
}

void AdaptiveResolution::took(double milliseconds) {
  // Slowly, as the window's own frames make one picture take longer than the next.
  const double faster = std::pow(kMilliseconds / std::max(milliseconds, 1.0), 0.25);
  scale_ = std::clamp(scale_ * std::clamp(faster, 0.75, 1.15), kLeastScale, 1.0);
  const bool coarsens = scale_ < kCoarsensBelow && step_ + 1 < kVoxels.size();
  const bool refines = scale_ > kRefinesAbove && step_ > 0 && --rest_ <= 0;
  pictures_ = coarsens || refines ? pictures_ + 1 : 0;
  if (pictures_ < kLeastPictures) return;
  step_ += coarsens ? 1 : std::size_t(-1);
  if (coarsens) rest_ = kRestingPictures;
  scale_ = kFirstScale;
  pictures_ = 0;
}

}  // namespace freevoxels
