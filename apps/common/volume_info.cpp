#include "apps/common/volume_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>

#include "apps/common/baked_info.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/octree/volume_limits.h"
#include "engine/renderer.h"
#include "engine/volume/occupied_count.h"

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
  holding.reserve(volume.voxelCount());
  std::vector<float> row(std::size_t(volume.dimensions.x));
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y) {
      volume.scalars.copyRow(y, z, row);
      for (const float value : row) holding.push_back(value > 0.0f);
    }
  grid.storedBlocks = countOccupiedBlocks(volume.dimensions, std::move(holding));
  return grid;
}

}  // namespace

bool canBeWhole(const GridInfo& grid) {
  const glm::dvec3 box(grid.renderDimensions);
  return grid.unusable.empty() && box.x * box.y * box.z <= double(kMaxNumberedVoxels);
}

VolumeMemory memoryOf(const GridInfo& grid, DirectionSet directions) {
  const HierarchyLayout hierarchy(grid.renderDimensions);
  std::vector<std::uint64_t> stored = grid.storedBlocks;
  if (stored.empty())
    for (const GridLayout& level : hierarchy.levels) stored.push_back(level.voxels());
  return volumeMemory(hierarchy, stored, directions, {}, sweepStyleOf(true));
}

double bytesPerVoxel(const GridInfo& grid) {
  const std::uint64_t voxels = grid.storedBlocks.front();
  return double(memoryOf(grid, DirectionSet::Directions26).stored()) /
         double(std::max<std::uint64_t>(voxels, 1));
}

std::vector<std::string> usesOf(const GridInfo& grid) {
  std::vector<std::string> uses;
  if (grid.unusable.empty()) uses.emplace_back(grid.areLabels ? "labels" : "density");
  if (grid.isTemperature && grid.activeVoxels > 0) uses.emplace_back("temperature");
  if (grid.isAlbedo) uses.emplace_back("albedo");
  return uses;
}

std::vector<GridInfo> gridsOf(const InputDescription& input) {
  input.check();
  const VolumeKind kind = input.kind();
  if (kind == VolumeKind::OpenVdb) return describeVdb(input.volume);
  constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();
  if (kind != VolumeKind::Scan) return {describeVolume(input.open(kAny))};
  const ScanHeader header = *scanHeaderOf(input);
  std::vector<GridInfo> grids;
  const std::size_t count = input.grid ? 1 : std::max<std::size_t>(header.channels.size(), 1);
  for (std::size_t i = 0; i < count; ++i) {
    InputDescription one = input;
    std::string name = header.array.empty() ? "scan" : header.array;
    if (!input.grid && !header.channels.empty()) {
      one.grid = fmt::format("{}", i);
      name = header.channels[i].name.empty() ? *one.grid : header.channels[i].name;
    }
    GridInfo& grid = grids.emplace_back(describeVolume(one.open(kAny)));
    grid.name = printable(name);
    grid.valueType = nameOf(header.type);
    grid.gridClass = "scan";
  }
  return grids;
}

std::optional<ScanHeader> scanHeaderOf(const InputDescription& input) {
  if (input.kind() != VolumeKind::Scan) return std::nullopt;
  return readScanHeader(input.volume, input.scanRequest(std::numeric_limits<std::uint64_t>::max()));
}

