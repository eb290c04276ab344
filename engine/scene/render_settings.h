#pragma once
// The settings of a frame apart from camera and classification.

#include <algorithm>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <variant>

#include "engine/scene/holdout.h"
#include "engine/scene/lighting.h"
#include "engine/scene/ray_clip.h"
#include "engine/scene/table_settings.h"

namespace freevoxels {

enum class Composite : int {
  Normalised = 0,  ///< alpha from the exact optical depth, colour from the order-independent mix
  Additive = 1,    ///< the plain sum: Subr et al. 2007, Eq. 10 and 11
  Sorted = 2,      ///< back-to-front alpha blending without the table, for comparison: Eq. 9
};

/// How a transmittance is read from the attenuation table.
enum class AttenuationLookup : int {
  Bilinear = 0,  ///< interpolated between the four table directions around the direction
  Nearest = 1,   ///< of the nearest table direction, as in the paper
};

/// How a frame is drawn.
enum class Draw : int {
  Gather = 0,  ///< GatherSettings
  Splats = 1,  ///< SplatSettings
};

/// What a ray shows of the scalars on its way in place of a medium: the largest, or the mean of all, to which the transfer function gives a
/// colour and an opacity; neither depends on the order of the scalars.
enum class IntensityProjection : int { None = 0, Maximum = 1, Average = 2 };

/// Samples of the image march through the volume and compute their own transmittance (engine/docs/gather.md).
struct GatherSettings {
  float endTransmittance = 1.0f / 512.0f;  ///< transmittance to the eye at which a ray ends; 0 marches all of it
  /// The roughness up to which rays are interpolated from rays twice as far apart (gather_roughness.comp); 0 marches every ray, as do
  /// parts, cubes and images of voxels smaller than 0.8 pixels.
  float sampleTolerance = 1.0f / 16.0f;
  /// Only of single volumes that are classified after interpolation (Classification::isPost), without lighting, at `lod` 0.
  IntensityProjection projection = IntensityProjection::None;
};

/// Billboards are added in any order, with transmittances of the attenuation table: Subr et al. 2007.
struct SplatSettings {
  Composite composite = Composite::Normalised;
  AttenuationLookup attenuation = AttenuationLookup::Bilinear;
  /// Whether the optical depth to the eye varies across a footprint, to first order, and the composite is also normalised along the
  /// kernel's depth. Otherwise a splat has the optical depth in front of its voxel's centre, as in the paper.
  bool gradient = true;
  bool culling = true;  ///< whether blocks outside of the image are left out; Sorted draws all voxels
  /// Blocks of which the table says that less than this part of their light reaches the eye are left out; 0 leaves out none. Only of
  /// Additive with `culling` (cullRule), and not of parts.
  float cullThreshold = 1.0f / 4096.0f;
};

struct FrameSettings {
  glm::ivec2 size{1024, 1024};
  std::variant<GatherSettings, SplatSettings> method;
  /// Largest edge in pixels of a block of voxels that is drawn as one element; 0 draws voxels only, as Sorted does.
  float lod = 1.0f;
  /// Less than 1 draws a draft of as many pixels: fewer rays (mostSamplesAcrossPixel, sampleTolerance), or larger blocks (blockPixels).
  /// More than 0, and the same for all parts of an image.
  double quality = 1.0;
  bool depth = false;  ///< whether to compute Image::depth
  /// If empty, every voxel sends out its colour without lighting.
  std::optional<Lighting> lighting = std::nullopt;
  /// Light that is scattered any number of times is solved on cells whose edge is so many times doubled, for drafts.
  int scatteringCoarseness = 0;
  /// Whether light may be that of the volume's classification before (Renderer::reclassify), for drafts.
  bool allowsOldLight = false;
  /// If given, rays are marched only there, for drafts of a volume that will be clipped: nothing is made anew for it. Lights that are
  /// evaluated at samples (GatherVolume::lightsSamples) shine past what is clipped, up to optical depths of 32; others have the shadows of
  /// the whole volume. Scattered light is solved with the tolerance of drafts. Only gathered, of a single volume that is on the device as a
  /// whole.
  std::optional<RayClip> clip = std::nullopt;
  /// Where rays end, of the image's size; only gathered. Null if there is none.
  std::shared_ptr<const Holdout> holdout = nullptr;

  /// Samples of the gather along the edge of a pixel; there are 2.4 along the edge of a voxel where that is less. Not of holdouts.
  double mostSamplesAcrossPixel() const { return 2.0 * quality; }
  /// GatherSettings::sampleTolerance, in drafts up to four times as much: more rays show more than exact ones.
  float sampleTolerance() const { return gather().sampleTolerance * float(std::min(1.0 / (quality * quality), 4.0)); }
  /// `lod`; splats, whose time follows their number, have larger blocks in drafts.
  double blockPixels() const { return isSorted() ? 0.0 : gathers() ? double(lod) : double(lod) / quality; }
  bool gathers() const { return std::holds_alternative<GatherSettings>(method); }
  GatherSettings& gather() { return std::get<GatherSettings>(method); }
  const GatherSettings& gather() const { return std::get<GatherSettings>(method); }
  SplatSettings& splats() { return std::get<SplatSettings>(method); }
  const SplatSettings& splats() const { return std::get<SplatSettings>(method); }
  bool isProjected() const { return gathers() && gather().projection != IntensityProjection::None; }
  bool isNormalised() const { return gathers() || splats().composite == Composite::Normalised; }
  bool isSorted() const { return !gathers() && splats().composite == Composite::Sorted; }
  /// How lights are looked up in the table, if they are.
  AttenuationLookup tableLookup() const { return gathers() ? AttenuationLookup::Bilinear : splats().attenuation; }
};

/// Resolves LightAttenuation::Auto for settings with lighting, assuming enough memory.
/// AttenuationLookup::Nearest implies Table, as in the paper.
inline LightAttenuation lightAttenuationFor(const FrameSettings& settings) {
  const Lighting& lighting = *settings.lighting;
  if (lighting.attenuation != LightAttenuation::Auto) return lighting.attenuation;
  return settings.tableLookup() == AttenuationLookup::Nearest ? LightAttenuation::Table : LightAttenuation::Exact;
}

}  // namespace freevoxels
