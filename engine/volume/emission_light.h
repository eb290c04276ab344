#pragma once
// The light that a volume's own emission sends through it: what lights the smoke around a flame. Emission of many voxels is
// joined to few sources, each of which lights cells of voxels through the extinction between the two, once; there is no
// scattering from cell to cell.

#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

class EmissionLight {
 public:
  /// Dark where nothing is emitted. `classification.emissionLight` is not looked at. Takes time: all voxels are read, and for every
  /// cell with extinction the way to every source is marched.
  EmissionLight(const Volume& volume, const Classification& classification);

  /// The mean over all directions of the radiance that arrives at a position in the world, linear Rec.709; interpolated
  /// between cells.
  glm::dvec3 at(const glm::dvec3& world) const;
  /// The largest component of any cell.
  double brightest() const { return brightest_; }

 private:
  glm::dmat4 worldToCells_{1.0};
  glm::ivec3 cells_{0};
  std::vector<glm::vec3> radiance_;  ///< x fastest
  double brightest_ = 0.0;
};

}  // namespace freevoxels