namespace {

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
  if (!canBeWhole(grid)) {
    json["host_bytes"] = grid.hostBytes;
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

glm::dvec3 spacingOf(const ScanHeader& scan) {
  glm::dvec3 spacing;
  for (int axis = 0; axis < 3; ++axis) spacing[axis] = glm::length(glm::dvec3(scan.indexToWorld[axis]));
  return spacing;
}

const char* nameOf(ScanSpace space) {
  switch (space) {
    case ScanSpace::Patient:
      return "millimetres, x towards the left of the patient, y the back, z the head (LPS)";
    case ScanSpace::Millimetres:
      return "millimetres along the axes of the file";
    case ScanSpace::File:
      break;
  }
  return "the axes of the file, in a unit that it does not say";
}

/// Of the axes of the box, of length 1.
std::array<glm::dvec3, 3> directionsOf(const ScanHeader& scan) {
  std::array<glm::dvec3, 3> directions;
  for (int axis = 0; axis < 3; ++axis)
    directions[std::size_t(axis)] = glm::normalize(glm::dvec3(scan.indexToWorld[axis])) + 0.0;  // -0 becomes 0
  return directions;
}

nlohmann::ordered_json toJson(const ScanHeader& scan) {
  const auto triple = [](const glm::dvec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json json{{"format", scan.format}, {"type", nameOf(scan.type)}, {"time_steps", scan.timeSteps}};
  json["origin"] = triple(glm::dvec3(scan.indexToWorld[3]));
  json["spacing"] = triple(spacingOf(scan));
  for (const glm::dvec3& direction : directionsOf(scan)) json["directions"].push_back(triple(direction));
  json["space"] = scan.space == ScanSpace::Patient ? "LPS" : "file";
  json["unit"] = scan.space == ScanSpace::File ? nlohmann::ordered_json() : nlohmann::ordered_json("millimeter");
  if (scan.rescale) json["rescale"] = {scan.rescale->x, scan.rescale->y};
  if (scan.areColors) json["colors"] = true;
  for (const ScanChannel& channel : scan.channels) {
    nlohmann::ordered_json one{{"name", channel.name}, {"shown", channel.isShown}};
    if (channel.color) one["color"] = triple(glm::dvec3(*channel.color));
    if (channel.window) one["window"] = *channel.window;
    json["channels"].push_back(std::move(one));
  }
  if (!scan.levels.empty()) json["level"] = scan.level;
  for (const glm::ivec3& level : scan.levels) json["levels"].push_back({level.x, level.y, level.z});
  return json;
}

}  // namespace

std::vector<std::string> linesOf(const ScanHeader& scan) {
  const auto triple = [](const glm::dvec3& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z); };
  std::vector<std::string> lines{fmt::format("format      {}", scan.format)};
  if (scan.timeSteps > 1) lines.push_back(fmt::format("time steps  {}", scan.timeSteps));
  if (scan.levels.size() > 1) {
    std::vector<std::string> levels;
    for (const glm::ivec3& level : scan.levels) levels.push_back(fmt::format("{}x{}x{}", level.x, level.y, level.z));
    lines.push_back(fmt::format("levels      {}; this is level {}", fmt::join(levels, " "), scan.level));
  }
  if (!scan.channels.empty()) {
    std::vector<std::string> channels;
    for (std::size_t i = 0; i < scan.channels.size(); ++i)
      channels.push_back(fmt::format("{} {}{}", i, printable(scan.channels[i].name), scan.channels[i].isShown ? "" : " (not shown)"));
    lines.push_back(fmt::format("channels    {}{}", fmt::join(channels, ", "), scan.areColors ? "; they are colours" : ""));
  }
  if (scan.rescale) lines.push_back(fmt::format("rescale     values of the file x {:.6g} + {:.6g}", scan.rescale->x, scan.rescale->y));
  lines.push_back(fmt::format("space       {}", nameOf(scan.space)));
  lines.push_back("origin      " + triple(glm::dvec3(scan.indexToWorld[3])));
  lines.push_back("spacing     " + triple(spacingOf(scan)));
  const std::array<glm::dvec3, 3> directions = directionsOf(scan);
  for (std::size_t axis = 0; axis < 3; ++axis) lines.push_back(fmt::format("direction {} {}", "xyz"[axis], triple(directions[axis])));
  return lines;
}

std::shared_ptr<const fvx::FvxFile> checkedBaked(const InputDescription& input, bool check) {
  input.check();
  std::shared_ptr<const fvx::FvxFile> baked = input.baked();
  if (check && !baked) fail(ErrorKind::Usage, "{} is for baked volumes (.fvx), and '{}' is none", Parameter("check"), input.volume);
  if (check) baked->checkAll();
  return baked;
}

nlohmann::ordered_json volumeInfo(const InputDescription& input, bool check) {
  if (const auto baked = checkedBaked(input, check)) return bakedJson(*baked);
  nlohmann::ordered_json json{{"input", input.volume}, {"grids", nlohmann::ordered_json::array()}};
  for (const GridInfo& grid : gridsOf(input)) json["grids"].push_back(toJson(grid));
  if (const std::optional<ScanHeader> scan = scanHeaderOf(input)) json["scan"] = toJson(*scan);
  return json;
}

}  // namespace freevoxels
