#pragma once
// The lights of a frame on the device: Subr et al. 2007, Section 4.3.

#include <deque>
#include <optional>
#include <vector>

#include "engine/attenuation/eye_depths.h"
#include "engine/attenuation/ray_sweep.h"
#include "engine/core/stages.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/lighting.h"
#include "engine/scene/render_settings.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

/// Of one volume. What is made for a light is kept as long as the light stays as it is.
class LightPass {
 public:
  explicit LightPass(const Device& device) : device_(device), beyond_(device) {}

  /// Table or Exact, of settings that have lighting. Auto is lightAttenuationFor, but Table where rays would
  /// take more than a quarter of the device's memory, or more than `others` bytes leave of it: whatever is
  /// allocated now, so that it is the same for every frame.
  LightAttenuation resolve(const DeviceVolume& volume, const FrameSettings& settings,
                           std::uint64_t others) const;
  /// On the device, of lighting that is not Auto.
  static std::uint64_t rayBytes(const DeviceVolume& volume, const Lighting& lighting);
  /// Of settings whose lighting is not Auto; the rays of lights are of the volume's `scalars`, or of its classified voxels. Waits for what it has to make; no frame may be under way. Adds
  /// the times of that to `times`.
  shader::FrameLighting prepare(const DeviceVolume& volume, const TableSettings& table,
                                const FrameSettings& settings, bool scalars, std::vector<StageTime>& times,
                                const Progress& progress);
  /// shader::Light, of the last frame.
  const Buffer& lights() const { return lights_; }

 private:
  std::vector<shader::Light> place(Commands& commands, const DeviceVolume& volume, DirectionSet set,
                                   const Lighting& lighting, bool scalars);
  void setBeyond(Commands& commands, const DeviceVolume& volume, DirectionSet set, const Lighting& lighting,
                 std::vector<shader::Light>& lights);
  void setRays(Commands& commands, const DeviceVolume& volume, const Lighting& lighting, bool scalars,
               std::vector<shader::Light>& lights);

  const Device& device_;
  EyeDepthsPass beyond_;
  bool placedScalars_ = false;
  std::optional<Lighting> placed_;   ///< whose light the buffers and `fromAll_` are of
  std::vector<glm::dvec4> fromAll_;  ///< directionLight, and directionShares
  Buffer lights_;                    ///< shader::Light
  Buffer beyondDepths_;              ///< kEyeDepthsBytes a light that is inside of the volume
  std::deque<RaySweep> rays_;        ///< of the lights; empty where they are looked up in the table
};

}  // namespace freevoxels
