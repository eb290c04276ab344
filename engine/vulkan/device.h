#pragma once
// The choice of a physical device, and the logical device with its single queue.

#include <volk.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/vulkan/instance.h"

namespace freevoxels {

class Queue;
class PipelineStore;

struct DeviceDescription {
  int index = 0;
  VkPhysicalDevice physical = VK_NULL_HANDLE;  ///< of the instance that it was listed of
  std::string name;
  std::string type;  ///< "discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"
  VkPhysicalDeviceType vulkanType = VK_PHYSICAL_DEVICE_TYPE_OTHER;  ///< the same
  std::string uuid;  ///< 8-4-4-4-12 hexadecimal digits
  std::string driver;
  /// Bytes of the largest device-local heap that this process may use: all of them, or what other processes leave free if
  /// the driver knows that (VK_EXT_memory_budget). For a CPU device three quarters of the machine's memory.
  std::uint64_t memoryBytes = 0;
  std::vector<std::string> rejections;  ///< why it cannot be used; empty if it can
};

/// All Vulkan devices, in the order of their indices.
std::vector<DeviceDescription> listDevices(const Instance& instance);

/// The device that Device opens for a selector. Fails as it does.
DeviceDescription chooseDevice(const Instance& instance, std::string_view selector);

/// A device and a queue of the caller's, which must outlive the Device that uses them. They must meet device_requirements.h. Threads of
/// the Device compile pipelines until it ends.
struct AdoptedDevice {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;  ///< for graphics and compute, with timestamps
  std::uint32_t queueFamily = 0;
  /// The features that `device` was created with, as for missingFeatures. Is read by the constructor of Device only.
  const VkPhysicalDeviceFeatures2* features = nullptr;
  std::mutex* queueMutex = nullptr;  ///< as for the constructor of Queue
};

/// What a Device may use of what there is.
struct DeviceLimits {
  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();  ///< bytes that are allocated
  std::uint32_t texels = std::numeric_limits<std::uint32_t>::max();  ///< of a texel buffer: small volumes are then stored as large ones are
};

class Device {
 public:
  /// Opens the device that `selector` names by index, UUID or part of its name; if it is empty, a discrete
  /// GPU, else any GPU, else a CPU device. Fails with ErrorKind::Device and the reason why each device was
  /// rejected. `extensions` are enabled in addition to the
  /// engine's own. Compiled pipelines of a GPU are stored in a file in `cacheFolder` (PipelineCache), unless
  /// that is empty.
  Device(const Instance& instance, std::string_view selector, const DeviceLimits& limits = {}, std::span<const char* const> extensions = {},
         const std::filesystem::path& cacheFolder = {});
  /// Uses a device of the caller's. Fails with ErrorKind::Device and what it lacks.
  Device(const Instance& instance, const AdoptedDevice& adopted, const DeviceLimits& limits = {},
         const std::filesystem::path& cacheFolder = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return device_; }
  VkPhysicalDevice physical() const { return physical_; }
  /// The device's only queue, which all threads share.
  Queue& queue() const { return *queue_; }
  std::uint32_t queueFamily() const { return queueFamily_; }
  /// Valid bits of the queue's timestamps.
  std::uint32_t timestampBits() const { return timestampBits_; }
  const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
  const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
  VkDeviceSize maximumAllocation() const { return maximumAllocation_; }
  /// Bytes of the largest buffer that can be bound as a storage buffer and as a texel buffer with texels of
  /// `texelBytes` bytes.
  std::uint64_t largestBinding(std::uint64_t texelBytes) const {
    return std::min({std::uint64_t(limits().maxStorageBufferRange), std::uint64_t(limits().maxTexelBufferElements) * texelBytes,
                     std::uint64_t(maximumAllocation_)});
  }
  /// Bytes that may be allocated in total: what the device had for this process when it was opened, or the
  /// limit if that is less.
  std::uint64_t memoryBytes() const { return std::min(description_.memoryBytes, limits_.memory); }
  /// Bytes that can be allocated at present: what other objects of this class have allocated of the same physical device is not
  /// available either.
  std::uint64_t availableBytes() const;
  /// The largest number of bytes that this object had allocated at any time.
  std::uint64_t peakBytes() const { return peak_; }
  const DeviceDescription& description() const { return description_; }
  bool isCpu() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  /// Whether the host maps memory of MemoryUse::Device where possible, instead of copying through staging
  /// buffers. Off under validation, so that tests use staging buffers as discrete GPUs do.
  bool mapsOwnMemory() const { return mapsOwnMemory_; }

  /// Adds an allocation to the budget. Fails with ErrorKind::OutOfMemory if the limit would be exceeded.
  void claim(std::uint64_t bytes) const;
  void release(std::uint64_t bytes) const;

  /// All pipelines made so far (pipeline.h).
  PipelineStore& pipelines() const { return *pipelines_; }

  /// Shows `name` in validation messages and debuggers.
  void setName(VkObjectType type, std::uint64_t handle, const char* name) const;

 private:
  void describePhysical();
  void makeStores(VkQueue queue, std::mutex* queueMutex, const std::filesystem::path& cacheFolder);

  DeviceDescription description_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  VkDeviceSize maximumAllocation_ = 0;
  DeviceLimits limits_;
  bool mapsOwnMemory_;
  bool isOwn_;  ///< whether device_ is destroyed with this object
  PFN_vkSetDebugUtilsObjectNameEXT setObjectName_ = nullptr;  ///< null unless the instance validates
  mutable std::atomic<std::uint64_t> allocated_ = 0, peak_ = 0;
  std::shared_ptr<std::atomic<std::uint64_t>> processBytes_;  ///< allocated by all objects of the same physical device
  std::uint32_t queueFamily_ = 0, timestampBits_ = 0;
  VkDevice device_ = VK_NULL_HANDLE;
  std::unique_ptr<Queue> queue_;
  std::unique_ptr<PipelineStore> pipelines_;
};

}  // namespace freevoxels
