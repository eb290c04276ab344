#pragma once
// The Vulkan devices that renderers share.

#include <memory>
#include <mutex>

#include "apps/freevoxels/device_options.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Is destroyed after all that was made with `device`.
struct DeviceContext {
  /// Opens a device. Fails with ErrorKind::Device. `log` turns the validation layers on.
  DeviceContext(const DeviceOptions& options, const ValidationLog& log);
  /// Uses a device of the caller's, of which `options` limits the memory. Fails with ErrorKind::Device and what it lacks.
  DeviceContext(VkInstance instance, const AdoptedDevice& adopted, const DeviceOptions& options);

  /// Throws an InternalError if the validation layers have found anything.
  void checkValidation() const;

  const bool isAdopted;  ///< whether `device` is the caller's
  const Instance instance;
  const std::unique_ptr<const Device> device;
  std::mutex mutex;  ///< is held while a frame is drawn
};

/// The context for these options. It is opened by the first call and kept until the process ends. Any thread
/// may call this. Fails with ErrorKind::Device.
std::shared_ptr<DeviceContext> sharedContext(const DeviceOptions& options);

}  // namespace freevoxels
