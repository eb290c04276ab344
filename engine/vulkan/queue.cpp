#include "engine/vulkan/queue.h"

#include "engine/vulkan/device.h"

namespace freevoxels {

namespace {

std::unique_ptr<CommandSlot> makeSlot(const Device& device) {
  auto slot = std::make_unique<CommandSlot>();
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                         .queueFamilyIndex = device.queueFamily()};
  VkCommandPool pool = VK_NULL_HANDLE;
  VK_CHECK(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool));
  slot->pool = OwnedCommandPool(device.handle(), pool);

  const VkQueryPoolCreateInfo queryInfo{
      .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = CommandSlot::kMaxTimestamps};
  VkQueryPool queries = VK_NULL_HANDLE;
  VK_CHECK(vkCreateQueryPool(device.handle(), &queryInfo, nullptr, &queries));
  slot->timestamps = OwnedQueryPool(device.handle(), queries);
  slot->usedTimestamps = CommandSlot::kMaxTimestamps;  // new queries have to be reset as well
  return slot;
}

}  // namespace

Queue::Queue(const Device& device, VkQueue queue, std::mutex* shared)
    : device_(device), queueMutex_(shared != nullptr ? *shared : ownMutex_), queue_(queue) {
  const VkSemaphoreTypeCreateInfo type{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                       .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  VK_CHECK(vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore));
  timeline_ = OwnedSemaphore(device.handle(), semaphore);
}

std::unique_ptr<CommandSlot> Queue::borrowSlot() {
  std::unique_ptr<CommandSlot> slot;
  {
    const std::lock_guard lock(mutex_);
    if (!idleSlots_.empty()) {
      slot = std::move(idleSlots_.back());
      idleSlots_.pop_back();
    }
  }
  if (!slot) slot = makeSlot(device_);
  VK_CHECK(vkResetCommandPool(device_.handle(), slot->pool.get(), 0));
  if (slot->usedTimestamps > 0)
    vkResetQueryPool(device_.handle(), slot->timestamps.get(), 0, slot->usedTimestamps);
  slot->usedTimestamps = 0;
  return slot;
}

void Queue::returnSlot(std::unique_ptr<CommandSlot> slot) {
  const std::lock_guard lock(mutex_);
  idleSlots_.push_back(std::move(slot));
}

std::uint64_t Queue::submit(VkCommandBuffer buffer) {
  const std::lock_guard lock(queueMutex_);
  const VkCommandBufferSubmitInfo command{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                          .commandBuffer = buffer};
  const VkSemaphoreSubmitInfo signal{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = timeline_.get(),
                                     .value = submitted_ + 1,
                                     .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                           .commandBufferInfoCount = 1,
                           .pCommandBufferInfos = &command,
                           .signalSemaphoreInfoCount = 1,
                           .pSignalSemaphoreInfos = &signal};
  VK_CHECK(vkQueueSubmit2(queue_, 1, &info, VK_NULL_HANDLE));
  return ++submitted_;
}

bool Queue::wait(std::uint64_t submission, std::uint64_t nanoseconds) const {
  const VkSemaphore semaphore = timeline_.get();
  const VkSemaphoreWaitInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                 .semaphoreCount = 1,
                                 .pSemaphores = &semaphore,
                                 .pValues = &submission};
  const VkResult result = vkWaitSemaphores(device_.handle(), &info, nanoseconds);
  if (result == VK_TIMEOUT) return false;
  VK_CHECK_RESULT(result, "vkWaitSemaphores");
  return true;
}

std::uint64_t Queue::completed() const {
  std::uint64_t value = 0;
  VK_CHECK(vkGetSemaphoreCounterValue(device_.handle(), timeline_.get(), &value));
  return value;
}

VkResult Queue::present(const VkPresentInfoKHR& info) {
  const std::lock_guard lock(queueMutex_);
  return vkQueuePresentKHR(queue_, &info);
}

void Queue::waitIdle() {
  const std::lock_guard lock(queueMutex_);
  VK_CHECK(vkQueueWaitIdle(queue_));
}

double Queue::costOf(const std::string& pass, double otherwise) const {
  const std::lock_guard lock(mutex_);
  const auto found = costs_.find(pass);
  return found != costs_.end() ? found->second : otherwise;
}

void Queue::setCost(const std::string& pass, double millisecondsPerUnit) {
  const std::lock_guard lock(mutex_);
  costs_[pass] = millisecondsPerUnit;
}

}  // namespace freevoxels
