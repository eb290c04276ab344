#include "engine/vulkan/device.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>

#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/vulkan/device_requirements.h"
#include "engine/vulkan/owned.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/queue.h"

namespace freevoxels {

namespace {

std::string typeName(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

/// Devices of a smaller number are preferred.
int preference(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 4;
    default:
      return 3;
  }
}

std::string uuidText(const std::uint8_t (&uuid)[VK_UUID_SIZE]) {
  std::string text;
  for (int i = 0; i < int(VK_UUID_SIZE); ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
    text += fmt::format("{:02x}", uuid[i]);
  }
  return text;
}

std::vector<VkPhysicalDevice> physicalDevices(const Instance& instance) {
  std::uint32_t count = 0;
  std::vector<VkPhysicalDevice> devices;
  VkResult result = VK_SUCCESS;
  instance.callLocking([&] { result = vkEnumeratePhysicalDevices(instance.handle(), &count, nullptr); });
  VK_CHECK_RESULT(result, "vkEnumeratePhysicalDevices");
  devices.resize(count);
  VK_CHECK(vkEnumeratePhysicalDevices(instance.handle(), &count, devices.data()));
  devices.resize(count);  // one may have been unplugged in between
  return devices;
}

/// What this process may allocate of the largest device-local heap.
std::uint64_t heapBytes(VkPhysicalDevice physical) {
  const bool knowsBudget = hasExtension(physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
  VkPhysicalDeviceMemoryProperties2 memory{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2,
                                           .pNext = knowsBudget ? &budget : nullptr};
  vkGetPhysicalDeviceMemoryProperties2(physical, &memory);
  std::uint64_t most = 0;
  for (std::uint32_t i = 0; i < memory.memoryProperties.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = memory.memoryProperties.memoryHeaps[i];
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) == 0) continue;
    most = std::max<std::uint64_t>(most, knowsBudget ? std::min(heap.size, budget.heapBudget[i]) : heap.size);
  }
  return most;
}

/// The counter of all bytes that this process has allocated of the physical device.
std::shared_ptr<std::atomic<std::uint64_t>> bytesOfProcess(const std::string& uuid) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<std::atomic<std::uint64_t>>> counters;
  const std::lock_guard lock(mutex);
  std::shared_ptr<std::atomic<std::uint64_t>>& counter = counters[uuid];
  if (!counter) counter = std::make_shared<std::atomic<std::uint64_t>>(0);
  return counter;
}

