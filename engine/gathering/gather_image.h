#pragma once
// The image of a frame's samples.

#include <cstdint>

#include "engine/gathering/gather_tiles.h"
#include "engine/splatting/frame_targets.h"
#include "engine/vulkan/commands.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// GRAPHICS gather_empty.frag, and gather_tiles.vert with gather_resample.frag: the pixels of a lattice's sums, drawn in bands: first along
/// x, to rows of the lattice with the image's width, then along y.
class GatherImage {
 public:
  explicit GatherImage(const Device& device) : device_(device) {}
  /// Device memory of the rows of a frame, in bytes, with distances.
  static std::uint64_t rowBytes(const shader::GatherFrame& frame);

  /// The sums of the lattice.
  struct Sums {
    const TexelView& colorEnergy;  ///< C, E
    const TexelView& distances;    ///< sum of e times distance
    const GatherTiles& tiles;      ///< those that are not empty, and alone need be stored
  };
  /// Draws the image: premultiplied RGBA into `targets.colorEnergy` and the mean distance into `targets.distance`, if that exists.
  /// `frameBuffer` has `frame`. The targets, in any layout, are then in GENERAL and visible to later commands. What compute shaders have
  /// written before is seen.
  void record(Commands& commands, const Buffer& frameBuffer, const shader::GatherFrame& frame, const Sums& sums,
              const FrameTargets& targets);

 private:
  void makeRoom(glm::ivec2 size, bool withDistance);

  const Device& device_;
  RenderTarget rowColors_, rowDistances_;
};

}  // namespace freevoxels
