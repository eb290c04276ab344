#pragma once
// The light that blocks scatter, in double precision: Subr et al. 2007, Section 4.3. Shares no code with the
// shaders.

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/reference/reference_depth.h"
#include "engine/scene/lighting.h"
#include "engine/scene/scattered_field.h"
#include "engine/volume/transfer_table.h"

namespace freevoxels {

/// The squared radius of a ball in squared edges of a cube of equal volume, divided by the 3 of the mean of 1
/// / distance² from its middle.
inline const double kNearestLight2 = std::pow(3.0 / (4.0 * std::numbers::pi), 2.0 / 3.0) / 3.0;

/// The input of reference_depth.h from earlier stages. Keeps references.
struct LightInputs {
  const Volume& volume;
  std::span<const double> extinction;
  const std::vector<std::vector<std::uint8_t>>& table;
  std::span<const LevelData> coarser;
  TableSettings tableSettings;
  std::span<const glm::dvec3> emission = {};
  /// The codes of scalars whose gradients are the normals of surfaces; null: those of extinctions are.
  const TransferTable* scalars = nullptr;
  const ScatteredField* scattered = nullptr;  ///< null without such light
  glm::dvec3 deltaScale{1.0};                 ///< mean factor of the extinction of light, as what is scattered forwards goes on
};

class ReferenceLight {
 public:
  /// For settings with lighting.
  ReferenceLight(const LightInputs& inputs, const FrameSettings& settings);

  /// Radiance towards the eye for albedo 1. `toEye` is in index space, of any length.
  glm::dvec3 scattered(const Block& block, glm::dvec3 toEye) const;

 private:
  glm::dvec3 toLight(const RaySource& source, glm::dvec3 position) const;
  /// A block's transmittance towards a light, averaged over the parts of it that the eye sees. `depth` is
  /// that in front of the middle layer; `counted` is the length of a layer in that depth.
  glm::dvec3 lightReaching(const Block& block, glm::dvec3 toEye, glm::dvec3 direction, double depth, double unsaturated,
                           double counted) const;

  /// The gradient by central differences in index space, per block of its size.
  glm::dvec3 extinctionGradient(const Block& block) const;
  /// The gradient along which a surface's normal is, that of the scalar if there are any.
  glm::dvec3 normalGradient(const Block& block, const glm::dvec3& ofExtinction) const;

  const LightInputs inputs_;
  const Lighting lighting_;
  const glm::dmat3 toWorld_;
  std::vector<RaySource> sources_;
  std::vector<std::unique_ptr<ReferenceDepth>> depths_;  ///< towards each light
};

}  // namespace freevoxels
