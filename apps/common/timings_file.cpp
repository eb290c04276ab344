#include "apps/common/timings_file.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/common/program.h"
#include "apps/common/text_table.h"
#include "engine/core/atomic_file.h"

namespace freevoxels {

void logOptions(const OptionList& options) {
  TextTable table{.columns = {TextTable::Align::Left, TextTable::Align::Left}, .rows = {}};
  for (const auto& [name, value] : options) table.rows.push_back({name.empty() ? "IN" : name, value});
  for (const std::string& line : table.lines()) spdlog::debug("{}", line);
}

namespace {

void logCounts(const RunReport& report) {
  spdlog::debug("{} voxels; at most {:.1f} MiB on the device", report.voxels, double(report.devicePeak) / 0x1p20);
  if (report.visibleVoxels) {
    const auto stored = double(report.memory.stored());
    spdlog::debug(
        "{} of them empty; blocks and attenuation table: {:.1f} MiB, {:.1f} bytes a voxel that holds anything, {:.1f} "
        "a voxel of the box",
        report.voxels - *report.visibleVoxels, stored / 0x1p20, stored / double(std::max<std::uint64_t>(*report.visibleVoxels, 1)),
        stored / double(report.voxels));
  }
  if (const auto& solved = report.scattering)
    spdlog::debug(
        "scattered light: {}x{}x{} cells of {}³ voxels, {} sets of 26 sweeps, residual {:.4f} of the light that is scattered once",
        solved->cells.x, solved->cells.y, solved->cells.z, solved->edge, solved->sets, solved->residual);
  if (report.cut.considered == 0) return;  // the gather chooses none
  spdlog::debug("{} blocks considered for the last frame, {} of them empty, {} outside of the image, {} hidden", report.cut.considered,
                report.cut.empty, report.cut.outside, report.cut.hidden);
  for (std::size_t level = 0; level < report.cut.drawn.size(); ++level)
    if (report.cut.drawn[level] > 0) spdlog::debug("{} blocks of {}³ voxels drawn", report.cut.drawn[level], 1 << level);
}

}  // namespace

void logStages(const RunReport& report) {
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Right, Right}, .rows = {{"stage", "ms", "device ms"}}};
  for (const StageTime& stage : report.stages) {
    const std::string time = fmt::format("{:.2f}", stage.milliseconds);
    table.rows.push_back({stage.name, stage.onDevice ? "" : time, stage.onDevice ? time : ""});
  }
  table.rows.push_back({"total", fmt::format("{:.2f}", report.totalMilliseconds), ""});
  for (const std::string& line : table.lines()) spdlog::debug("{}", line);
  logCounts(report);
}

void writeTimings(const std::filesystem::path& file, const RunReport& report) {
  nlohmann::ordered_json json;
  json["version"] = programVersion();
  json["device"] = {
      {"name", report.device.name}, {"type", report.device.type}, {"uuid", report.device.uuid}, {"driver", report.device.driver}};
  for (const auto& [name, value] : report.options) {
    nlohmann::ordered_json& entry = json["options"][name.empty() ? "input" : name.substr(name.find_first_not_of('-'))];
    if (entry.is_string())
      entry = entry.get<std::string>() + " " + value;  // an option that may be repeated
    else
      entry = value.empty() ? nlohmann::ordered_json(true) : nlohmann::ordered_json(value);
  }
  for (const StageTime& stage : report.stages)
    json["stages"].push_back({{"name", stage.name}, {"milliseconds", stage.milliseconds}, {"on_device", stage.onDevice}});
  json["voxels"] = report.voxels;
  if (report.visibleVoxels) json["visible_voxels"] = *report.visibleVoxels;
  json["memory_bytes"] = {{"stored", report.memory.stored()}, {"peak", report.devicePeak}};
  if (const auto& solved = report.scattering)
    json["scattering"] = {{"cells", {solved->cells.x, solved->cells.y, solved->cells.z}},
                          {"cell_edge", solved->edge},
                          {"sets", solved->sets},
                          {"residual", solved->residual}};
  json["blocks"] = {{"considered", report.cut.considered}, {"empty", report.cut.empty},   {"outside", report.cut.outside},
                    {"hidden", report.cut.hidden},         {"opened", report.cut.opened}, {"drawn", report.cut.drawn}};
  json["total_milliseconds"] = report.totalMilliseconds;

  const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  const DeferredInterrupts wholeFile;
  writeTextAtomically(file, text);
}

}  // namespace freevoxels
