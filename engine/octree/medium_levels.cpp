#include "engine/octree/medium_levels.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "embedded/medium_level.h"
#include "engine/octree/occupancy.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

static_assert(shader::kRowAlignment % 2 == 0);  // two children in a row are in the same occupancy word

}  // namespace

MediumLevels::MediumLevels(const Device& device, const DeviceVolume& volume, LevelDispatches dispatches) : dispatches_(dispatches) {
  const auto pipeline = [&](bool fromVoxels, bool several) {
    return makeComputePipeline(device, shaders::medium_level, {volume.hasColors, fromVoxels, volume.hasEmission(), several});
  };
  fromVoxels_ = pipeline(true, false);
  fromBlocks_ = pipeline(false, false);
  if (dispatches == LevelDispatches::Joined) several_ = pipeline(false, true);
}

void MediumLevels::record(Commands& commands, const DeviceVolume& volume, const Buffer& steps) const {
  commands.beginPass("octree");
  for (const shader::LevelRange levels : levelRanges(volume.hierarchy, dispatches_)) {
    const shader::MediumLevelPush push{.stores = volume.stores(),
                                       .levels = levels,
                                       .voxels = volume.layout.dimensions,
                                       .voxelLength = float(volume.voxelSize),
                                       .firstColor = volume.firstRank(1)};
    const std::array<Binding, 2> bindings{&volume.occupancy, &steps};
    commands.dispatchLinear(isSeveral(levels)   ? several_
                            : levels.first == 1 ? fromVoxels_
                                                : fromBlocks_,
                            bindings, push, isSeveral(levels) ? 1 : volume.stored[std::size_t(levels.first)]);
    commands.barrier(kComputeStage, kComputeStage);
  }
}

LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level) {
  const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
  const std::vector<std::uint32_t> blocks = downloadStored(device, volume, level);
  const std::uint64_t first = volume.firstRank(level);
  std::vector<float> stored(blocks.size());
  download(device, volume.extinction, std::as_writable_bytes(std::span(stored)), first * sizeof(float));
  const std::vector<float> extinction = scatterToDense(stored, blocks, grid.voxels());
  LevelData data{.dimensions = grid.dimensions, .extinction = {extinction.begin(), extinction.end()}};
  if (volume.hasEmission()) {
    std::vector<std::uint32_t> light(blocks.size());
    download(device, volume.emission, std::as_writable_bytes(std::span(light)),
             first * sizeof(std::uint32_t));
    for (const std::uint32_t bits : scatterToDense(light, blocks, grid.voxels()))
      data.emission.push_back(volume.emissionUnit * unpackColor(bits));
  }
  if (!volume.hasColors || level == 0) return data;
  std::vector<glm::uvec2> colors(blocks.size());
  download(device, volume.blockColors, std::as_writable_bytes(std::span(colors)),
           (first - volume.firstRank(1)) * sizeof(glm::uvec2));
  for (const glm::uvec2 bits : scatterToDense(colors, blocks, grid.voxels()))
    data.colors.emplace_back(glm::unpackHalf2x16(bits.x), glm::unpackHalf2x16(bits.y).x);
  return data;
}

}  // namespace freevoxels
