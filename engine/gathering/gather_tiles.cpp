#include "engine/gathering/gather_tiles.h"

#include <algorithm>
#include <array>

#include "embedded/gather_full_tiles.h"
#include "embedded/gather_list_tiles.h"
#include "engine/core/error.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

std::uint64_t GatherTiles::ranges() const {
  return (count_ + shader::kTilesOfARange - 1) / shader::kTilesOfARange;
}

void GatherTiles::record(Commands& commands, const Buffer& frameBuffer, const shader::GatherFrame& frame, const TexelView& colorEnergy) {
  const glm::ivec2 tiles = extent(frame.seenExtent);
  count_ = std::uint64_t(tiles.x) * std::uint64_t(tiles.y);
  FV_CHECK_LT(std::uint64_t(0), count_);
  growBuffer(device_, marks_, count_ * sizeof(std::uint32_t), "marks of tiles");
  growBuffer(device_, list_, count_ * sizeof(std::uint32_t), "list of tiles");
  growBuffer(device_, sizes_, sizeof(shader::DrawSize) + ranges() * sizeof(shader::DispatchSize), "sizes of tiles",
             VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  commands.clear(marks_);
  const std::array<Binding, 4> marking{&frameBuffer, &colorEnergy, &marks_, &sizes_}, listing{&frameBuffer, &marks_, &sizes_, &list_};
  commands.dispatch(makeComputePipeline(device_, shaders::gather_full_tiles), marking, {tiles * shader::kGatherTile, 1});
  commands.barrier(kComputeStage, kComputeStage);
  commands.dispatch(makeComputePipeline(device_, shaders::gather_list_tiles), listing, {tiles, 1});
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT);
}

void GatherTiles::dispatch(Commands& commands, const Pipeline& pipeline, std::span<const Binding> bindings) const {
  constexpr std::uint64_t kGroupsOfATile = (shader::kLatticeTile / shader::kGatherTile) * (shader::kLatticeTile / shader::kGatherTile);
  for (std::uint64_t range = 0; range < ranges(); ++range) {
    const std::uint64_t first = range * shader::kTilesOfARange, most = std::min<std::uint64_t>(count_ - first, shader::kTilesOfARange);
    commands.dispatchIndirect(pipeline, bindings, shader::TilesPush{.firstOfRange = int(first)}, sizes_,
                              sizeof(shader::DrawSize) + range * sizeof(shader::DispatchSize), most * kGroupsOfATile);
  }
}

void GatherTiles::draw(Commands& commands) const {
  vkCmdDrawIndirect(commands.handle(), sizes_.handle(), 0, 1, 0);
}

std::vector<bool> GatherTiles::download() const {
  shader::DrawSize size{};
  freevoxels::download(device_, sizes_, std::as_writable_bytes(std::span(&size, 1)));
  std::vector<std::uint32_t> entries(size.instances);
  freevoxels::download(device_, list_, std::as_writable_bytes(std::span(entries)));
  std::vector<bool> isListed(count_);
  for (const std::uint32_t entry : entries) isListed[entry >> shader::kTileShift] = true;
  return isListed;
}

}  // namespace freevoxels
