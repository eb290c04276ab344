#pragma once
// Rendering on a Vulkan device of the caller's, whose images it then uses without a copy to the host. Includes Vulkan's headers.
//
// The caller's instance and device must be of the Vulkan loader that the process has as libvulkan.so.1, which the library opens
// itself.

#include <vulkan/vulkan.h>

#include <mutex>
#include <span>
#include <string>

#include "freevoxels/freevoxels.h"

namespace freevoxels::v1 {

/// Why FreeVoxels cannot use a physical device, in one sentence; empty if it can. Needed are Vulkan 1.3, requiredExtensions(), the
/// features of enableRequiredFeatures(), a queue family for graphics and compute with timestamps, and blending into images of 32-bit
/// floats. `instance` was created for Vulkan 1.3.
FREEVOXELS_API std::string whyUnusable(VkInstance instance, VkPhysicalDevice device);

/// The extensions that the device must be created with: VK_KHR_push_descriptor.
FREEVOXELS_API std::span<const char* const> requiredExtensions();

/// Enables the features that the device must be created with, in addition to those that the caller enables, in the chain for
/// VkDeviceCreateInfo::pNext, which must contain VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features.
FREEVOXELS_API void enableRequiredFeatures(VkPhysicalDeviceFeatures2& chain);

/// All of this is the caller's and must outlive the context, its renderers and their frames. Threads of the context compile pipelines of
/// the device until it ends.
struct AdoptedDevice {
  VkInstance instance = VK_NULL_HANDLE;  ///< created for Vulkan 1.3
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;  ///< for graphics and compute, with timestamps
  std::uint32_t queueFamily = 0;
  /// The chain of features that `device` was created with. Is only read by adopt().
  const VkPhysicalDeviceFeatures2* features = nullptr;
  /// If the caller uses `queue` as well while frames are drawn: the mutex that both lock around each use of it. The caller must not
  /// hold it while it calls a function of this library.
  std::mutex* queueMutex = nullptr;
};

/// A context that draws on the caller's device, and allocates at most `memoryLimit` MiB on it, 0: all. Throws ErrorKind::Device with
/// one sentence that says what the device lacks.
FREEVOXELS_API Context adopt(const AdoptedDevice& device, int memoryLimit = 0);

/// The images of a frame on the caller's device. They stay valid and unchanged until the Frame is destroyed, which must be after the
/// device has read them. The caller may read them, and write them too.
struct DeviceFrame {
  /// Layout VK_IMAGE_LAYOUT_GENERAL, in which it must be left; usage: transfer source and destination, sampled, storage and
  /// colour attachment; one mip level and layer; owned by the queue family of the adopted queue.
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
  };
  Image color;  ///< VK_FORMAT_R32G32B32A32_SFLOAT: linear Rec.709, multiplied by alpha, and alpha; row 0 is the top
  Image depth;  ///< VK_FORMAT_R32_SFLOAT, as Image::depth; null handles if the frame is without depth
  VkExtent2D extent{};
  /// The frame is complete when this timeline semaphore has this value. It has it already, but a queue that reads the images must
  /// wait for it, which also makes them visible there.
  VkSemaphore semaphore = VK_NULL_HANDLE;
  std::uint64_t value = 0;
};

/// Waits for the frame and hands over its images. Throws as Frame::wait() does, and ErrorKind::Usage if the frame is not of an
/// adopted device.
FREEVOXELS_API DeviceFrame deviceFrame(const Frame& frame);

}  // namespace freevoxels::v1
