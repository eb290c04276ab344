#pragma once
// Visible voxels to the sums of a frame: set-up and additive draw. Subr et al. 2007, Section 3.3 and 4.1.

#include <array>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/splatting/camera.h"
#include "engine/splatting/render_settings.h"
#include "engine/splatting/visible_voxels.h"
#include "engine/volume/device_volume.h"
#include "shaders/interface.h"

namespace freevoxels {

/// The sums of a frame: C and E, T, and where depth is asked for, the sum of e times distance.
struct SplatTargets {
  RenderTarget colorEnergy;   ///< RGBA32F
  RenderTarget opticalDepth;  ///< R32F
  RenderTarget distance;      ///< R32F, or does not exist
  std::vector<const RenderTarget*> all() const;
};

SplatTargets makeTargets(const Device& device, const FrameSettings& settings);

/// The frame's constants, computed in double precision on the host.
struct FrameConstants {
  shader::SetupFrame setup;
  shader::SplatPush splat;
  shader::ResolvePush resolve;
  bool quads = false;  ///< some splat may be larger than the device's largest point
  float viewportMargin =
      0.0f;  ///< pixels around the image, so that points centred outside it are not clipped
};

FrameConstants makeFrameConstants(const Device& device, const DeviceVolume& volume,
                                  const TableSettings& table, const Camera& camera,
                                  const FrameSettings& settings);

/// COMPUTE splat_setup.comp and GRAPHICS splat.vert + splat.frag, chunk by chunk. Leaves the targets in
/// layout GENERAL, visible to compute.
class SplatPass {
 public:
  SplatPass(const Device& device, bool withDistance);

  struct Inputs {
    const DeviceVolume& volume;
    const AttenuationTable& table;
    const VisibleVoxels& visible;
  };
  void record(Commands& commands, const Inputs& inputs, const FrameConstants& frame,
              const SplatTargets& targets);
  bool withDistance() const { return withDistance_; }

 private:
  void beginRendering(Commands& commands, const SplatTargets& targets, const FrameConstants& frame,
                      VkAttachmentLoadOp load) const;

  const Device& device_;
  bool withDistance_;
  Pipeline setup_, points_, quads_;
  Buffer frame_;   ///< shader::SetupFrame
  Buffer splats_;  ///< shader::Splat of one chunk
};

}  // namespace freevoxels
