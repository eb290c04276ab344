#pragma once
// Vulkan devices that the renderers of one process share.

#include <memory>
#include <mutex>

#include "apps/freevoxels/device_options.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

struct DeviceContext {
  explicit DeviceContext(const DeviceOptions& options);

  Instance instance;
  std::unique_ptr<Device> device;
  std::mutex mutex;  ///< to be held by the thread that uses `device`
};

/// The context of these options, opened at the first call and kept until the process ends. Any thread may call it.
/// Fails with ExitCode::Device.
DeviceContext& deviceContext(const DeviceOptions& options);

}  // namespace freevoxels
