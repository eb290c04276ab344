#pragma once
// What the gather keeps of a volume: overlapping words of occupancy, cells that say what is empty, and of every
// occupied block its extinction and the light that it sends to the eye.

#include <optional>

#include "engine/attenuation/attenuation_table.h"
#include "engine/hierarchy/volume_builder.h"
#include "engine/splatting/splat_pass.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// COMPUTE occupancy_windows.comp and skip_cells.comp once, shade_blocks.comp for the first frame and for every one
/// whose light differs from the frame before. Belongs to one volume, which must outlive it.
class GatherVolume {
 public:
  /// Fails with ExitCode::OutOfMemory.
  GatherVolume(const Device& device, const BuiltVolume& built);

  /// What a frame needs to be shaded. `lighting` and `lights` are null of a frame that is not lit.
  struct Shading {
    const FrameConstants& frame;
    const AttenuationTable* table;  ///< null where no light reads it
    const Lighting* lighting;
    const Buffer* lights;  ///< shader::Light
  };
  /// Shades the blocks of the levels that the frame reads, as far as what the frame before left does not serve.
  void record(Commands& commands, const Shading& shading);

  const TexelView& windows() const { return windowTexels_; }
  const TexelView& skipCells() const { return skipTexels_; }
  /// By rank: source term and extinction.
  const TexelView& sources() const { return sourceTexels_; }
  /// By rank: how the source term depends on the direction to the eye; read where hasTowards() says so.
  const TexelView& towards() const { return towardsTexels_; }
  /// Fills in what the frame has of the volume: the units of what is stored, and the levels that it reads.
  void describe(shader::GatherFrame& frame) const;
  bool hasTowards() const { return lit_ && !viewDependent_; }

 private:
  shader::GatherLevel level(int number) const;
  void recordOccupancy(Commands& commands);
  void makeTowards(std::uint64_t blocks);
  void shade(Commands& commands, const Shading& shading, int level);

  const Device& device_;
  const BuiltVolume& built_;
  int firstSkipLevel_;
  Pipeline windowsPass_, skipPass_, shadePass_;
  Buffer frame_;  ///< shader::SetupFrame
  Buffer windows_, skipCells_;
  Buffer sources_;  ///< four halves
  Buffer towards_;  ///< three signed normalised bytes; one block's before a frame needs them
  TexelView windowTexels_, skipTexels_, sourceTexels_, towardsTexels_;
  bool hasOccupancy_ = false;
  // What the source terms are of.
  std::uint32_t shadedLevels_ = 0;  ///< a bit for each level
  bool lit_ = false, viewDependent_ = false;
  double sourceUnit_ = 1.0;
  std::optional<Lighting> lighting_;
};

}  // namespace freevoxels
