#pragma once
// The tiles of a lattice of which an image is drawn.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/vulkan/commands.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// COMPUTE gather_full_tiles.comp, gather_list_tiles.comp: a list of the tiles of samples that hold anything, and of those beside these. The
/// image of all other samples is empty.
class GatherTiles {
 public:
  explicit GatherTiles(const Device& device) : device_(device) {}

  /// Records listing the tiles of a frame's sums. `frameBuffer` has `frame`. The list is visible to later passes.
  void record(Commands& commands, const Buffer& frameBuffer, const shader::GatherFrame& frame, const TexelView& colorEnergy);
  /// Entries as shader::kTileShift says.
  const Buffer& list() const { return list_; }

  /// Dispatches workgroups of kGatherTile² threads for the tiles of the list, which is the last of the bindings. The pipeline's push
  /// constants are shader::TilesPush.
  void dispatch(Commands& commands, const Pipeline& pipeline, std::span<const Binding> bindings) const;
  /// Draws two triangles for each of the list's tiles. To be called within rendering, with the pipeline bound.
  void draw(Commands& commands) const;

  /// Whether each tile of the last frame is in the list, row by row; for tests. Waits.
  std::vector<bool> download() const;
  /// The number of tiles of a lattice along both axes.
  static glm::ivec2 extent(glm::ivec2 seenSamples) { return (seenSamples + shader::kLatticeTile - 1) / shader::kLatticeTile; }

 private:
  std::uint64_t ranges() const;

  const Device& device_;
  std::uint64_t count_ = 0;  ///< of the last frame's tiles
  Buffer marks_, list_;
  Buffer sizes_;  ///< shader::DrawSize, shader::DispatchSize for each range of the list
};

}  // namespace freevoxels
