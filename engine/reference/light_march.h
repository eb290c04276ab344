#pragma once
// What a point of the reference field scatters towards the eye, once, of the light that reaches it along a
// ray of its own: in double precision, and without a table. engine/docs/validation.md.

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "engine/core/stages.h"
#include "engine/reference/reference_field.h"
#include "engine/scene/lighting.h"

namespace freevoxels {

class LightMarch {
 public:
  /// Keeps a reference to the field; `eye` is where the light is scattered to, in index space. What reaches a point of ambient light is marched for along `ambientRays`
  /// rays, evenly over the sphere, from points half a voxel apart wherever there is extinction, and
  /// interpolated trilinearly between them. With an environment there are at least as many rays, each of
  /// which brings what comes from a part of a cube's face, from the middle of that light.
  LightMarch(const ReferenceField& field, const glm::dmat4& indexToWorld, const Lighting& lighting, const RaySource& eye,
             int ambientRays, const Progress& progress = {});

  /// Radiance per albedo. `position` in index space, `toEye` in the world, of length 1.
  glm::dvec3 scattered(glm::dvec3 position, glm::dvec3 toEye) const;

 private:
  static constexpr int kPointsPerVoxel = 2;
  static constexpr int kBrickPoints = kPointsPerVoxel * ReferenceField::kBrickCells + 1;
  /// Of what comes from everywhere: towards it in the world, and radiance times its part of the sphere.
  struct Ray {
    glm::dvec3 direction, light;
  };
  /// What reaches the points of a brick, x fastest, of white light or by channel.
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
  const int channels_;                              ///< that reach differently: 1 of white light alone
  std::vector<std::unique_ptr<Reaching>> ambient_;  ///< by brick; null where the field is 0
};

}  // namespace freevoxels
