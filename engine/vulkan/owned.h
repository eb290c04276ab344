#pragma once
// Checks of Vulkan results, and the owner type of Vulkan handles.

#include <volk.h>

#include <utility>

namespace freevoxels {

/// Throws unless `result` is VK_SUCCESS: Error for out of memory and device loss, InternalError otherwise.
void checkVulkan(VkResult result, const char* call, const char* file, int line);

/// Owns a handle that belongs to a device and destroys it. `Destroy` is the address of volk's function
/// pointer.
template <typename Handle, auto* Destroy>
class Owned {
 public:
  Owned() = default;
  Owned(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
  Owned(Owned&& other) noexcept
      : device_(other.device_), handle_(std::exchange(other.handle_, Handle(VK_NULL_HANDLE))) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Owned() {
    if (handle_ != VK_NULL_HANDLE) (*Destroy)(device_, handle_, nullptr);
  }

  Handle get() const { return handle_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  Handle handle_ = VK_NULL_HANDLE;
};

using OwnedMemory = Owned<VkDeviceMemory, &vkFreeMemory>;
using OwnedBuffer = Owned<VkBuffer, &vkDestroyBuffer>;
using OwnedBufferView = Owned<VkBufferView, &vkDestroyBufferView>;
using OwnedImage = Owned<VkImage, &vkDestroyImage>;
using OwnedImageView = Owned<VkImageView, &vkDestroyImageView>;
using OwnedSampler = Owned<VkSampler, &vkDestroySampler>;
using OwnedShaderModule = Owned<VkShaderModule, &vkDestroyShaderModule>;
using OwnedSetLayout = Owned<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout>;
using OwnedPipelineLayout = Owned<VkPipelineLayout, &vkDestroyPipelineLayout>;
using OwnedPipelineCache = Owned<VkPipelineCache, &vkDestroyPipelineCache>;
using OwnedPipeline = Owned<VkPipeline, &vkDestroyPipeline>;
using OwnedCommandPool = Owned<VkCommandPool, &vkDestroyCommandPool>;
using OwnedQueryPool = Owned<VkQueryPool, &vkDestroyQueryPool>;
using OwnedSemaphore = Owned<VkSemaphore, &vkDestroySemaphore>;
using OwnedFence = Owned<VkFence, &vkDestroyFence>;
using OwnedSwapchain = Owned<VkSwapchainKHR, &vkDestroySwapchainKHR>;

}  // namespace freevoxels

#define VK_CHECK(call) VK_CHECK_RESULT((call), #call)
// For calls for which VK_SUCCESS is not the only good result: the caller passes the result.
#define VK_CHECK_RESULT(result, call) ::freevoxels::checkVulkan((result), call, __FILE__, __LINE__)
