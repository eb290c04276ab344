#pragma once
// Writing a frame's files while the next frame is drawn.

#include <functional>
#include <future>
#include <vector>

#include "engine/core/stages.h"

namespace freevoxels {

/// Runs one piece of work at a time beside the caller's thread. The destructor waits for it.
class BackgroundWriter {
 public:
  /// Waits until the work before is done; then starts `write`. Throws what the work before has thrown, and starts nothing
  /// then. Where the system has no more threads, `write` runs in the next call instead.
  void start(std::function<void()> write);
  /// Waits until all work is done. Throws what it has thrown.
  void finish();
  /// How long the work took that is done.
  const std::vector<StageTime>& times() const { return times_; }

 private:
  std::future<std::vector<StageTime>> running_;
  std::vector<StageTime> times_;
};

}  // namespace freevoxels
