#pragma once
// What a point of the reference field scatters towards the eye, once, of the light that reaches it along a
// ray of its own: in double precision, and without a table. README.md, section "How we know it is right".

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "engine/core/stages.h"
#include "engine/lighting/lighting.h"
#include "engine/reference/reference_field.h"

namespace freevoxels {

class LightMarch {
 public:
  /// Keeps a reference to the field. What reaches a point of ambient light is marched for along `ambientRays`
  /// rays, evenly over the sphere, from points half a voxel apart wherever there is extinction, and
  /// interpolated trilinearly between them.
  LightMarch(const ReferenceField& field, const glm::dmat4& indexToWorld, const Lighting& lighting,
             int ambientRays, const Progress& progress = {});

  /// Radiance per albedo. `position` in index space, `toEye` in the world, of length 1.
  glm::dvec3 scattered(glm::dvec3 position, glm::dvec3 toEye) const;

 private:
  static constexpr int kPointsPerVoxel = 2;
  static constexpr int kBrickPoints = kPointsPerVoxel * ReferenceField::kBrickCells + 1;
  /// The part of ambient light that reaches the points of a brick, x fastest.
  using Reaching = std::array<float, std::size_t(kBrickPoints* kBrickPoints) * kBrickPoints>;

  double transmittance(glm::dvec3 position, glm::dvec3 direction, double end) const;
  glm::dvec3 scatteredFrom(std::size_t light, glm::dvec3 position, glm::dvec3 toEye) const;
  void marchAmbient(int rays, const Progress& progress);
  std::unique_ptr<Reaching> marchBrick(glm::ivec3 position, const std::vector<glm::dvec3>& directions) const;
  double reachingFromAll(glm::dvec3 position) const;

  const ReferenceField& field_;
  const glm::dmat3 toWorld_;
  const Lighting lighting_;
  std::vector<RaySource> sources_;
  std::vector<std::unique_ptr<Reaching>> ambient_;  ///< by brick; null where the field is 0
};

}  // namespace freevoxels
