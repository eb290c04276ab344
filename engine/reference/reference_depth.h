#pragma once
// Optical depth between voxels and the eye as the attenuation table tells it, in double precision:
// Subr et al. 2007, Section 3.3, and its gradient across the lines of sight.

#include <cstdint>
#include <vector>

#include "engine/attenuation/table_settings.h"
#include "engine/splatting/render_settings.h"
#include "engine/volume/volume.h"

namespace freevoxels {

class ReferenceDepth {
 public:
  /// `table` holds bytes [direction][voxel]. Keeps references.
  ReferenceDepth(const Volume& volume, const std::vector<std::vector<std::uint8_t>>& table,
                 const TableSettings& settings, AttenuationLookup lookup);

  /// -log of the mean of the four transmittances around `toEye` (index space, any length), or the nearest
  /// one's. With path-length correction a stored depth is scaled by the world length of a lattice layer in
  /// the viewing direction over that in the stored one.
  double towards(glm::ivec3 voxel, glm::dvec3 toEye) const;

  /// How the depth changes per voxel in index space: in the plane of the lattice layer by differences to the
  /// neighbours, each with its own line of sight, one-sided at the volume's faces; along the line of sight it
  /// falls by `layerDepth` per layer. `toEye` is called with voxels.
  template <typename ToEye>
  glm::dvec3 gradient(glm::ivec3 voxel, double layerDepth, const ToEye& toEye) const;

 private:
  const Volume& volume_;
  const std::vector<std::vector<std::uint8_t>>& table_;
  const TableSettings settings_;
  const AttenuationLookup lookup_;
};

/// The direction divided by its largest component, as long as a lattice layer; and the axis of that
/// component, the first of several.
glm::dvec3 acrossLayer(glm::dvec3 direction);
int majorAxis(glm::dvec3 direction);

template <typename ToEye>
glm::dvec3 ReferenceDepth::gradient(glm::ivec3 voxel, double layerDepth, const ToEye& toEye) const {
  const glm::dvec3 direction = acrossLayer(toEye(voxel));
  const int major = majorAxis(direction);
  glm::dvec3 gradient(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 before = voxel, after = voxel;
    before[axis] = glm::max(voxel[axis] - 1, 0);
    after[axis] = glm::min(voxel[axis] + 1, volume_.dimensions[axis] - 1);
    if (axis == major || before == after) continue;
    gradient[axis] =
        (towards(after, toEye(after)) - towards(before, toEye(before))) / (after[axis] - before[axis]);
  }
  gradient[major] = -(layerDepth + glm::dot(gradient, direction)) / direction[major];
  return gradient;
}

}  // namespace freevoxels
