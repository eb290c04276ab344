#include "apps/common/drawing_turns.h"

#include <condition_variable>
#include <map>
#include <mutex>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// What is known of all devices, so that threads that wait for each other are found.
struct AllTurns {
  std::mutex mutex;  ///< guards the other members, and those of every DrawingTurns
  std::condition_variable changed;
  std::map<std::thread::id, const DrawingTurns*> awaited;
};

AllTurns& allTurns() {
  static auto& all = *new AllTurns;  // never destroyed, as threads may wait while the process ends
  return all;
}

thread_local int turnsOfThisThread = 0;

}  // namespace

bool DrawingTurns::isFree() const {
  return depth_ == 0 || holder_ == std::this_thread::get_id();
}

/// Whether the holder waits, over others perhaps, for a turn of this thread.
bool DrawingTurns::isAwaitedInACircle() const {
  for (const DrawingTurns* turns = this; !turns->isFree();) {
    const auto next = allTurns().awaited.find(turns->holder_);
    if (next == allTurns().awaited.end()) return false;
    turns = next->second;
    if (turns->depth_ > 0 && turns->holder_ == std::this_thread::get_id()) return true;
  }
  return false;
}

void DrawingTurns::lock() {
  lockUnless([] { return false; });
}

bool DrawingTurns::lockUnless(const std::function<bool()>& isAbandoned) {
  AllTurns& all = allTurns();
  const std::thread::id self = std::this_thread::get_id();
  std::unique_lock lock(all.mutex);
  while (!isFree() && !isAbandoned()) {
    if (isAwaitedInACircle())
      fail(ErrorKind::Usage, "progress functions of frames on two devices wait for each other's device: draw afterwards in one of them");
    all.awaited[self] = this;
    all.changed.wait(lock);
    all.awaited.erase(self);
  }
  if (!isFree()) return false;
  holder_ = self;
  ++depth_;
  ++turnsOfThisThread;
  return true;
}

void DrawingTurns::wake() {
  {
    const std::lock_guard lock(allTurns().mutex);  // not between a thread's question and its waiting
  }
  allTurns().changed.notify_all();
}

void DrawingTurns::unlock() {
  {
    const std::lock_guard lock(allTurns().mutex);
    --depth_;
    --turnsOfThisThread;
  }
  allTurns().changed.notify_all();
}

bool DrawingTurns::anyIsHeldByThisThread() {
  return turnsOfThisThread > 0;
}

FrameTurn::FrameTurn(DrawingTurns& turns, bool& isDrawing) : lock_(turns), isDrawing_(isDrawing) {
  if (isDrawing)
    fail(ErrorKind::Usage,
         "a renderer cannot draw a frame in the progress function of another of its frames: use a second renderer, or draw it afterwards");
  isDrawing_ = true;
}

}  // namespace freevoxels
