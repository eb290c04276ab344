#include "apps/common/series_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace freevoxels {

namespace {

using Clock = std::chrono::steady_clock;

/// "45 s", "2 min 5 s", "1 h 12 min".
std::string timeText(std::chrono::duration<double> time) {
  const auto seconds = std::int64_t(std::max(time.count(), 0.0) + 0.5);
  if (seconds < 60) return fmt::format("{} s", seconds);
  if (seconds < 3600) return fmt::format("{} min {} s", seconds / 60, seconds % 60);
  return fmt::format("{} h {} min", seconds / 3600, seconds / 60 % 60);
}

}  // namespace

void SeriesProgress::start(std::size_t frames) {
  frames_ = frames;
  begun_ = Clock::now();
}

Progress SeriesProgress::progress() {
  const Progress progress = line_.progress();
  if (!progress) return {};
  return [this, progress, prefix = prefix()](std::string_view stage, double fraction) {
    if (std::exchange(fractionOf_, drawn) != drawn) fraction_ = {};
    progress(fmt::format("{}{}", prefix, stage), fraction_.next(fraction));
  };
}

std::string SeriesProgress::prefix() const {
  if (frames_ == 1) return "";
  std::string left;
  if (drawn > 0) left = fmt::format(", {} left", timeText((Clock::now() - begun_) / double(drawn) * double(frames_ - drawn)));
  return fmt::format("frame {} of {}{}: ", drawn + 1, frames_, left);
}

}  // namespace freevoxels
