#pragma once
// Light that was scattered before, comes from the surroundings or is emitted, on cells of a volume.

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// Values at the centres of cubic cells of `edge` voxels, of which the first begins at voxel (0,0,0); x fastest.
struct ScatteredField {
  glm::ivec3 cells{0};
  int edge = 1;
  double share = 1.0;            ///< of this light that is scattered out of its direction (PhaseSplit)
  double flux = 0.0;             ///< 3 g of the rest of the phase function
  std::vector<glm::dvec3> mean;  ///< J: mean radiance over all directions, linear Rec.709
  std::vector<std::array<glm::dvec3, 3>> fluxes =
      {};  ///< mean over all directions of radiance times direction, in world space; may be empty

  /// The radiance that a point scatters towards the eye for albedo 1, interpolated trilinearly and constant beyond the outermost centres.
  /// `voxel` is in index space, `toEye` a unit vector in world space.
  glm::dvec3 at(glm::dvec3 voxel, glm::dvec3 toEye) const;
  /// No value of at() has a larger component.
  double brightest() const;
};

/// How such light was found by iteration (engine/lighting/scattering_solver.h).
struct ScatteringFacts {
  glm::ivec3 cells{0};
  int edge = 1;           ///< of a cell, voxels
  int sets = 0;           ///< of 26 sweeps on the cells
  double work = 0.0;      ///< the same with those on coarser cells, in sets on the cells
  double residual = 0.0;  ///< where iterations ended, relative to the light that is scattered once more
};

}  // namespace freevoxels
