#pragma once
// Emission and absorption along a ray through several fields, which attenuate and shadow each other, in double precision: extinctions, and
// the light that is scattered and emitted, add up (Max 1995, for a mixture of media). By small steps, for any number of fields.

#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/stages.h"
#include "engine/reference/ray_march.h"
#include "engine/scene/lighting.h"
#include "engine/scene/scattered_field.h"
#include "engine/volume/scattering_medium.h"

namespace freevoxels {

/// A ray in the world: the points origin + t * direction with t >= 0.
struct WorldRay {
  glm::dvec3 origin, direction;
  double end = std::numeric_limits<double>::infinity();  ///< the largest t that MergedMarch::sum() reads
};

class MergedMarch {
 public:
  /// `step` is the largest distance between points, in voxels of the smallest volume. The volumes must outlive this object.
  MergedMarch(std::span<const PlacedMedium> volumes, const std::optional<Lighting>& lighting, double step, const Progress& progress = {});

  RaySum sum(const WorldRay& ray) const;

 private:
  struct Field {
    ReferenceField field;
    glm::dmat4 toIndex;  ///< from the world
  };
  struct Point;
  Point pointOn(std::size_t field, const WorldRay& ray, double t, std::optional<double>& lastScalar) const;
  glm::dvec3 scatteredAt(glm::dvec3 position, glm::dvec3 toEye) const;
  glm::dvec3 transmittance(const WorldRay& ray, double end) const;

  std::vector<Field> fields_;
  std::optional<Lighting> lighting_;
  double stepLength_;  ///< world units
  glm::dvec3 deltaScale_{1.0};
  std::optional<ScatteredField> scattered_;
  glm::dmat4 worldToCells_{1.0};
};

}  // namespace freevoxels
