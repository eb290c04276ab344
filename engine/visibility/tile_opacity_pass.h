#pragma once
// Finds the tiles of an image of which every pixel is covered by what is drawn so far, so that blocks behind
// them can be left out.

#include "engine/vulkan/commands.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

/// Number of tiles of an image, rounded up.
glm::ivec2 coverTiles(glm::ivec2 imageSize);

/// COMPUTE tile_opacity.comp
class TileOpacityPass {
 public:
  explicit TileOpacityPass(const Device& device);

  struct Inputs {
    const Buffer& counts;              ///< shader::CutCounts
    const RenderTarget& colorEnergy;   ///< C and E so far, in layout GENERAL
    const RenderTarget& opticalDepth;  ///< T so far, in layout GENERAL
    const shader::ResolvePush& rays;
    double hiddenDepth;  ///< least optical depth of a covered pixel
  };
  void record(Commands& commands, const Inputs& inputs);
  /// uint for each tile, row by row from the top: 1 if all pixels are covered.
  const Buffer& tiles() const { return tiles_; }

 private:
  const Device& device_;
  Pipeline pipeline_;
  Buffer tiles_;
};

}  // namespace freevoxels
