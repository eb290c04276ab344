#pragma once
// The light that a point of the reference field scatters once towards the eye, with a shadow ray from the
// point to every light: in double precision and without a table. See engine/docs/validation.md.

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "engine/core/stages.h"
#include "engine/reference/reference_field.h"
#include "engine/scene/lighting.h"

namespace freevoxels {

class LightMarch {
 public:
  /// Keeps a reference to the field. Light is scattered towards `eye`, in index space. Ambient light is
  /// marched along `ambientRays` rays, spread evenly over the sphere, from points half a voxel apart wherever
  /// there is extinction, and interpolated trilinearly between them. With an environment there are at least
  /// as many rays; each represents a part of a cube's face, from the centre of the light in that part.
  LightMarch(const ReferenceField& field, const glm::dmat4& indexToWorld, const Lighting& lighting, const RaySource& eye,
             int ambientRays, const Progress& progress = {});

  /// Scattered radiance for albedo 1. `position` is in index space, `toEye` a unit vector in world space.
  glm::dvec3 scattered(glm::dvec3 position, glm::dvec3 toEye) const;

 private:
  static constexpr int kPointsPerVoxel = 2;
  static constexpr int kBrickPoints = kPointsPerVoxel * ReferenceField::kBrickCells + 1;
  /// A direction of ambient light in world space, and its radiance times the part of the sphere that it
  /// represents.
  struct Ray {
    glm::dvec3 direction, light;
  };
  /// The ambient light that reaches the points of a brick, x fastest: one channel for white light, otherwise
  /// one for each colour.
  using Reaching = std::vector<float>;

  glm::dvec3 transmittance(glm::dvec3 position, glm::dvec3 direction, double end) const;
  glm::dvec3 octaves(glm::dvec3 transmittance, double cosine) const;
  glm::dvec3 scatteredFrom(std::size_t light, glm::dvec3 position, glm::dvec3 toEye) const;
  static std::vector<Ray> evenRays(int count);
  static std::vector<Ray> environmentRays(const Lighting& lighting, int count);
  void marchAmbient(std::vector<Ray> rays, const Progress& progress);
  std::unique_ptr<Reaching> marchBrick(glm::ivec3 position, const std::vector<Ray>& rays) const;
  glm::dvec3 reachingFromAll(glm::dvec3 position) const;

  const ReferenceField& field_;
  const glm::dmat3 toWorld_;
  const Lighting lighting_;
  const RaySource eye_;
  std::vector<RaySource> sources_;
  const int channels_;                              ///< 1 for white light, otherwise 3
  std::vector<std::unique_ptr<Reaching>> ambient_;  ///< by brick; null if the field is 0 in it
};

}  // namespace freevoxels
