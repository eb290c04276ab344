#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/common/text_table.h"
#include "apps/freevoxels/commands.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

void PresetsCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("presets", "List the transfer functions that --transfer-function takes by name");
  command->add_flag("--json", json_, "Print the functions as JSON for programs");
  command->footer(
      "Examples:\n"
      "  freevoxels presets\n"
      "  freevoxels render head.nii.gz head.png --transfer-function ct-bone\n");
  command->callback([this] { run(); });
}

void PresetsCommand::run() const {
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Left}, .rows = {{"NAME", "WHAT"}}};
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const TransferPreset& preset : transferPresets()) {
    table.rows.push_back({std::string(preset.name), curvesOf(preset).description});
    all[std::string(preset.name)] = nlohmann::ordered_json::parse(preset.json);
  }
  if (json_) {
    fmt::print("{}\n", all.dump(2));
    return;
  }
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

}  // namespace freevoxels
