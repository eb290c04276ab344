#include "apps/common/frame_queue.h"

#include <chrono>
#include <utility>

#include "engine/core/error.h"
#include "engine/vulkan/queue.h"

namespace freevoxels {

SubmittedFrame::SubmittedFrame(std::shared_ptr<DeviceContext> context, Draw draw, Progress progress)
    : context_(std::move(context)), draw_(std::move(draw)), progress_(std::move(progress)) {}

void SubmittedFrame::run() {
  const auto throwIfCancelled = [this] {
    if (cancelled_) throw FrameCancelled();
  };
  try {
    // The renderer takes the turn itself, but would not see that the frame is cancelled while it waits.
    if (!context_->turns.lockUnless([this] { return cancelled_.load(); })) throw FrameCancelled();
    const std::lock_guard turn(context_->turns, std::adopt_lock);
    throwIfCancelled();
    targets_ = draw_([&](std::string_view stage, double fraction) {
      throwIfCancelled();
      if (progress_) progress_(stage, fraction);
    });
    completion_ = context_->device->queue().completed();
    draw_ = nullptr;  // before others learn of the end, as they may then free what it refers to
    progress_ = nullptr;
    promise_.set_value();
  } catch (...) {
    draw_ = nullptr;
    progress_ = nullptr;
    promise_.set_exception(std::current_exception());
  }
}

bool SubmittedFrame::ready() const {
  return done_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void SubmittedFrame::wait() const {
  refuseInsideValidationLog();
  if (!ready() && DrawingTurns::anyIsHeldByThisThread())
    fail(ErrorKind::Usage,
         "a frame that is not complete cannot be waited for in a progress function, as frames are drawn one after another: "
         "wait for it afterwards");
  done_.get();
}

void SubmittedFrame::cancel() {
  cancelled_ = true;
  DrawingTurns::wake();
}

const FrameTargets& SubmittedFrame::targets() const {
  wait();
  return *targets_;
}

std::uint64_t SubmittedFrame::completion() const {
  wait();
  return completion_;
}

FrameQueue::~FrameQueue() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    for (const std::shared_ptr<SubmittedFrame>& frame : waiting_) frame->cancel();
    if (current_) current_->cancel();
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void FrameQueue::submit(std::shared_ptr<SubmittedFrame> frame) {
  {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { drawFrames(); });
    waiting_.push_back(std::move(frame));
  }
  changed_.notify_one();
}

void FrameQueue::drawFrames() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    current_->run();
    lock.lock();
    current_ = nullptr;
  }
}

}  // namespace freevoxels