DeviceDescription describe(int index, VkPhysicalDevice physical) {
  VkPhysicalDeviceVulkan12Properties vulkan12{.sType =
                                                  VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties vulkan11{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, .pNext = &vulkan12};
  VkPhysicalDeviceProperties2 base{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                   .pNext = &vulkan11};
  vkGetPhysicalDeviceProperties2(physical, &base);

  DeviceDescription description{.index = index,
                                .physical = physical,
                                .name = base.properties.deviceName,
                                .type = typeName(base.properties.deviceType),
                                .vulkanType = base.properties.deviceType,
                                .uuid = uuidText(vulkan11.deviceUUID),
                                .driver = fmt::format("{} {}", vulkan12.driverName, vulkan12.driverInfo),
                                .memoryBytes = heapBytes(physical),
                                .rejections = findRejections(physical)};
  if (base.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU)
    // A CPU device allocates from the machine's memory whatever heap size it reports (lavapipe: 2 GiB).
    description.memoryBytes = std::max(description.memoryBytes, machineMemoryBytes() / 4 * 3);
  return description;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower;
}

bool matches(const DeviceDescription& device, std::string_view selector) {
  int index = -1;
  const auto [end, error] = std::from_chars(selector.data(), selector.data() + selector.size(), index);
  if (error == std::errc() && end == selector.data() + selector.size()) return device.index == index;
  const std::string wanted = lowerCase(selector);
  return device.uuid == wanted || lowerCase(device.name).find(wanted) != std::string::npos;
}

const DeviceDescription& choose(const std::vector<DeviceDescription>& devices, std::string_view selector) {
  if (devices.empty())
    fail(ErrorKind::Device, "no Vulkan device was found: install mesa-vulkan-drivers to render without a GPU");
  const DeviceDescription* best = nullptr;
  std::vector<std::string> rejected;
  for (const DeviceDescription& device : devices) {
    if (!selector.empty() && !matches(device, selector)) continue;
    if (!device.rejections.empty())
      rejected.push_back(
          fmt::format("device {} ({}): {}", device.index, device.name, fmt::join(device.rejections, ", ")));
    else if (best == nullptr || preference(device.vulkanType) < preference(best->vulkanType))
      best = &device;
  }
  if (best != nullptr) return *best;
  if (rejected.empty())
    fail(ErrorKind::Device, "no device matches {}: 'freevoxels devices' lists them", Parameter("device", selector));
  fail(ErrorKind::Device, "no usable Vulkan device; {}; install mesa-vulkan-drivers to render without a GPU",
       fmt::join(rejected, "; "));
}

/// Fails with ErrorKind::Device and what the device lacks.
DeviceDescription describeAdopted(const Instance& instance, const AdoptedDevice& adopted) {
  const std::vector<VkPhysicalDevice> all = physicalDevices(instance);
  const DeviceDescription description = describe(int(std::ranges::find(all, adopted.physical) - all.begin()), adopted.physical);
  std::vector<std::string> reasons = description.rejections;
  if (reasons.empty()) {
    for (const std::string& feature : missingFeatures(*adopted.features))
      reasons.push_back(fmt::format("it was created without the feature {}", feature));
    // The address of an extension's function is null if the device was created without the extension.
    if (vkGetDeviceProcAddr(adopted.device, "vkCmdPushDescriptorSetKHR") == nullptr)
      reasons.push_back(fmt::format("it was created without the extension {}", fmt::join(requiredExtensions(), ", ")));
    const std::vector<VkQueueFamilyProperties> families = queueFamilies(adopted.physical);
    if (adopted.queueFamily >= families.size() || !isUsable(families[adopted.queueFamily]))
      reasons.push_back(fmt::format("its queue family {} is not for graphics and compute with timestamps", adopted.queueFamily));
  }
  if (!reasons.empty())
    fail(ErrorKind::Device, "the device {} cannot be used: {}", description.name, fmt::join(reasons, ", "));
  return description;
}

}  // namespace

std::vector<DeviceDescription> listDevices(const Instance& instance) {
  std::vector<DeviceDescription> descriptions;
  for (VkPhysicalDevice physical : physicalDevices(instance))
    descriptions.push_back(describe(int(descriptions.size()), physical));
  return descriptions;
}

DeviceDescription chooseDevice(const Instance& instance, std::string_view selector) {
  return choose(listDevices(instance), selector);
}

Device::Device(const Instance& instance, std::string_view selector, const DeviceLimits& limits, std::span<const char* const> moreExtensions,
               const std::filesystem::path& cacheFolder)
    : description_(chooseDevice(instance, selector)),
      physical_(description_.physical),
      limits_(limits),
      mapsOwnMemory_(!instance.validates()),
      isOwn_(true),
      queueFamily_(*findQueueFamily(physical_)) {
  describePhysical();
  const RequiredFeatures features;
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = queueFamily_,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  std::vector<const char*> extensions(requiredExtensions().begin(), requiredExtensions().end());
  extensions.insert(extensions.end(), moreExtensions.begin(), moreExtensions.end());
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &features.first,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = std::uint32_t(extensions.size()),
                                .ppEnabledExtensionNames = extensions.data()};
  VkResult result = VK_SUCCESS;
  instance.callLocking([&] { result = vkCreateDevice(physical_, &info, nullptr, &device_); });
  if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
    fail(ErrorKind::Device, "{} lacks one of the extensions {}: choose another with {}", description_.name,
         fmt::join(extensions, ", "), Parameter("device"));
  VK_CHECK_RESULT(result, "vkCreateDevice");
  if (instance.validates())
    setObjectName_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetInstanceProcAddr(instance.handle(), "vkSetDebugUtilsObjectNameEXT"));
  VkQueue handle = VK_NULL_HANDLE;
  vkGetDeviceQueue(device_, queueFamily_, 0, &handle);
  try {
    makeStores(handle, nullptr, cacheFolder);
  } catch (...) {  // the destructor does not run
    queue_ = nullptr;
    vkDestroyDevice(device_, nullptr);
    throw;
  }
}

