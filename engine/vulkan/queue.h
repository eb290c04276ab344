#pragma once
// The device's only queue, which all threads share, and the Vulkan objects that their recordings use.

#include <volk.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/vulkan/owned.h"

namespace freevoxels {

class Device;

/// The Vulkan objects of one recording. The queue keeps them after the recording is complete and lends them to a later one,
/// so that a frame creates no command pool and no query pool.
struct CommandSlot {
  static constexpr std::uint32_t kMaxTimestamps = 4096;

  OwnedCommandPool pool;
  std::vector<VkCommandBuffer> buffers;  ///< allocated from the pool; a recording uses the first ones
  OwnedQueryPool timestamps;             ///< kMaxTimestamps queries
  std::uint32_t usedTimestamps = 0;      ///< the queries that have to be reset before the next use
};

/// All member functions may be called from any thread.
class Queue {
 public:
  /// `shared`, if given, is locked while `queue` is in use, because the caller uses the queue as well, and must outlive this.
  Queue(const Device& device, VkQueue queue, std::mutex* shared = nullptr);
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// Lends a slot that no other recording uses, with all its objects reset.
  std::unique_ptr<CommandSlot> borrowSlot();
  /// Takes a slot back. The device must not be executing its buffers.
  void returnSlot(std::unique_ptr<CommandSlot> slot);

  /// Submits a recorded buffer. Returns the number of the submission, to wait for.
  std::uint64_t submit(VkCommandBuffer buffer);
  /// Waits until the submission with this number is complete. Returns false if that takes longer than `nanoseconds`.
  bool wait(std::uint64_t submission, std::uint64_t nanoseconds = UINT64_MAX) const;
  /// Calls vkQueuePresentKHR and returns its result.
  VkResult present(const VkPresentInfoKHR& info);
  /// Waits for all submissions of all threads.
  void waitIdle();
  /// A timeline semaphore whose value is the number of the last complete submission.
  VkSemaphore timeline() const { return timeline_.get(); }
  /// The number of the last complete submission.
  std::uint64_t completed() const;

  /// The cost of passes of this name in milliseconds per unit of work (Commands::Span), as last measured, or `otherwise` if
  /// it is unknown.
  double costOf(const std::string& pass, double otherwise) const;
  void setCost(const std::string& pass, double millisecondsPerUnit);

 private:
  const Device& device_;
  std::mutex ownMutex_;
  std::mutex& queueMutex_;  ///< guards queue_ and submitted_: ownMutex_ or the caller's
  VkQueue queue_;
  std::uint64_t submitted_ = 0;
  OwnedSemaphore timeline_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::vector<std::unique_ptr<CommandSlot>> idleSlots_;
  std::map<std::string, double> costs_;
};

}  // namespace freevoxels
