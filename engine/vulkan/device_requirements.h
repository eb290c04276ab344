#pragma once
// What a Vulkan device must have for the engine: extensions, features, limits and a queue family. An Instance must exist.

#include <volk.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace freevoxels {

/// The features that the engine needs, as a chain for VkDeviceCreateInfo::pNext.
struct RequiredFeatures {
  RequiredFeatures();
  RequiredFeatures(const RequiredFeatures&) = delete;
  RequiredFeatures& operator=(const RequiredFeatures&) = delete;

  VkPhysicalDeviceFeatures2 first{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan12Features vulkan12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features vulkan13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
};

/// The extensions that a device must enable.
std::span<const char* const> requiredExtensions();

/// Sets the required features to VK_TRUE in a chain of the caller's that contains VkPhysicalDeviceVulkan12Features and
/// VkPhysicalDeviceVulkan13Features. Fails with ErrorKind::Device if it lacks one of them.
void enableRequiredFeatures(VkPhysicalDeviceFeatures2& chain);

/// The required features that are not VK_TRUE in such a chain, by their names in the Vulkan specification. Fails as
/// enableRequiredFeatures does.
std::vector<std::string> missingFeatures(const VkPhysicalDeviceFeatures2& chain);

/// Why the engine cannot use the device, in clauses such as "it lacks the feature timelineSemaphore"; empty if it can.
std::vector<std::string> findRejections(VkPhysicalDevice physical);

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice physical);
/// Whether queues of the family support graphics, compute and timestamps, as the engine's queue must.
bool isUsable(const VkQueueFamilyProperties& family);
/// The first usable queue family.
std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice physical);

/// Whether the device has the extension.
bool hasExtension(VkPhysicalDevice physical, const char* name);

}  // namespace freevoxels
