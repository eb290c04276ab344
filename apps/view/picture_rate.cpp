#include "apps/view/picture_rate.h"

namespace freevoxels {

namespace {

constexpr std::chrono::milliseconds kPause{500}, kSpan{2000};

}  // namespace

void PictureRate::add(Clock::time_point now) {
  if (!shown_.empty() && now - shown_.back() > kPause) shown_.clear();
  shown_.push_back(now);
  while (now - shown_.front() > kSpan) shown_.pop_front();
}

double PictureRate::perSecond() const {
  if (shown_.size() < 3) return 0.0;
  const std::chrono::duration<double> time = shown_.back() - shown_.front();
  return double(shown_.size() - 1) / time.count();
}

}  // namespace freevoxels
