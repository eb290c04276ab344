#pragma once
// The light of a volume's own emission on its medium, such as the smoke around a flame. The emission of all
// voxels is joined to few sources. Each lights a grid of cells through the extinction between source and
// cell. Cells do not light each other.

#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

class EmissionLight {
 public:
  /// Computes the light of all cells; 0 if nothing is emitted. `classification.emissionLight` is ignored.
  /// This is slow: it reads all voxels and marches from every cell with extinction to every source.
  EmissionLight(const Volume& volume, const Classification& classification);

  /// The radiance that arrives at a position in world space, averaged over all directions, linear Rec.709,
  /// interpolated between cells.
  glm::dvec3 at(const glm::dvec3& world) const;
  /// The largest component of the radiance of any cell.
  double brightest() const { return brightest_; }

 private:
  glm::dmat4 worldToCells_{1.0};
  glm::ivec3 cells_{0};
  std::vector<glm::vec3> radiance_;  ///< x fastest
  double brightest_ = 0.0;
};

}  // namespace freevoxels
