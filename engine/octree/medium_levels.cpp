#include "engine/octree/medium_levels.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "embedded/medium_level.h"
#include "engine/octree/occupancy.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

static_assert(shader::kRowAlignment % 2 == 0);  // two children in a row are in the same occupancy word

shader::MediumLevelPush mediumPush(const DeviceVolume& volume, int level) {
  const int childEdge = Block{.level = level - 1}.edge();
  return {.child = volume.onDevice(level - 1),
          .parent = volume.onDevice(level),
          .stores = volume.stores(),
          .voxels = volume.layout.dimensions,
          .childEdge = childEdge,
          .parentCount = std::uint32_t(volume.stored[std::size_t(level)]),
          .childLength = float(volume.voxelSize * childEdge),
          .firstColor = volume.firstRank(1)};
}

}  // namespace

MediumLevels::MediumLevels(const Device& device, const DeviceVolume& volume) {
  const std::uint32_t colors = volume.hasColors, emission = volume.hasEmission();
  for (const std::uint32_t fromVoxels : {0u, 1u})
    pipelines_[fromVoxels] =
        makeComputePipeline(device, shaders::medium_level, {colors, fromVoxels, emission});
}

void MediumLevels::record(Commands& commands, const DeviceVolume& volume,
                          std::span<const BlockList> coarse) const {
  commands.beginPass("octree");
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    const shader::MediumLevelPush push = mediumPush(volume, level);
    const std::array<Binding, 2> bindings{&volume.occupancy, &coarse[std::size_t(level) - 1].indices};
    commands.dispatchLinear(pipelines_[level == 1 ? 1 : 0], bindings, push, push.parentCount);
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
