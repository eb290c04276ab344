#pragma once
// Adds the sums of one share after the other, which are drawn into float targets, to the fixed-point sums of
// all shares.

#include "engine/image/fixed_sums.h"
#include "engine/splatting/splat_pass.h"

namespace freevoxels {

/// Upper bounds of every pixel's sums, in the units of splat_sums.h, computed from constants that every
/// process of a distributed render knows.
///
/// A voxel's e_v is at most A/s times the length of the pixel's ray in its kernel, s being the length of a lattice layer, and A is at
/// most 1; the lengths of all kernels on a ray add up to the ray's length in the volume. So E is at most the number of layers that a
/// ray crosses. C is at most E times the brightest colour, plus the light that the medium sends out itself. Only in normalised images,
/// where a voxel's light is averaged over its kernel, the surface of something with an optical depth of more than 64 a layer can have
/// a larger E: accumulate_sums.comp then reduces C, E and the distances of that share and pixel alike, which keeps its colour.
struct SumBounds {
  double layers = 1.0;     ///< number of voxel layers that a ray crosses
  double radiance = 1.0;   ///< of a lit voxel's colour
  double emission = 0.0;   ///< radiance of a pixel by the medium's own light
  double farthest = 1.0;   ///< distance of any voxel from the eye plane, world units
};

SumBounds sumBounds(const DeviceVolume& volume, const FrameConstants& frame, const Lighting* lighting);

/// The digits with which sums within these bounds fit kValueBits, with a margin of 8: kernels that are widened to a pixel, or of
/// different levels of the octree, overlap more than others. The rounding of 256 shares then loses at most 2^7 units: 3e-14 of the bound of the
/// largest sum. The optical depth of a share ends at 32, beyond which a pixel's opacity is 1 in 32-bit floats.
SumDigits sumDigits(const SumBounds& bounds);

/// The sums that a frame will have, without values.
FixedSums sumsLayout(const DeviceVolume& volume, const FrameConstants& frame, const FrameSettings& settings);

/// COMPUTE mark_tiles.comp for each chunk of a share's splats, then accumulate_sums.comp for the share
class AccumulatePass {
 public:
  AccumulatePass(const Device& device, bool withDistance);

  /// Sets all sums to 0. `layout` describes the sums; its values are not read.
  void recordClear(Commands& commands, FixedSums layout);
  /// Marks the tiles of the image that the splats of a draw chunk reach.
  void recordMarks(Commands& commands, const Buffer& splats, const BlockList& list, std::uint32_t chunk);
  /// Adds the share's sums in the marked tiles of the targets, and sets those to 0. The targets are in layout
  /// GENERAL.
  void record(Commands& commands, const FrameConstants& frame, const FrameTargets& targets);
  /// Reads the sums back, after the recorded commands are complete. Blocks until the copy is complete.
  FixedSums read() const;

 private:
  const Device& device_;
  bool withDistance_;
  Pipeline mark_, accumulate_;
  FixedSums layout_;
  Buffer sums_;      ///< int64 [channel][pixel of the rectangle]
  Buffer overflow_;  ///< uint
  Buffer reached_;   ///< uint for each tile of the image: whether it is in `tiles_`; all 0 between shares
  Buffer tiles_;     ///< uint: the tiles that the share reaches
  Buffer arguments_; ///< shader::TileArguments
};

}  // namespace freevoxels
