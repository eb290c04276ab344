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

}  // namespace

void DevicesCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("devices", "List the Vulkan devices, and why a device cannot be used");
  command->add_flag("--json", json_, "Print JSON for programs");
  command->callback([this] { run(); });
}

void DevicesCommand::run() const {
  const std::vector<DeviceDescription> devices = findDevices();
  if (json_)
    fmt::print("{}\n", toJson(devices).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  else
    printTable(devices);
}

}  // namespace freevoxels
