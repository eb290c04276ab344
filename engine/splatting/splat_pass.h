#pragma once
// From voxels and blocks to the sums of a frame: set-up and blended drawing of splats. Subr et al. 2007,
// Section 3.3 and 4.1.

#include <array>
#include <functional>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/attenuation/eye_depths.h"
#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/frame_targets.h"
#include "engine/visibility/cull_rule.h"
#include "engine/visibility/detail_rule.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

/// The frame's constants, computed in double precision on the host.
struct FrameConstants {
  shader::SetupFrame setup;
  shader::SplatPush splat;
  shader::ResolvePush resolve;
  RaySource eye;
  bool eyeInside = false;  ///< whether the eye is inside the volume's box
  bool lit = false;        ///< whether there is lighting; the caller fills in setup.lighting
  bool tinted = false;     ///< only with lighting
  bool lightsReadTable = false;
  double endTransmittance = 0.0;  ///< to the eye, at which a gathered ray ends, however bright the volume; 0: at its end
  DetailRule detail;
  CullRule cull;
  /// Whether the table's levels above the voxels are looked up.
  bool readsLevels() const { return detail.coarsest > 0 || cull.hiddenDepth > 0.0; }
  /// The part of the image that splats can reach, at least one pixel.
  glm::ivec2 coveredFirst{0}, coveredExtent{1};
  double farthest = 0.0;     ///< bound of the distances from the eye plane at which anything is drawn, world units
  double brightestRay = 0.0; ///< no pixel has more light that the volume sends out itself
  bool quads = false;  ///< whether a splat may be larger than the device's largest point
  float viewportMargin =
      0.0f;  ///< margin of the viewport in pixels, so that points whose centres are outside of the image are not clipped

  bool eyeReadsTable() const { return setup.lookup != shader::kLookupNone; }
  bool readsTable() const { return eyeReadsTable() || lightsReadTable; }
};

FrameConstants makeFrameConstants(const Device& device, const DeviceVolume& volume,
                                  const TableSettings& table, const Camera& camera,
                                  const FrameSettings& settings);

/// COMPUTE eye_depths.comp if the table is looked up from inside; then COMPUTE splat_setup.comp and GRAPHICS splat.vert + splat.frag,
/// chunk by chunk. Leaves the targets in layout GENERAL, visible to compute.
class SplatPass {
 public:
  /// All frames must be of the same volume.
  SplatPass(const Device& device, bool withDistance, bool sorted = false);

  struct Inputs {
    const DeviceVolume& volume;
    const AttenuationTable* table;                 ///< null if FrameConstants::readsTable is false
    const BlockList* visible;                  ///< the blocks to draw, by FrameConstants::detail
    std::uint32_t firstChunk = 0, chunkCount = 0;  ///< the chunks of `visible` to draw
    bool continued = false;  ///< whether the targets, in layout GENERAL, hold the sums of earlier splats
    bool sameFrame = false;  ///< whether the pass has the constants of `frame` from the call before
    const Buffer* lights = nullptr;  ///< shader::Light of each light; only with lighting
    const Buffer* order = nullptr;   ///< the occupied voxels in the order to draw them; null for the order of the list
    /// Called where a chunk's splats are set up, with their buffer of shader::Splat and the chunk; may be empty.
    std::function<void(const Buffer& splats, std::uint32_t chunk)> onSplats;
  };
  void record(Commands& commands, const Inputs& inputs, const FrameConstants& frame, const FrameTargets& targets);
  /// Whether the pass is made for such frames.
  bool draws(const FrameSettings& settings) const { return withDistance_ == settings.depth && sorted_ == settings.isSorted(); }

 private:
  void recordFrame(Commands& commands, const DeviceVolume& volume, const FrameConstants& frame);
  void beginRendering(Commands& commands, const FrameTargets& targets, const FrameConstants& frame, VkAttachmentLoadOp load) const;

  const Device& device_;
  bool withDistance_, sorted_;
  /// Pipelines for frames without lighting, with lighting, and with tinted lighting, each made when it is
  /// first needed.
  std::array<Pipeline, 3> setups_;
  Pipeline points_, quads_;
  EyeDepthsPass eyeDepthsPass_;
  Buffer frame_;      ///< shader::SetupFrame
  Buffer eyeDepths_;  ///< output of EyeDepthsPass
  Buffer splats_;     ///< shader::Splat for each splat of a chunk
};

}  // namespace freevoxels
