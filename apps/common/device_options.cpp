#include "apps/common/device_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"

namespace freevoxels {

void DeviceOptions::add(CLI::App& app) {
  addText(app, "--device", "INDEX|NAME|UUID", selector,
          "Device of 'freevoxels devices', or part of a name [a discrete GPU, then any GPU, then a CPU]")
      ->group("Device");
  addWholeNumber(app, "--memory-limit", "MIB", memoryLimit,
                 "Largest amount of device memory to use; volumes are swept in thinner slabs where necessary [all of the device's memory]",
                 {1.0, double(std::numeric_limits<int>::max())})
      ->group("Device");
}

namespace {

/// Where programs of this user keep what they can make again; empty where that is not known.
std::filesystem::path cacheFolder() {
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder != nullptr && folder[0] == '/')
    return std::filesystem::path(folder) / "freevoxels";
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/')
    return std::filesystem::path(home) / ".cache" / "freevoxels";
  return {};
}

}  // namespace

std::uint64_t DeviceOptions::memoryBytes() const {
  return memoryLimit ? std::uint64_t(*memoryLimit) << 20 : std::numeric_limits<std::uint64_t>::max();
}

std::unique_ptr<Device> DeviceOptions::open(const Instance& instance, std::span<const char* const> extensions) const {
  return std::make_unique<Device>(instance, selector.value_or(""), DeviceLimits{.memory = memoryBytes()}, extensions, cacheFolder());
}

std::unique_ptr<Device> DeviceOptions::adopt(const Instance& instance, const AdoptedDevice& adopted) const {
  return std::make_unique<Device>(instance, adopted, DeviceLimits{.memory = memoryBytes()}, cacheFolder());
}

bool validationRequested() {
  const char* const value = std::getenv("FREEVOXELS_VALIDATION");
  return value != nullptr && std::string_view(value) == "1";
}

void logValidation(std::string_view message) {
  spdlog::error("Vulkan validation: {}", message);
}

void withInstance(const std::function<void(const Instance&)>& work, std::span<const char* const> extensions) {
  const Instance instance(validationRequested(), logValidation, extensions);
  work(instance);
  if (const std::uint64_t count = instance.validationMessageCount(); count > 0)
    throw InternalError(fmt::format("{} Vulkan validation messages, printed above", count));
}

void DeviceOptions::withDevice(const std::function<void(const Device&)>& work) const {
  withInstance([&](const Instance& instance) {
    const std::unique_ptr<Device> device = open(instance);
    work(*device);
  });
}

std::vector<DeviceDescription> findDevices() {
  std::vector<DeviceDescription> devices;
  withInstance([&](const Instance& instance) { devices = listDevices(instance); });
  if (devices.empty()) fail(ErrorKind::Device, "no Vulkan device was found: install mesa-vulkan-drivers to render without a GPU");
  return devices;
}

nlohmann::ordered_json toJson(const std::vector<DeviceDescription>& devices) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const DeviceDescription& device : devices)
    json.push_back({{"index", device.index},
                    {"name", device.name},
                    {"type", device.type},
                    {"uuid", device.uuid},
                    {"driver", device.driver},
                    {"memory_bytes", device.memoryBytes},
                    {"usable", device.rejections.empty()},
                    {"rejections", device.rejections}});
  return json;
}

void mentionCpu(const Device& device) {
  if (device.isCpu()) spdlog::info("rendering on the CPU, {}; a GPU is used where there is one", device.description().name);
}

}  // namespace freevoxels
