#pragma once
// The lights of a frame on the device: Subr et al. 2007, Section 4.3.

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "engine/attenuation/eye_depths.h"
#include "engine/attenuation/ray_sweep.h"
#include "engine/core/stages.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/lighting.h"
#include "engine/scene/render_settings.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

/// Bytes of device memory for the rays of lights.
struct RayMemory {
  std::uint64_t bytes = 0, largest = 0;  ///< of all lights together, and of the light that needs most
};
/// What the lights take if their attenuation is Exact.
RayMemory lightRayMemory(const DeviceVolume& volume, const Lighting& lighting);

/// Whether lights are at the same places, whatever their colours, so that what is between them and the volume is the same.
bool standAlike(std::span<const Light> some, std::span<const Light> others);

/// The lights of one volume. What is computed for a light is kept until it moves, or the medium changes.
class LightPass {
 public:
  explicit LightPass(const Device& device) : device_(device), beyond_(device) {}

  /// Prepares the lights of a frame whose attenuation is not Auto, without its scattered light. With `scalars`, rays are swept through the
  /// volume's scalars, otherwise through its classified voxels; they pass over what is far from `cells`, where that is given. Blocks
  /// until the device is done and adds the times to `times`; no frame may be in progress. An exception of `progress` abandons the work.
  /// Rays are swept again where lights have moved, and after outdate() unless the settings allow old light.
  shader::FrameLighting prepare(const DeviceVolume& volume, const TableSettings& table, const FrameSettings& settings, bool scalars,
                                const OccupiedCells* cells, std::vector<StageTime>& times, const Progress& progress);
  /// shader::Light of each light of the last frame.
  const Buffer& lights() const { return placed_->lights; }
  /// The rays of a light of the last frame, with LightAttenuation::Exact.
  const RaySweep& rays(int light) const { return placed_->rays[std::size_t(light)]; }
  /// Says that the medium has changed.
  void outdate() { isOld_ = true; }
  /// Another number whenever rays have been swept or depths found again.
  std::uint64_t version() const { return version_; }

 private:
  /// What is made for the lights of a frame.
  struct Placed {
    Lighting lighting;
    bool scalars;
    std::vector<shader::Light> onDevice = {};
    Buffer lights = {};              ///< `onDevice`
    Buffer beyondDepths = {};        ///< kEyeDepthsBytes for each light inside the volume
    std::deque<RaySweep> rays = {};  ///< rays of the lights; empty if they are looked up in the table
  };
  Placed place(const DeviceVolume& volume, DirectionSet set, const Lighting& lighting, bool scalars, const OccupiedCells* cells,
               std::vector<StageTime>& times, const Progress& progress);
  void setBeyond(Commands& commands, const DeviceVolume& volume, DirectionSet set, Placed& placed);
  void setRays(Commands& commands, const DeviceVolume& volume, const OccupiedCells* cells, Placed& placed) const;

  const Device& device_;
  EyeDepthsPass beyond_;
  std::optional<Placed> placed_;
  bool isOld_ = false;  ///< whether rays were swept before the medium changed
  std::uint64_t version_ = 0;
};

}  // namespace freevoxels
