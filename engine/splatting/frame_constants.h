#pragma once
// What a frame is for the device, whether it gathers or draws splats.

#include <glm/glm.hpp>

#include "engine/lighting/scattering_solver.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/source_rays.h"
#include "engine/scene/table_settings.h"
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
  bool tinted = false;     ///< whether the extinction of light differs between colours, or from that of alpha; only with lighting
  bool lightsReadTable = false;
  double endTransmittance = 0.0;  ///< to the eye, at which a gathered ray ends, however bright the volume; 0: at its end
  DetailRule detail;
  CullRule cull;
  /// Whether the table's levels above the voxels are looked up.
  bool readsLevels() const { return detail.coarsest > 0 || cull.hiddenDepth > 0.0; }
  /// The part of the image that splats can reach, at least one pixel.
  glm::ivec2 coveredFirst{0}, coveredExtent{1};
  double farthest = 0.0;        ///< bound of the distances from the eye plane at which anything is drawn, world units
  double scatteredRadiance =
      0.0;                      ///< no point scatters more of the light of setup.lighting.scattered, for albedo 1; the caller fills it in
  double brightestRay = 0.0;    ///< no pixel has more light that the volume sends out itself
  bool quads = false;           ///< whether a splat may be larger than the device's largest point
  float viewportMargin = 0.0f;  ///< margin of the viewport in pixels, so that points whose centres are outside of the image are not clipped

  bool eyeReadsTable() const { return setup.lookup != shader::kLookupNone; }
  bool readsTable() const { return eyeReadsTable() || lightsReadTable; }
};

FrameConstants makeFrameConstants(const Device& device, const DeviceVolume& volume, const TableSettings& table, const Camera& camera,
                                  const FrameSettings& settings);

/// Sets what the constants say of solved scattered light, after setup.lighting was set otherwise.
void setScattered(FrameConstants& constants, const Lighting& lighting, const ScatteringSolver& solved);

}  // namespace freevoxels
