#include "engine/vulkan/device_requirements.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/core/error.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

namespace {

constexpr std::array kExtensions{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};

constexpr std::uint32_t kStorageBuffersPerStage = 15;  // table_level.comp

/// The structs of a chain of features that hold those that the engine uses.
struct FeatureChain {
  VkPhysicalDeviceFeatures* base = nullptr;
  VkPhysicalDeviceVulkan12Features* vulkan12 = nullptr;
  VkPhysicalDeviceVulkan13Features* vulkan13 = nullptr;
};

FeatureChain chainOf(VkPhysicalDeviceFeatures2& first) {
  FeatureChain chain{.base = &first.features};
  for (auto* next = static_cast<VkBaseOutStructure*>(first.pNext); next != nullptr; next = next->pNext) {
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
      chain.vulkan12 = reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(next);
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
      chain.vulkan13 = reinterpret_cast<VkPhysicalDeviceVulkan13Features*>(next);
  }
  if (chain.vulkan12 == nullptr || chain.vulkan13 == nullptr)
    fail(ErrorKind::Device,
         "the device's chain of features lacks VkPhysicalDeviceVulkan12Features or VkPhysicalDeviceVulkan13Features: add both, and "
         "enable in them what FreeVoxels needs");
  return chain;
}

/// Every feature that is required, by its name in the Vulkan specification.
struct RequiredFeature {
  const char* name;
  VkBool32& (*of)(const FeatureChain&);
};
#define FV_FEATURE(part, name) \
  RequiredFeature { #name, [](const FeatureChain& chain) -> VkBool32& { return chain.part->name; } }
const std::array kRequiredFeatures{
    FV_FEATURE(base, largePoints),             FV_FEATURE(vulkan12, scalarBlockLayout),
    FV_FEATURE(vulkan12, bufferDeviceAddress), FV_FEATURE(vulkan12, timelineSemaphore),
    FV_FEATURE(vulkan12, hostQueryReset),      FV_FEATURE(vulkan12, storageBuffer8BitAccess),
    FV_FEATURE(vulkan13, synchronization2),    FV_FEATURE(vulkan13, dynamicRendering),
    FV_FEATURE(vulkan13, maintenance4),
};
#undef FV_FEATURE

bool canBlend(VkPhysicalDevice physical, VkFormat format) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(physical, format, &properties);
  constexpr VkFormatFeatureFlags kNeeded =
      VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  return (properties.optimalTilingFeatures & kNeeded) == kNeeded;
}

}  // namespace

RequiredFeatures::RequiredFeatures() {
  first.pNext = &vulkan12;
  vulkan12.pNext = &vulkan13;
  enableRequiredFeatures(first);
}

std::span<const char* const> requiredExtensions() {
  return kExtensions;
}

void enableRequiredFeatures(VkPhysicalDeviceFeatures2& chain) {
  const FeatureChain parts = chainOf(chain);
  for (const RequiredFeature& feature : kRequiredFeatures) feature.of(parts) = VK_TRUE;
}

std::vector<std::string> missingFeatures(const VkPhysicalDeviceFeatures2& chain) {
  const FeatureChain parts = chainOf(const_cast<VkPhysicalDeviceFeatures2&>(chain));  // which is only read
  std::vector<std::string> names;
  for (const RequiredFeature& feature : kRequiredFeatures)
    if (feature.of(parts) != VK_TRUE) names.emplace_back(feature.name);
  return names;
}

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice physical) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  return families;
}

bool isUsable(const VkQueueFamilyProperties& family) {
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  return (family.queueFlags & kNeeded) == kNeeded && family.timestampValidBits > 0;
}

std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice physical) {
  const std::vector<VkQueueFamilyProperties> families = queueFamilies(physical);
  const auto usable = std::ranges::find_if(families, isUsable);
  if (usable == families.end()) return std::nullopt;
  return std::uint32_t(usable - families.begin());
}

bool hasExtension(VkPhysicalDevice physical, const char* name) {
  std::uint32_t count = 0;
  VK_CHECK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  VK_CHECK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()));
  return std::ranges::any_of(extensions, [&](auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

std::vector<std::string> findRejections(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  if (properties.apiVersion < VK_API_VERSION_1_3)
    return {fmt::format("it has Vulkan {}.{}, and 1.3 is needed", VK_API_VERSION_MAJOR(properties.apiVersion),
                        VK_API_VERSION_MINOR(properties.apiVersion))};
  std::vector<std::string> reasons;
  for (const char* needed : kExtensions)
    if (!hasExtension(physical, needed)) reasons.push_back(fmt::format("it lacks the extension {}", needed));
  RequiredFeatures features;
  vkGetPhysicalDeviceFeatures2(physical, &features.first);
  for (const std::string& name : missingFeatures(features.first)) reasons.push_back(fmt::format("it lacks the feature {}", name));
  if (properties.limits.maxPerStageDescriptorStorageBuffers < kStorageBuffersPerStage)
    reasons.push_back(fmt::format("it binds {} storage buffers in a stage, and {} are needed",
                                  properties.limits.maxPerStageDescriptorStorageBuffers,
                                  kStorageBuffersPerStage));
  if (!findQueueFamily(physical))
    reasons.emplace_back("it has no queue for both graphics and compute with timestamps");
  if (!canBlend(physical, VK_FORMAT_R32G32B32A32_SFLOAT) || !canBlend(physical, VK_FORMAT_R32_SFLOAT))
    reasons.emplace_back("it cannot blend into 32-bit float images");
  return reasons;
}

}  // namespace freevoxels
