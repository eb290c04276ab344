#pragma once
// Frames that a thread of their own draws, while their caller does something else.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

#include "apps/common/device_context.h"
#include "engine/core/stages.h"
#include "engine/splatting/frame_targets.h"

namespace freevoxels {

/// Thrown by the progress function of a frame that is cancelled, and by what waits for the frame.
struct FrameCancelled {};

/// A frame that was submitted. Its caller and the thread that draws it share it. Any thread may call the member functions.
class SubmittedFrame {
 public:
  using Targets = std::shared_ptr<const FrameTargets>;
  using Draw = std::function<Targets(const Progress&)>;

  /// `draw` draws the frame and calls the progress function that it is given, which also calls `progress`.
  SubmittedFrame(std::shared_ptr<DeviceContext> context, Draw draw, Progress progress);

  /// Waits for the frame's turn and draws it, unless it is cancelled.
  void run();

  bool ready() const;
  /// Waits until the frame is drawn. Throws what `draw` threw, or FrameCancelled. Fails with ErrorKind::Usage in a progress
  /// function, where the frame might never come to its turn.
  void wait() const;
  void cancel();

  /// Waits. The images of the frame, complete and in layout GENERAL. The renderer draws no other frame into them as long as this
  /// object exists.
  const FrameTargets& targets() const;
  /// Waits. A value that the device's timeline semaphore (Queue) had after the frame was complete.
  std::uint64_t completion() const;
  DeviceContext& context() const { return *context_; }

 private:
  const std::shared_ptr<DeviceContext> context_;  // first, as the targets belong to its device
  Draw draw_;
  Progress progress_;
  std::atomic<bool> cancelled_ = false;
  Targets targets_;
  std::uint64_t completion_ = 0;
  std::promise<void> promise_;
  const std::shared_future<void> done_ = promise_.get_future().share();
};

/// Draws frames in the order of their submission. Any thread may call submit().
class FrameQueue {
 public:
  FrameQueue() = default;
  /// Cancels the frames that are not complete, and waits for the current one to end.
  ~FrameQueue();
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  void submit(std::shared_ptr<SubmittedFrame> frame);

 private:
  void drawFrames();

  std::mutex mutex_;  ///< guards the other members
  std::condition_variable changed_;
  std::deque<std::shared_ptr<SubmittedFrame>> waiting_;
  std::shared_ptr<SubmittedFrame> current_;
  bool ends_ = false;
  std::thread thread_;  ///< is started by the first submission
};

}  // namespace freevoxels
