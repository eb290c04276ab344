#pragma once
// What a render does with a volume and a camera, apart from the classification.

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
  Sorted = 2,      ///< back to front alpha blending, without the table, to compare with: Eq. 9
};

enum class AttenuationLookup : int {
  Bilinear = 0,  ///< of the four directions of the table around the viewing direction
  Nearest = 1,   ///< the paper's
  Exact = 2,     ///< not from the table: along rays from the eye (source_rays.h), once a frame
  Auto = 3,      ///< Exact of an eye inside the volume, Bilinear far away, a mix between: rayShare; Exact of
                 ///< a volume that shines: lookupFor
};

enum class Draw : int {
  Auto = 0,    ///< Gather where it can draw the frame: drawsByGathering
  Gather = 1,  ///< samples of the image march through the volume, with the transmittance of their own rays
  Splats = 2,  ///< billboards, added in any order: the paper's
};

struct FrameSettings {
  glm::ivec2 size{1024, 1024};
  Draw draw = Draw::Splats;  ///< the front ends begin with Auto
  Composite composite = Composite::Normalised;
  AttenuationLookup attenuation = AttenuationLookup::Auto;
  /// Whether the optical depth to the eye varies across a footprint, to first order, and normalised along the
  /// kernel's depth as well, or is that in front of the voxel's centre, as in the paper.
  bool gradient = true;
  /// Pixels that the edge of a block of voxels may be long to be drawn as one splat; 0: voxels only. Sorted
  /// pictures are of voxels, whatever this is.
  float lod = 1.0f;
  /// Whether what is outside of the image, and what is hidden, is left out. Sorted pictures are of all
  /// voxels, whatever this is.
  bool culling = true;
  float cullThreshold =
      1.0f / 512.0f;  ///< transmittance to the eye below which a voxel is hidden; 0: none is
  /// Of the device's memory that rays may take. Where they need more, Exact fails, and Auto is Bilinear.
  std::uint64_t mostRayBytes = std::numeric_limits<std::uint64_t>::max();
  bool depth = false;  ///< also make Image::depth
  /// None: every voxel sends out its colour, whatever is around it. The table is looked up for lights
  /// bilinearly, or as AttenuationLookup::Nearest says.
  std::optional<Lighting> lighting = std::nullopt;
};

/// The gather computes transmittance along its own rays, so it draws no frame that the table or an order decides.
inline bool canGather(const FrameSettings& settings) {
  return settings.composite != Composite::Sorted &&
         (settings.attenuation == AttenuationLookup::Exact || settings.attenuation == AttenuationLookup::Auto);
}
inline bool drawsByGathering(const FrameSettings& settings) {
  return settings.draw != Draw::Splats && canGather(settings);
}

/// Of settings that have lighting: what Auto is of them where memory is plenty. Who looks up the paper's way
/// gets the paper's shadows.
inline LightAttenuation lightAttenuationFor(const FrameSettings& settings) {
  const Lighting& lighting = *settings.lighting;
  if (lighting.attenuation != LightAttenuation::Auto) return lighting.attenuation;
  const bool isPaper = settings.attenuation == AttenuationLookup::Nearest;
  return isPaper ? LightAttenuation::Table : LightAttenuation::Exact;
}

}  // namespace freevoxels
