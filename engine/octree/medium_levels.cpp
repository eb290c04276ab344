#include "engine/octree/medium_levels.h"

#include <array>
#include <glm/gtc/packing.hpp>

#include "embedded/medium_level.h"
#include "embedded/medium_level_joined.h"
#include "engine/octree/occupancy.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

MediumLevels::MediumLevels(const Device& device, const DeviceVolume& volume, LevelDispatches dispatches)
    : pipelines_{.dispatches = dispatches} {
  const auto pipeline = [&](const Shader& shader, bool fromVoxels) {
    return makeComputePipeline(device, shader, {volume.hasColors, fromVoxels, volume.hasEmission()});
  };
  pipelines_.fromVoxels = pipeline(shaders::medium_level, true);
  pipelines_.fromBlocks = pipeline(shaders::medium_level, false);
  if (dispatches == LevelDispatches::Joined) pipelines_.joined = pipeline(shaders::medium_level_joined, false);
}

void MediumLevels::record(Commands& commands, const DeviceVolume& volume, const Buffer& steps) const {
  commands.beginPass("octree");
  for (const shader::LevelRange levels : levelRanges(volume.hierarchy, pipelines_.dispatches)) {
    const shader::MediumLevelPush push{.stores = volume.stores(),
                                       .levels = levels,
                                       .voxels = volume.layout.dimensions,
                                       .voxelLength = float(volume.voxelSize),
                                       .firstColor = volume.firstRank(1)};
    const std::array<Binding, 2> bindings{&volume.occupancy, &steps};
    commands.dispatchLinear(pipelines_.of(levels), bindings, push,
                            LevelPipelines::threads(levels, volume.stored[std::size_t(levels.first)]));
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
