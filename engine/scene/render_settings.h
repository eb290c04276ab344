#pragma once
// The settings of a frame apart from camera and classification.

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "engine/scene/lighting.h"
#include "engine/scene/table_settings.h"

namespace freevoxels {

enum class Composite : int {
  Normalised = 0,  ///< alpha from the exact optical depth, colour from the order-independent mix
  Additive = 1,    ///< the plain sum: Subr et al. 2007, Eq. 10 and 11
  Sorted = 2,      ///< back-to-front alpha blending without the table, for comparison: Eq. 9
};

enum class AttenuationLookup : int {
  Bilinear = 0,  ///< interpolated between the four table directions around the viewing direction
  Nearest = 1,   ///< the nearest table direction, as in the paper
  Exact = 2,     ///< not from the table, but along rays from the eye (source_rays.h), computed once a frame
  /// Exact if the eye is inside the volume or the volume has emission, Bilinear if the eye is far away, else
  /// a mix: rayShare, lookupFor.
  Auto = 3,
};

enum class Draw : int {
  Auto = 0,    ///< Gather if it can draw the frame (drawsByGathering), else Splats
  Gather = 1,  ///< samples of the image march through the volume and compute their own transmittance
  Splats = 2,  ///< billboards that are added in any order, as in the paper
};

struct FrameSettings {
  glm::ivec2 size{1024, 1024};
  Draw draw = Draw::Splats;  ///< the front ends use Auto by default
  Composite composite = Composite::Normalised;
  AttenuationLookup attenuation = AttenuationLookup::Auto;
  /// Whether the optical depth to the eye varies across a footprint, to first order, and the composite is
  /// also normalised along the kernel's depth. Otherwise a splat has the optical depth in front of its
  /// voxel's centre, as in the paper.
  bool gradient = true;
  /// Largest edge in pixels of a block of voxels that is drawn as one splat; 0 draws voxels only. Ignored by
  /// Sorted, which draws voxels.
  float lod = 1.0f;
  /// Whether blocks outside of the image and hidden blocks are left out. Ignored by Sorted, which draws all
  /// voxels.
  bool culling = true;
  float cullThreshold =
      1.0f / 512.0f;  ///< transmittance to the eye below which a voxel is hidden; 0 disables the test
  /// Bytes of device memory that the depths along rays may take. If they need more, Exact fails and Auto uses
  /// Bilinear.
  std::uint64_t mostRayBytes = std::numeric_limits<std::uint64_t>::max();
  bool depth = false;  ///< whether to compute Image::depth
  /// With the gather: the roughness up to which rays are interpolated from rays twice as far apart (gather_roughness.comp); 0 marches
  /// every ray, as do parts, cubes and images of voxels smaller than 0.8 pixels.
  float sampleTolerance = 1.0f / 16.0f;
  /// If empty, every voxel sends out its colour without lighting. Lights are looked up in the table
  /// bilinearly, or by the nearest direction with AttenuationLookup::Nearest.
  std::optional<Lighting> lighting = std::nullopt;
};

/// Whether the gather can draw the frame. It computes transmittance along its own rays, so it supports no
/// look-up in the table and no Sorted composite.
inline bool canGather(const FrameSettings& settings) {
  return settings.composite != Composite::Sorted &&
         (settings.attenuation == AttenuationLookup::Exact || settings.attenuation == AttenuationLookup::Auto);
}
inline bool drawsByGathering(const FrameSettings& settings) {
  return settings.draw != Draw::Splats && canGather(settings);
}

/// Resolves LightAttenuation::Auto for settings with lighting, assuming enough memory.
/// AttenuationLookup::Nearest implies Table, as in the paper.
inline LightAttenuation lightAttenuationFor(const FrameSettings& settings) {
  const Lighting& lighting = *settings.lighting;
  if (lighting.attenuation != LightAttenuation::Auto) return lighting.attenuation;
  const bool isPaper = settings.attenuation == AttenuationLookup::Nearest;
  return isPaper ? LightAttenuation::Table : LightAttenuation::Exact;
}

}  // namespace freevoxels
