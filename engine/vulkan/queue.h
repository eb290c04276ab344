#pragma once
// The device's one queue, shared by all threads that record work, and what their recordings are made of.

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

/// The Vulkan objects of one recording. The queue keeps them when the recording has been executed and lends them to the
/// next one, so that a frame creates no command pool and no query pool.
struct CommandSlot {
  static constexpr std::uint32_t kMaximumTimestamps = 4096;

  OwnedCommandPool pool;
  std::vector<VkCommandBuffer> buffers;  ///< allocated from the pool, of which the recording uses the first few
  OwnedQueryPool timestamps;             ///< kMaximumTimestamps queries
  std::uint32_t usedTimestamps = 0;      ///< that the next recording has to reset
};

/// All member functions may be called from any thread.
class Queue {
 public:
  Queue(const Device& device, VkQueue queue);
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// A slot that no recording uses: reset, without buffers in use.
  std::unique_ptr<CommandSlot> borrowSlot();
  /// Takes a slot whose buffers are not (or no longer) executed.
  void returnSlot(std::unique_ptr<CommandSlot> slot);

  /// Starts the execution of a recorded buffer after everything that was submitted before. Returns the number to wait for.
  std::uint64_t submit(VkCommandBuffer buffer);
  /// Waits until the submission with this number is complete; false if it is not after `nanoseconds`.
  bool wait(std::uint64_t submission, std::uint64_t nanoseconds = UINT64_MAX) const;
  /// vkQueuePresentKHR.
  VkResult present(const VkPresentInfoKHR& info);
  /// Waits for all submissions of all threads.
  void waitIdle();

  /// Milliseconds per unit of work (see Commands) that passes of this name took when they were last measured, or
  /// `otherwise`.
  double costOf(const std::string& pass, double otherwise) const;
  void setCost(const std::string& pass, double millisecondsPerUnit);

 private:
  const Device& device_;
  std::mutex queueMutex_;  ///< of queue_ and submitted_
  VkQueue queue_;
  std::uint64_t submitted_ = 0;
  OwnedSemaphore timeline_;  ///< has the number of the last submission that is complete
  mutable std::mutex mutex_;  ///< of what follows
  std::vector<std::unique_ptr<CommandSlot>> idleSlots_;
  std::map<std::string, double> costs_;
};

}  // namespace freevoxels
