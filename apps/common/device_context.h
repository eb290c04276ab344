#pragma once
// The Vulkan devices that renderers share.

#include <memory>

#include "apps/common/device_options.h"
#include "apps/common/drawing_turns.h"
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

  /// Whether the device was opened by this process, rather than by one from which it was forked.
  bool isOfThisProcess() const;
  /// Fails with ErrorKind::Device if it was not: no device can be used then, as its threads and locks are the other process's.
  void refuseAfterFork() const;

  const int process;     ///< that opened the device
  const bool isAdopted;  ///< whether `device` is the caller's
  const Instance instance;
  const std::unique_ptr<const Device> device;
  DrawingTurns turns;  ///< is held while a frame is drawn
};

/// Fails with ErrorKind::Usage in a function that is given the messages of the validation layers. Such a function runs in the middle of
/// a call of Vulkan, whose locks it would wait for.
void refuseInsideValidationLog();

/// The context for these options. It is opened by the first call and kept until the process ends. Any thread
/// may call this. Fails with ErrorKind::Device.
std::shared_ptr<DeviceContext> sharedContext(const DeviceOptions& options);

}  // namespace freevoxels
