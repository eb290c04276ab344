#include "engine/gathering/gather_stages.h"

#include "engine/gathering/gather_pass.h"
#include "engine/octree/medium_levels.h"
#include "engine/octree/occupancy.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

std::vector<GatherBlocks> GatherVolume::downloadBlocks() const {
  const DeviceVolume& volume = built_.volume;
  std::vector<GatherBlocks> levels(std::size_t(volume.hierarchy.top()) + 1);
  for (int level = 0; level <= volume.hierarchy.top(); ++level) {
    if ((wantedLevels_ >> level & 1u) == 0 || (level == 0 && hasScalars())) continue;
    const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
    const std::vector<std::uint32_t> indices = downloadStored(device_, volume, level);
    std::vector<glm::uvec2> stored(indices.size());
    if (!stored.empty())
      download(device_, sources_, std::as_writable_bytes(std::span(stored)), volume.firstRank(level) * sizeof(glm::uvec2));
    const double perWorldUnit = 1.0 / (kStoredDepth * volume.voxelSize);
    GatherBlocks& blocks = levels[std::size_t(level)];
    blocks.dimensions = grid.dimensions;
    for (const glm::uvec2 block : scatterToDense(stored, indices, grid.voxels())) {
      blocks.extinction.push_back(perWorldUnit * double(glm::unpackHalf2x16(block.y).x));
      blocks.source.push_back(hasColors() ? sourceUnit_ * perWorldUnit * unpackColor(block.x)
                                          : blocks.extinction.back() * glm::dvec3(volume.albedo));
    }
  }
  return levels;
}

GatherStages downloadGatherStages(const Device& device, const BuiltVolume& built, const GatherVolume& volume, const GatherPass& pass) {
  GatherStages stages{.lattice = pass.lattice(), .medium = {}, .blocks = volume.downloadBlocks(), .gathered = pass.downloadGathered(),
                      .smoothed = pass.downloadSmoothed(), .image = {}};
  for (std::size_t level = 0; level < stages.blocks.size(); ++level)
    stages.medium.push_back(stages.blocks[level].exists() ? downloadMedium(device, built.volume, int(level)) : LevelData());
  return stages;
}

}  // namespace freevoxels
