#include "apps/freevoxels/commands.h"

#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/common/text_table.h"
#include "apps/freevoxels/baked_info.h"
#include "engine/core/error.h"
#include "engine/renderer.h"
#include "engine/volume/occupied_count.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

namespace {

/// Describes a volume as describeVdb does.
GridInfo describeVolume(const Volume& volume) {
  GridInfo grid;
  grid.name = "density";
  grid.valueType = "float";
  grid.gridClass = volume.isFog ? "fog volume" : "unknown";
  grid.activeVoxels = volume.activeVoxels;
  grid.dimensions = volume.dimensions;
  grid.renderDimensions = volume.dimensions;
  grid.boundsMinimum = volume.indexOrigin;
  grid.boundsMaximum = volume.indexOrigin + (volume.dimensions - 1);
  for (int axis = 0; axis < 3; ++axis)
    grid.voxelSize[axis] = glm::length(glm::dvec3(volume.indexToWorld[axis]));
  grid.hasRange = volume.activeVoxels > 0;
  grid.minimum = volume.minimum;
  grid.maximum = volume.maximum;
  grid.memoryBytes = grid.hostBytes = volume.scalars.bytes();
  std::vector<bool> holding;
  for (const float value : denseScalars(volume)) holding.push_back(value > 0.0f);
  grid.storedBlocks = countOccupiedBlocks(volume.dimensions, std::move(holding));
  return grid;
}

/// Memory without voxel colours; of the whole box if the occupied blocks were not counted.
VolumeMemory memoryOf(const GridInfo& grid, DirectionSet directions) {
  const HierarchyLayout hierarchy(grid.renderDimensions);
  std::vector<std::uint64_t> stored = grid.storedBlocks;
  if (stored.empty())
    for (const GridLayout& level : hierarchy.levels) stored.push_back(level.voxels());
  return volumeMemory(hierarchy, stored, directions, {}, sweepStyleOf(true));
}

/// Bytes stored for each occupied voxel with 26 directions.
double bytesPerVoxel(const GridInfo& grid) {
  const std::uint64_t voxels = grid.storedBlocks.front();
  return double(memoryOf(grid, DirectionSet::Directions26).stored()) /
         double(std::max<std::uint64_t>(voxels, 1));
}

/// The possible uses of a grid.
std::vector<std::string> usesOf(const GridInfo& grid) {
  std::vector<std::string> uses;
  if (grid.unusable.empty()) uses.emplace_back("density");
  if (grid.isTemperature && grid.activeVoxels > 0) uses.emplace_back("temperature");
  if (grid.isAlbedo) uses.emplace_back("albedo");
  return uses;
}

std::vector<GridInfo> describeInput(const InputDescription& input) {
  input.check();
  if (proceduralName(input.volume))
    return {describeVolume(input.open(std::numeric_limits<std::uint64_t>::max()))};
  return describeVdb(input.volume);
}

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
      row.push_back(grid.unusable.empty() ? bytesText(memory.table) : "-");
      row.push_back(grid.unusable.empty() ? bytesText(memory.peak()) : "-");
    }
    row.push_back(grid.storedBlocks.empty() ? "-" : fmt::format("{:.1f}", bytesPerVoxel(grid)));
    std::vector<std::string> uses = usesOf(grid);
    if (!grid.unusable.empty()) uses.push_back("not drawable: " + grid.unusable);
    row.push_back(fmt::format("{}", fmt::join(uses, ", ")));
  }
  for (const std::string& line : table.lines()) fmt::print("{}\n", line);
}

nlohmann::ordered_json toJson(const GridInfo& grid) {
  const auto triple = [](const auto& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json json{{"name", grid.name},
                              {"type", grid.valueType},
                              {"class", grid.gridClass},
                              {"active_voxels", grid.activeVoxels},
                              {"dimensions", triple(grid.dimensions)},
                              {"bounds_minimum", triple(grid.boundsMinimum)},
                              {"bounds_maximum", triple(grid.boundsMaximum)},
                              {"voxel_size", triple(grid.voxelSize)},
                              {"memory_bytes", grid.memoryBytes}};
  json["uses"] = usesOf(grid);
  if (grid.hasRange) json["range"] = {grid.minimum, grid.maximum};
  if (!grid.unusable.empty()) {
    json["not_drawable"] = grid.unusable;
    return json;
  }
  const VolumeMemory memory = memoryOf(grid, DirectionSet::Directions26);
  json["table_bytes"] = memory.table;
  json["stored_bytes"] = memory.stored();
  if (!grid.storedBlocks.empty()) json["stored_bytes_per_voxel"] = bytesPerVoxel(grid);
  json["stored_bytes_per_box_voxel"] =
      double(memory.stored()) / double(HierarchyLayout(grid.renderDimensions).levels.front().voxels());
  json["device_bytes"] = memory.peak();
  json["host_bytes"] = grid.hostBytes;
  const VolumeMemory memory98 = memoryOf(grid, DirectionSet::Directions98);
  json["table_98_bytes"] = memory98.table;
  json["device_98_bytes"] = memory98.peak();
  return json;
}

}  // namespace

void InfoCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "Show the grids of a file");
  scene_.addFields(*command, {"volume", "resolution"});
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

void InfoCommand::describeBaked() const {
  const InputDescription& input = scene_.description.input;
  input.check();
  const fvx::FvxFile file(input.volume);
  if (check_) file.checkAll();
  if (json_)
    fmt::print("{}\n", bakedJson(file).dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace));
  else
    printBaked(file);
  if (check_ && !json_) fmt::print("\nall checksums are right\n");
}

void InfoCommand::run() {
  scene_.applyScene();
  const InputDescription& input = scene_.description.input;
  input.checkGiven();
  const bool isBaked = !proceduralName(input.volume) && fvx::isFvx(input.volume);
  if (isBaked) return describeBaked();
  if (check_) fail(ErrorKind::Usage, "--check is for baked volumes (.fvx), and '{}' is none", input.volume);
  const std::vector<GridInfo> grids = describeInput(input);
  if (!json_) {
    printTable(grids);
    return;
  }
  nlohmann::ordered_json json{{"input", input.volume}, {"grids", nlohmann::ordered_json::array()}};
  for (const GridInfo& grid : grids) json["grids"].push_back(toJson(grid));
  fmt::print("{}\n", json.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace freevoxels