Device::Device(const Instance& instance, const AdoptedDevice& adopted, const DeviceLimits& limits, const std::filesystem::path& cacheFolder)
    : description_(describeAdopted(instance, adopted)),
      physical_(adopted.physical),
      limits_(limits),
      mapsOwnMemory_(true),
      isOwn_(false),
      queueFamily_(adopted.queueFamily),
      device_(adopted.device) {
  describePhysical();
  makeStores(adopted.queue, adopted.queueMutex, cacheFolder);
}

void Device::describePhysical() {
  processBytes_ = bytesOfProcess(description_.uuid);
  VkPhysicalDeviceVulkan11Properties vulkan11{.sType =
                                                  VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 base{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                   .pNext = &vulkan11};
  vkGetPhysicalDeviceProperties2(physical_, &base);
  properties_ = base.properties;
  properties_.limits.maxTexelBufferElements = std::min(properties_.limits.maxTexelBufferElements, limits_.texels);
  maximumAllocation_ = vulkan11.maxMemoryAllocationSize;
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
  timestampBits_ = queueFamilies(physical_)[queueFamily_].timestampValidBits;
}

void Device::makeStores(VkQueue queue, std::mutex* queueMutex, const std::filesystem::path& cacheFolder) {
  queue_ = std::make_unique<Queue>(*this, queue, queueMutex);
  // A software driver's pipelines are compiled when they are used first, and it keeps what it has compiled itself.
  const bool keepsPipelines = !cacheFolder.empty() && !isCpu();
  pipelines_ = std::make_unique<PipelineStore>(
      device_, keepsPipelines ? cacheFolder / pipelineCacheName(description_.uuid, properties_.driverVersion)
                              : std::filesystem::path());
}

Device::~Device() {
  if (isOwn_) vkDeviceWaitIdle(device_);  // not allowed while the owner of an adopted device uses another queue of it
  pipelines_ = nullptr;
  queue_ = nullptr;
  if (isOwn_) vkDestroyDevice(device_, nullptr);
}

std::uint64_t Device::availableBytes() const {
  const auto left = [](std::uint64_t bytes, std::uint64_t used) { return bytes - std::min(bytes, used); };
  return std::min(left(limits_.memory, allocated_), left(description_.memoryBytes, *processBytes_));
}

void Device::release(std::uint64_t bytes) const {
  allocated_ -= bytes;
  *processBytes_ -= bytes;
}

void Device::claim(std::uint64_t bytes) const {
  const std::uint64_t allocated = allocated_ += bytes;
  *processBytes_ += bytes;
  if (allocated > limits_.memory) {
    release(bytes);
    fail(ErrorKind::OutOfMemory,
         "at least {} MiB of device memory are needed and the limit is {} MiB: raise {}, or use a smaller "
         "volume or {}",
         (allocated + 0xfffff) >> 20, limits_.memory >> 20, Parameter("memory-limit"), Parameter("size"));
  }
  std::uint64_t peak = peak_;
  while (peak < allocated && !peak_.compare_exchange_weak(peak, allocated)) {
  }
}

void Device::setName(VkObjectType type, std::uint64_t handle, const char* name) const {
  if (setObjectName_ == nullptr) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = handle,
                                           .pObjectName = name};
  VK_CHECK(setObjectName_(device_, &info));
}

}  // namespace freevoxels
