#pragma once
// The directions that the attenuation table holds, from the voxel towards the eye or light, index space, and
// the look-up between them.
//
// A set divides the half edge of the cube [-1,1]³ into K cells: the direction of cell c, a point of {-K..K}³
// with max |component| = K, is c / K on the cube's surface.

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace freevoxels {

/// The value is K.
enum class DirectionSet : int {
  Directions26 = 1,  ///< the lattice steps {-1,0,1}³ without 0: Subr et al. 2007, Section 3.1
  Directions98 = 2,  ///< also half-way between these: the lattice steps (2,1,0), (2,1,1), (2,2,1) and alike
};

/// (2K+1)³ - (2K-1)³, the surface of the cube of cells.
constexpr int directionCount(DirectionSet set) {
  return 24 * int(set) * int(set) + 2;
}

/// The set that a table of this many directions holds.
DirectionSet directionSetOf(std::size_t count);

/// Number of a cell among the cells of the whole cube, (2K+1)³ of them, x fastest.
constexpr int cellNumber(DirectionSet set, glm::ivec3 cell) {
  const int k = int(set), edge = 2 * k + 1;
  return cell.x + k + edge * (cell.y + k + edge * (cell.z + k));
}

/// Cells of the whole cube.
constexpr int cellCount(DirectionSet set) {
  return cellNumber(set, glm::ivec3(int(set))) + 1;
}

/// Position of a cell in the table, in ascending order of their numbers. The opposite of i is directionCount
/// - 1 - i.
int directionIndex(DirectionSet set, glm::ivec3 cell);
glm::ivec3 directionCell(DirectionSet set, int index);

/// On the surface of the cube [-1,1]³.
glm::dvec3 directionAt(DirectionSet set, int index);

/// The codes a stored byte can be in (shaders/attenuation_code.glsl has the same two).
enum class AttenuationCode : int {
  Depth8 = 0,   ///< round(255 * sqrt(min(tau, 16) / 16)); keeps ratios of small transmittances
  Linear8 = 1,  ///< round(255 * transmittance); the paper's
};

inline constexpr double kMaximumCodedDepth = 16.0;
/// What Linear8 means by a transmittance of 0, and what depths along rays (source_rays.h) are clamped to.
inline constexpr double kOpaqueDepth = 32.0;

/// World length of the way to the next layer of voxels along a direction on the surface of the cube [-1,1]³
/// (path-length correction on), or the voxel size whatever the direction (the paper's literal product, off).
double stepLength(const glm::dmat4& indexToWorld, glm::dvec3 direction, bool pathLengthCorrection);

/// In double precision.
int encodeOpticalDepth(AttenuationCode code, double opticalDepth);
double decodeOpticalDepth(AttenuationCode code, int byte);

/// The bilinear look-up of a general direction (after Subr et al. 2007, Section 3.3): the four directions of
/// one cube face around it and their weights, which add up to 1.
struct DirectionBlend {
  std::array<int, 4> directions;
  std::array<double, 4> weights;
};
DirectionBlend bilinearDirections(DirectionSet set, glm::dvec3 direction);

/// The paper's look-up: the direction nearest on the face of the cube, that is K direction / max |component|
/// with every component rounded, halves towards 0. (Nearest by angle would move the borders by 4 degrees at
/// most.) Both look-ups need a direction other than 0.
int nearestDirection(DirectionSet set, glm::dvec3 direction);

}  // namespace freevoxels
