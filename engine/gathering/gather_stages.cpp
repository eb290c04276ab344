#include "engine/gathering/gather_stages.h"

#include <cmath>

#include "engine/gathering/gather_pass.h"
#include "engine/octree/medium_levels.h"
#include "engine/octree/occupancy.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

/// Three signed components of 9 bits with a shared exponent of 5 bits, which is 16 more than it says (shaders/packed_gradient.glsl).
glm::dvec3 unpackGradient(std::uint32_t bits) {
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const int part = int(bits >> (9 * axis) & 0x1ffu);
    gradient[axis] = std::ldexp(double(part < 256 ? part : part - 512) / 255.0, int(bits >> 27) - 16);
  }
  return gradient;
}

}  // namespace

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

std::vector<GatherLight> GatherVolume::downloadLight() const {
  const auto words = [&](const Buffer& buffer) {
    std::vector<std::uint32_t> result(buffer.bytes() / sizeof(std::uint32_t));
    if (!result.empty()) download(device_, buffer, std::as_writable_bytes(std::span(result)));
    return result;
  };
  std::vector<std::vector<std::uint32_t>> codes;
  for (int slot = 0; slot < lightSlots(); ++slot) codes.push_back(words(lightCodes_[std::size_t(slot)]));
  const std::vector<std::uint32_t> gradients = hasSurfaces() ? words(gradients_) : std::vector<std::uint32_t>();
  std::vector<GatherLight> levels(levels_.size());
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    if ((wantedLevels_ & lightLevels_) >> level == 0 || codes.empty()) continue;
    const shader::GatherLevel& cells = levels_[level];
    GatherLight& light = levels[level];
    light.depths.resize(std::size_t(sampleLights()));
    light.ambient.resize(std::size_t(ambientChannels_));
    glm::ivec3 block;
    for (block.z = 0; block.z < cells.dimensions.z; ++block.z)
      for (block.y = 0; block.y < cells.dimensions.y; ++block.y)
        for (block.x = 0; block.x < cells.dimensions.x; ++block.x) {
          const glm::ivec3 cell = block / shader::kGatherBrickEdge, local = block % shader::kGatherBrickEdge;
          const std::uint32_t brick =
              cells_.numbers[std::size_t(cells.firstCell + cell.x + cell.y * cells.cellStrides.x + cell.z * cells.cellStrides.y)];
          const std::size_t index = ((std::size_t(brick) * shader::kGatherBrickEdge + std::size_t(local.z)) * shader::kGatherBrickEdge +
                                     std::size_t(local.y)) * shader::kGatherBrickEdge + std::size_t(local.x);
          for (std::size_t slot = 0; slot < codes.size(); ++slot) {
            const double root = double(codes[slot][index / 2] >> (index % 2 * 16) & 0xffffu) / 65535.0;
            auto& depths = slot < light.depths.size() ? light.depths[slot] : light.ambient[slot - light.depths.size()];
            depths.push_back(kOpaqueDepth * root * root);
          }
          if (!gradients.empty()) light.gradients.push_back(unpackGradient(gradients[index]));
        }
  }
  return levels;
}

GatherStages downloadGatherStages(const Device& device, const BuiltVolume& built, const GatherVolume& volume, const GatherPass& pass) {
  GatherStages stages{.lattice = pass.lattice(), .medium = {}, .blocks = volume.downloadBlocks(), .light = volume.downloadLight(),
                      .gathered = pass.downloadGathered(),
                      .smoothed = pass.downloadSmoothed(), .image = {}};
  for (std::size_t level = 0; level < stages.blocks.size(); ++level)
    stages.medium.push_back(stages.blocks[level].exists() ? downloadMedium(device, built.volume, int(level)) : LevelData());
  return stages;
}

}  // namespace freevoxels
