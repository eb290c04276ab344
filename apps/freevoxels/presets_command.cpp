#include <CLI/CLI.hpp>

#include "apps/common/text_table.h"
#include "apps/freevoxels/commands.h"
#include "engine/core/error.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

void PresetsCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("presets", "List the transfer functions that --transfer-function takes by name");
  command->add_option("NAME", name_, "Print this function alone, as JSON that --transfer-function reads");
  command->add_flag("--json", json_, "Print the functions as JSON for programs");
  command->footer(
      "Examples:\n"
      "  freevoxels presets\n"
      "  freevoxels presets ct-bone > my.json\n"
      "  freevoxels render head.nii.gz head.png --transfer-function ct-bone\n");
  command->callback([this] { run(); });
}

void PresetsCommand::run() const {
  using enum TextTable::Align;
  if (!name_.empty()) {
    const TransferPreset* const preset = presetNamed(name_);
    if (preset == nullptr) fail(ErrorKind::Usage, "there is no preset '{}': 'freevoxels presets' lists their names", name_);
    fmt::print("{}\n", preset->json);
    return;
  }
  TextTable table{.columns = {Left, Left}, .rows = {{"NAME", "WHAT"}}};
  if (json_) {
    fmt::print("{}\n", presetsJson());
    return;
  }
  for (const TransferPreset& preset : transferPresets()) table.rows.push_back({std::string(preset.name), curvesOf(preset).description});
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

}  // namespace freevoxels
