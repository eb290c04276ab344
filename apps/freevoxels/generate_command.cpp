#include "apps/freevoxels/commands.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "apps/common/progress_line.h"
#include "apps/common/text_table.h"
#include "engine/core/error.h"
#include "engine/volume/procedural.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

namespace {

void printKinds() {
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Left}, .rows = {{"NAME", "WHAT"}}};
  for (const ProceduralKind& kind : proceduralKinds())
    table.rows.push_back({std::string(kind.name), std::string(kind.description)});
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

}  // namespace

void GenerateCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("generate", "Write a procedural volume to an OpenVDB file");
  command->add_option("NAME", name_, "One of --list");
  command->add_option("OUT.vdb", file_, "File to write");
  scene_.addFields(*command, {"resolution"});
  command->get_option("--resolution")->group("Options");
  command->add_flag("--list", list_, "List the procedural volumes");
  messages_.add(*command);
  command->footer(
      "Examples:\n"
      "  freevoxels generate --list\n"
      "  freevoxels generate cloud cloud.vdb --resolution 256\n");
  command->callback([this] { run(); });
}

void GenerateCommand::run() const {
  messages_.apply();
  if (list_) {
    printKinds();
    return;
  }
  if (name_.empty() || file_.empty())
    fail(ErrorKind::Usage, "generate takes NAME and OUT.vdb: 'freevoxels generate --list' has the names");
  if (std::filesystem::path(file_).extension() != ".vdb")
    fail(ErrorKind::Usage, "'{}' is not named .vdb, and generate writes OpenVDB files; name it so", file_);
  checkOutput(file_);
  const ProceduralField field(name_, scene_.description.input.resolution.value_or(glm::ivec3(kDefaultResolution)));
  ProgressLine line(!messages_.quiet);
  line.begin("computing voxels");
  const Progress shown = line.progress();
  {
    std::optional<DeferredInterrupts> wholeFile;
    writeVdb(file_, field, "density", [&](std::string_view stage, double fraction) {
      if (fraction == 1.0) wholeFile.emplace();
      if (shown) shown(stage, fraction);
    });
  }
  line.erase();
  if (!messages_.quiet) fmt::print("{}\n", file_);
}

}  // namespace freevoxels
