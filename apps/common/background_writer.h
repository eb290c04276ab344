#pragma once
// Writing frames' files while the next frames are drawn.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include "engine/core/stages.h"

namespace freevoxels {

struct WritingTask {
  std::uint64_t bytes = 0;  ///< of memory that `write` keeps
  std::function<void()> write;
};

/// What tasks may have together. One task may always run.
struct WritingLimits {
  std::size_t threads = std::max(std::thread::hardware_concurrency(), 1u);
  std::uint64_t bytes = std::uint64_t(1) << 30;
};

/// Runs several tasks at once, each on a thread of its own. Used by one thread. The destructor waits for the tasks.
class BackgroundWriter {
 public:
  explicit BackgroundWriter(const WritingLimits& limits = {}) : limits_(limits) {}

  /// Waits until the limits allow it, then starts the task. Calls `written`, if given, when the task and all before it are complete: in
  /// this thread, during a later call. If a task has thrown an exception, waits for those before it, rethrows it and starts nothing. If
  /// the system has no more threads, the task runs in a later call instead.
  void start(WritingTask task, std::function<void()> written = {});
  /// Waits for the tasks. Rethrows the exception of the first one that threw.
  void finish();
  /// The total time of the complete tasks, as the stage "write images".
  const std::vector<StageTime>& times() const { return times_; }

 private:
  struct Running {
    std::uint64_t bytes;
    std::function<void()> written;
    std::future<std::vector<StageTime>> times;
  };
  bool allows(std::uint64_t bytes) const;
  void completeFirst();

  const WritingLimits limits_;
  std::vector<StageTime> times_;
  std::uint64_t bytes_ = 0;              ///< of all in `running_`
  std::atomic<bool> hasFailed_ = false;  ///< whether a task has thrown
  std::deque<Running> running_;          ///< in the order of their start; last, as the tasks refer to this object
};

}  // namespace freevoxels
