#pragma once
// The choice of the Vulkan device, and opening it.

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/common/option_values.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

struct DeviceOptions {
  std::optional<std::string> selector;
  std::optional<int> memoryLimit;  ///< MiB

  void add(CLI::App& app);
  /// The limit in bytes, or that of all there is.
  std::uint64_t memoryBytes() const;
  /// `extensions` are enabled beside the engine's own.
  std::unique_ptr<Device> open(const Instance& instance, std::span<const char* const> extensions = {}) const;
  /// Uses a device of the caller's, with these options' limit on its memory.
  std::unique_ptr<Device> adopt(const Instance& instance, const AdoptedDevice& adopted) const;
  /// Opens the device and calls `work` with it. With FREEVOXELS_VALIDATION=1 any message of the validation
  /// layers is an internal error at the end.
  void withDevice(const std::function<void(const Device&)>& work) const;
};

/// Whether the environment variable FREEVOXELS_VALIDATION is 1, as in the tests.
bool validationRequested();

/// Logs a message of the validation layers as an error (ValidationLog).
void logValidation(std::string_view message);

/// Calls `work` with a Vulkan instance; validation as in withDevice.
void withInstance(const std::function<void(const Instance&)>& work, std::span<const char* const> extensions = {});

/// The devices of this machine, at least one. Fails with ErrorKind::Device.
std::vector<DeviceDescription> findDevices();
nlohmann::ordered_json toJson(const std::vector<DeviceDescription>& devices);

/// Reports that the CPU does the work, if the device is not a GPU.
void mentionCpu(const Device& device);

}  // namespace freevoxels
