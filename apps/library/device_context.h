#pragma once
// The Vulkan devices that all renderers of a process share.

#include <memory>
#include <mutex>

#include "apps/freevoxels/device_options.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

struct DeviceContext {
  explicit DeviceContext(const DeviceOptions& options);

  Instance instance;
  std::unique_ptr<Device> device;
  std::mutex mutex;  ///< must be held by the thread that uses `device`
};

/// The context for these options. It is opened by the first call and kept until the process ends. Any thread
/// may call this. Fails with ErrorKind::Device.
DeviceContext& deviceContext(const DeviceOptions& options);

}  // namespace freevoxels
