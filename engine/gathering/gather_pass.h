#pragma once
// A frame by gathering: samples of a lattice on the image march the slices of blocks across their major axis, a
// stencil restores the round footprint of splats, and the sums are upsampled to the pixels. The transmittance to the
// eye is that of each sample's own ray: Subr et al. 2007, Section 2.1, Eq. 4, without an attenuation table.

#include "engine/gathering/gather_volume.h"
#include "engine/splatting/splat_pass.h"

namespace freevoxels {

/// The lattice and the rays of a frame, computed in double precision on the host. The levels are the caller's to fill.
/// Rays end at the transmittance `end`.
shader::GatherFrame makeGatherFrame(const DeviceVolume& volume, const Camera& camera, const FrameSettings& settings,
                                    const DetailRule& detail, double end);

/// Whether some ray of the lattice may march along this axis.
bool someRayHasAxis(const shader::GatherFrame& frame, int axis);

/// COMPUTE gather.comp, gather_stencil.comp and gather_upsample.comp: premultiplied RGBA in `targets.colorEnergy` and the
/// mean distance in `targets.distance`, if that exists. Leaves the targets in layout GENERAL, visible to transfer.
class GatherPass {
 public:
  explicit GatherPass(const Device& device);
  void record(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame,
              const SplatTargets& targets);

 private:
  void recordGather(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame);
  void recordImage(Commands& commands, const shader::GatherFrame& frame, bool scalars, const SplatTargets& targets);

  /// C and E (four floats), and the sum of e times distance, of samples.
  struct Sums {
    Buffer colorEnergy, distances;
    TexelView colorEnergyTexels, distanceTexels;
  };
  void makeRoom(Sums& sums, std::uint64_t samples);

  const Device& device_;
  Buffer frame_;  ///< shader::GatherFrame
  Sums gathered_, smoothed_, rows_;
};

}  // namespace freevoxels
