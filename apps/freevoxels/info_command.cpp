#include "apps/freevoxels/commands.h"

#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include "apps/common/baked_info.h"
#include "apps/common/text_table.h"
#include "apps/common/volume_info.h"
#include "engine/renderer.h"

namespace freevoxels {

namespace {

void printTable(const std::vector<GridInfo>& grids) {
  using enum TextTable::Align;
  TextTable table{
      .columns = {Left, Left, Left, Right, Right, Left, Left, Left, Right, Right, Right, Right, Right, Right,
                  Left},
      .rows = {{"GRID", "TYPE", "CLASS", "ACTIVE VOXELS", "DIMENSIONS", "BOUNDING BOX", "VOXEL SIZE",
                "VALUES", "MEMORY", "TABLE 26", "ON DEVICE", "TABLE 98", "ON DEVICE", "BYTES/VOXEL", "USE"}}};
  for (const GridInfo& grid : grids) {
    const bool empty = grid.activeVoxels == 0;
    const glm::ivec3 low = grid.boundsMinimum, high = grid.boundsMaximum;
    const glm::i64vec3 size = grid.dimensions;
    table.rows.push_back(
        {grid.name, grid.valueType, grid.gridClass, fmt::format("{}", grid.activeVoxels),
         empty ? "-" : fmt::format("{}x{}x{}", size.x, size.y, size.z),
         empty ? "-" : fmt::format("{}..{} {}..{} {}..{}", low.x, high.x, low.y, high.y, low.z, high.z),
         fmt::format("{:.4g} {:.4g} {:.4g}", grid.voxelSize.x, grid.voxelSize.y, grid.voxelSize.z),
         grid.hasRange ? fmt::format("{:.4g}..{:.4g}", grid.minimum, grid.maximum) : "-",
         bytesText(grid.memoryBytes)});
    std::vector<std::string>& row = table.rows.back();
    for (const DirectionSet directions : {DirectionSet::Directions26, DirectionSet::Directions98}) {
      const VolumeMemory memory = memoryOf(grid, directions);
      row.push_back(canBeWhole(grid) ? bytesText(memory.table) : "-");
      row.push_back(canBeWhole(grid) ? bytesText(memory.peak()) : "-");
    }
    row.push_back(grid.storedBlocks.empty() ? "-" : fmt::format("{:.1f}", bytesPerVoxel(grid)));
    std::vector<std::string> uses = usesOf(grid);
    if (!grid.unusable.empty())
      uses.push_back("not drawable: " + grid.unusable);
    else if (!canBeWhole(grid))
      uses.emplace_back("drawn cube by cube");
    row.push_back(fmt::format("{}", fmt::join(uses, ", ")));
  }
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

}  // namespace

void InfoCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "Show the grids of a file, or what a scan's header says");
  scene_.addFields(*command, {"volume", "resolution", "raw", "series", "time-step", "spacing", "pyramid-level"});
  scene_.addFile(*command);
  command->add_flag("--json", json_, "Print JSON for programs");
  command->add_flag("--check", check_, "Read all of a baked volume (.fvx) and refuse it where anything is damaged");
  command->footer(
      "TABLE 26 and TABLE 98 are the FreeVoxel table of the grid with so many directions, ON DEVICE all\n"
      "device memory of the volume with it at most. BYTES/VOXEL is what is kept for each voxel that holds\n"
      "anything, with 26 directions and all levels of the octree (the paper: 27, without levels);\n"
      "--emission adds 4 for each voxel and block, --albedo-grid 4 for a voxel and 8 for a block.\n"
      "Examples:\n"
      "  freevoxels info cloud.vdb\n"
      "  freevoxels info procedural:cloud --resolution 256 --json\n"
      "  freevoxels info cloud.fvx --check\n");
  command->callback([this] { run(); });
}

void InfoCommand::run() {
  scene_.applyScene();
  const InputDescription& input = scene_.description.input;
  input.checkGiven();
  if (json_) {
    fmt::print("{}\n", volumeInfo(input, check_).dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace));
  } else if (const auto baked = checkedBaked(input, check_)) {
    printBaked(*baked);
    if (check_) fmt::print("\nall checksums are right\n");
  } else {
    printTable(gridsOf(input));
    if (const std::optional<ScanHeader> scan = scanHeaderOf(input))
      for (const std::string& line : linesOf(*scan)) fmt::print("{}\n", line);
  }
}

}  // namespace freevoxels
