#include "apps/common/volume_info.h"

#include <algorithm>
#include <limits>

#include "apps/common/baked_info.h"
#include "engine/core/error.h"
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
  for (const float value : denseScalars(volume)) holding.push_back(value > 0.0f);
  grid.storedBlocks = countOccupiedBlocks(volume.dimensions, std::move(holding));
  return grid;
}

}  // namespace

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
  if (proceduralName(input.volume))
    return {describeVolume(input.open(std::numeric_limits<std::uint64_t>::max()))};
  return describeVdb(input.volume);
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
  return json;
}

}  // namespace freevoxels
