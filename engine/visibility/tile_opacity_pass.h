#pragma once
// Which parts of an image are covered by what is drawn already, so that the rest may be left out where it is
// behind.

#include "engine/vulkan/commands.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

/// Of the image, rounded up.
glm::ivec2 coverTiles(glm::ivec2 imageSize);

/// COMPUTE tile_opacity.comp
class TileOpacityPass {
 public:
  explicit TileOpacityPass(const Device& device);

  struct Inputs {
    const Buffer& counts;              ///< shader::CutCounts
    const RenderTarget& colorEnergy;   ///< sums so far, in layout GENERAL
    const RenderTarget& opticalDepth;  ///< the same
    const shader::ResolvePush& rays;
    double hiddenDepth;  ///< optical depth of a covered pixel, at least
  };
  void record(Commands& commands, const Inputs& inputs);
  /// uint a tile, row by row from the top: 1 where all pixels are covered.
  const Buffer& tiles() const { return tiles_; }

 private:
  const Device& device_;
  Pipeline pipeline_;
  Buffer tiles_;
};

}  // namespace freevoxels
