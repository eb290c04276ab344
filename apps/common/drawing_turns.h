#pragma once
// Whose turn it is to draw on a device.

#include <functional>
#include <mutex>
#include <thread>

namespace freevoxels {

/// A mutex for one thread at a time that draws. It is held while a progress function of the caller runs, in which that thread may draw
/// with other renderers: it locks the mutex again, or that of another device. Any thread may call the member functions.
class DrawingTurns {
 public:
  /// Fails with ErrorKind::Usage where the turn could never come, as threads wait for each other's.
  void lock();
  /// Locks, or returns false as soon as `isAbandoned` is true and the turn has not come. wake() makes waiting threads ask again.
  bool lockUnless(const std::function<bool()>& isAbandoned);
  static void wake();
  void unlock();
  /// Whether this thread holds a turn on any device: it is in a progress function, if the caller asks.
  static bool anyIsHeldByThisThread();

 private:
  bool isFree() const;
  bool isAwaitedInACircle() const;

  std::thread::id holder_;
  int depth_ = 0;  ///< how often `holder_` has locked
};

/// The turn of a frame on a device, for as long as this object exists. Fails with ErrorKind::Usage in the progress function of another
/// frame of the same renderer, of which `isDrawing` says whether it draws.
class FrameTurn {
 public:
  FrameTurn(DrawingTurns& turns, bool& isDrawing);
  ~FrameTurn() { isDrawing_ = false; }
  FrameTurn(const FrameTurn&) = delete;
  FrameTurn& operator=(const FrameTurn&) = delete;

 private:
  const std::lock_guard<DrawingTurns> lock_;
  bool& isDrawing_;
};

}  // namespace freevoxels
