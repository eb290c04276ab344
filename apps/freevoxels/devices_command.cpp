#include "apps/freevoxels/commands.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/common/device_options.h"
#include "apps/common/text_table.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

void printTable(const std::vector<DeviceDescription>& devices) {
  using enum TextTable::Align;
  TextTable table{.columns = {Right, Left, Left, Left, Left, Right, Left},
                  .rows = {{"INDEX", "NAME", "TYPE", "UUID", "DRIVER", "MEMORY", ""}}};
  for (const DeviceDescription& device : devices)
    table.rows.push_back(
        {std::to_string(device.index), device.name, device.type, device.uuid, device.driver,
         bytesText(device.memoryBytes),
         device.rejections.empty() ? "" : fmt::format("not usable: {}", fmt::join(device.rejections, ", "))});
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

void printJson(const std::vector<DeviceDescription>& devices) {
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
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace

void DevicesCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("devices", "List the Vulkan devices, and why a device cannot be used");
  command->add_flag("--json", json_, "Print JSON for programs");
  command->callback([this] { run(); });
}

void DevicesCommand::run() const {
  withInstance([this](const Instance& instance) {
    const std::vector<DeviceDescription> devices = listDevices(instance);
    if (devices.empty())
      fail(ErrorKind::Device,
           "no Vulkan device was found: install mesa-vulkan-drivers to render without a GPU");
    json_ ? printJson(devices) : printTable(devices);
  });
}

}  // namespace freevoxels
