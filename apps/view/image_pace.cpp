#include "apps/view/image_pace.h"

#include <array>
#include <utility>

namespace freevoxels {

namespace {

constexpr std::chrono::milliseconds kPause{500}, kSpan{2000};

/// While the window is painted as well: 20 images a second on two cores.
constexpr double kMilliseconds = 46.0;
/// Along the longest edge. With fewer voxels the image of an edited transfer function does not show where its threshold lies, so that slower
/// images are accepted instead.
constexpr std::array kVoxels{kAllVoxels, 128, 96};
/// Where voxels cost more than pixels: beyond these qualities there are fewer or more of them.
constexpr double kCoarsensBelow = 0.175, kRefinesAbove = 0.475;
/// Fewer pixels hardly take less time, as most of it then goes into what is made of the voxels.
constexpr double kLeastOfFewer = 0.1;
/// Each number of voxels has a table of its own: none is chosen for a single slow image, nor the one that
/// was too slow again soon.
constexpr int kMinImages = 3, kRestingImages = 200;

}  // namespace

void ImageRate::add(Clock::time_point now) {
  if (!shown_.empty() && now - shown_.back() > kPause) shown_.clear();
  shown_.push_back(now);
  while (now - shown_.front() > kSpan) shown_.pop_front();
}

double ImageRate::perSecond() const {
  if (shown_.size() < 3) return 0.0;
  const std::chrono::duration<double> time = shown_.back() - shown_.front();
  return double(shown_.size() - 1) / time.count();
}

AdaptiveResolution::AdaptiveResolution(Voxels voxels)
    : all_(voxels == Voxels::All), step_(all_ ? 0 : kFirstStep), draft_(kMilliseconds, all_ ? DraftQuality::kLeast : kLeastOfFewer) {}

int AdaptiveResolution::voxelsAlongEdge() const {
  return kVoxels[step_];
}

void AdaptiveResolution::took(double milliseconds) {
  if (std::exchange(begins_, false))
    draft_.beginFrom(milliseconds, quality());
  else
    draft_.took(milliseconds);
  if (all_) return;
  const bool coarsens = quality() < kCoarsensBelow && step_ + 1 < kVoxels.size();
  const bool refines = quality() > kRefinesAbove && step_ > 1 && --rest_ <= 0;
  images_ = coarsens || refines ? images_ + 1 : 0;
  if (images_ < kMinImages) return;
  step_ += coarsens ? 1 : std::size_t(-1);
  if (coarsens) rest_ = kRestingImages;
  draft_ = DraftQuality(kMilliseconds, kLeastOfFewer);
  images_ = 0;
}

}  // namespace freevoxels
