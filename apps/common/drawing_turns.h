#pragma once
// Whose turn it is to draw on a device.

#include <functional>
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

}  // namespace freevoxels
