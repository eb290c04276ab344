#pragma once
// Writing a frame's files while the next frame is drawn.

#include <functional>
#include <future>
#include <vector>

#include "engine/core/stages.h"

namespace freevoxels {

/// Runs one task at a time on a thread of its own. The destructor waits for it.
class BackgroundWriter {
 public:
  /// Waits for the task before, then starts `write`. If the task before threw an exception, rethrows it and starts nothing.
  /// If the system has no more threads, `write` runs in the next call instead.
  void start(std::function<void()> write);
  /// Waits for the last task. Rethrows its exception.
  void finish();
  /// The total time of the complete tasks, as the stage "write images".
  const std::vector<StageTime>& times() const { return times_; }

 private:
  std::future<std::vector<StageTime>> running_;
  std::vector<StageTime> times_;
};

}  // namespace freevoxels
