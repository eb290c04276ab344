#include "engine/visibility/tile_opacity_pass.h"

#include <array>

#include "embedded/tile_opacity.h"

namespace freevoxels {

glm::ivec2 coverTiles(glm::ivec2 imageSize) {
  return (imageSize + shader::kCoverTile - 1) / shader::kCoverTile;
}

TileOpacityPass::TileOpacityPass(const Device& device)
    : device_(device),
      pipeline_(makeComputePipeline(device, shaders::tile_opacity)) {}

void TileOpacityPass::record(Commands& commands, const Inputs& inputs) {
  const glm::ivec2 tiles = coverTiles(inputs.rays.size);
  const std::uint64_t bytes = std::uint64_t(tiles.x) * std::uint64_t(tiles.y) * sizeof(std::uint32_t);
  if (tiles_.bytes() < bytes) tiles_ = Buffer(device_, bytes, MemoryUse::Device, "covered tiles");
  const std::array<Binding, 4> bindings{&inputs.counts, &tiles_, &inputs.colorEnergy, &inputs.opticalDepth};
  const shader::TilePush push{
      .rays = inputs.rays, .hiddenDepth = float(inputs.hiddenDepth), .tiles = glm::uvec2(tiles)};
  commands.dispatch(pipeline_, bindings, push, {tiles.x * tiles.y, 1, 1});
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

}  // namespace freevoxels
