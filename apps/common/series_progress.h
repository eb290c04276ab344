#pragma once
// The progress line of a series of frames.

#include <chrono>
#include <cstddef>
#include <string>

#include "apps/common/progress_line.h"
#include "apps/common/whole_progress.h"

namespace freevoxels {

/// Says in front of each stage which of the frames it is for, and how long the others will take: "frame 3 of 72, 2 min 5 s left: ".
class SeriesProgress {
 public:
  explicit SeriesProgress(bool wanted) : line_(wanted) {}

  /// Starts a series of so many frames.
  void start(std::size_t frames);
  /// Shows a stage of unknown length.
  void begin(const std::string& stage) { line_.begin(prefix() + stage); }
  /// Erases the line; to be called before printing a message.
  void erase() { line_.erase(); }
  /// A progress function for the frame that is being made, which refers to this object; an empty one if nothing is shown.
  Progress progress();

  std::size_t frames() const { return frames_; }

  std::size_t drawn = 0;  ///< number of complete frames

 private:
  std::string prefix() const;

  ProgressLine line_;
  WholeFraction fraction_;
  std::size_t fractionOf_ = 0;  ///< the frame that `fraction_` is of
  std::size_t frames_ = 0;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace freevoxels
