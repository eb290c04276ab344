#pragma once
// The light that a point of the reference field scatters towards the eye: of lights with a shadow ray from the point to each, and of what
// was scattered before; in double precision and without a table. See engine/docs/validation.md.

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/core/stages.h"
#include "engine/reference/reference_field.h"
#include "engine/scene/lighting.h"
#include "engine/scene/scattered_field.h"

namespace freevoxels {

class LightMarch {
 public:
  /// `field` is that of the volume, and must outlive this object. The light of further orders, of the surroundings and of emission is
  /// found on cells (reference_scattering.h).
  LightMarch(const ReferenceField& field, const Volume& volume, const Classification& classification, const Lighting& lighting,
             const Progress& progress = {});

  /// Scattered radiance for albedo 1. `position` is in index space, `toEye` a unit vector in world space.
  glm::dvec3 scattered(glm::dvec3 position, glm::dvec3 toEye) const;
  /// Factor of the extinction of light by colour, as what is scattered forwards goes on (splitPhase).
  const glm::dvec3& deltaScale() const { return deltaScale_; }

 private:
  glm::dvec3 transmittance(glm::dvec3 position, glm::dvec3 direction, double end) const;
  glm::dvec3 scatteredFrom(std::size_t light, glm::dvec3 position, glm::dvec3 toEye) const;

  const ReferenceField& field_;
  const glm::dmat3 toWorld_;
  const Lighting lighting_;
  std::vector<RaySource> sources_;
  glm::dvec3 deltaScale_{1.0};
  std::optional<ScatteredField> scattered_;
};

}  // namespace freevoxels
