#pragma once
// The directions of the attenuation table, in index space from the voxel towards the eye or light, and the
// look-up between them.
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
  /// Also the directions half-way between these: the lattice steps (2,1,0), (2,1,1), (2,2,1) and their
  /// permutations and signs.
  Directions98 = 2,
};

/// Number of directions: (2K+1)³ - (2K-1)³ cells on the surface of the cube.
constexpr int directionCount(DirectionSet set) {
  return 24 * int(set) * int(set) + 2;
}

/// The set that has `count` directions.
DirectionSet directionSetOf(std::size_t count);

/// Index of a cell among all (2K+1)³ cells of the cube, x fastest.
constexpr int cellNumber(DirectionSet set, glm::ivec3 cell) {
  const int k = int(set), edge = 2 * k + 1;
  return cell.x + k + edge * (cell.y + k + edge * (cell.z + k));
}

/// Number of cells of the whole cube.
constexpr int cellCount(DirectionSet set) {
  return cellNumber(set, glm::ivec3(int(set))) + 1;
}

/// Index of a cell's direction in the table, in ascending order of cell numbers. The direction opposite to i
/// is directionCount - 1 - i.
int directionIndex(DirectionSet set, glm::ivec3 cell);
glm::ivec3 directionCell(DirectionSet set, int index);

/// The direction as a point on the surface of the cube [-1,1]³.
glm::dvec3 directionAt(DirectionSet set, int index);

/// The encodings of a byte of the table (also in shaders/attenuation_code.glsl).
enum class AttenuationCode : int {
  Depth8 = 0,   ///< round(255 * sqrt(min(tau, 16) / 16)); keeps ratios of small transmittances
  Linear8 = 1,  ///< round(255 * transmittance); the paper's
};

inline constexpr double kMaxCodedDepth = 16.0;
/// The optical depth that Linear8 decodes from a transmittance of 0, and that depths along rays
/// (source_rays.h) are clamped to.
inline constexpr double kOpaqueDepth = 32.0;

/// World length of the path to the next layer of voxels along a direction on the surface of the cube [-1,1]³
/// (path-length correction on), or the voxel size for every direction (off, the paper's literal product).
double stepLength(const glm::dmat4& indexToWorld, glm::dvec3 direction, bool pathLengthCorrection);

/// Encodes and decodes an optical depth, in double precision.
int encodeOpticalDepth(AttenuationCode code, double opticalDepth);
double decodeOpticalDepth(AttenuationCode code, int byte);

/// The bilinear look-up of a general direction (after Subr et al. 2007, Section 3.3): the four directions
/// around it on one face of the cube, and their weights, which add up to 1.
struct DirectionBlend {
  std::array<int, 4> directions;
  std::array<double, 4> weights;
};
DirectionBlend bilinearDirections(DirectionSet set, glm::dvec3 direction);

/// The paper's look-up: the nearest direction on the face of the cube, K direction / max |component| with
/// every component rounded, halves towards 0. (Nearest by angle would move the borders by at most 4 degrees.)
/// Both look-ups need a direction other than 0.
int nearestDirection(DirectionSet set, glm::dvec3 direction);

}  // namespace freevoxels
