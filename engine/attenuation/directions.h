#pragma once
// The 26 lattice directions (design: {-1,0,1}³ without 0), from the voxel towards the eye or light, index
// space.

#include <array>
#include <glm/glm.hpp>

namespace freevoxels {

inline constexpr int kDirectionCount = 26;

/// Position of a direction in the table: x fastest, (0,0,0) left out. The opposite of i is 25 - i.
constexpr int directionIndex(int x, int y, int z) {
  const int cell = (x + 1) + 3 * (y + 1) + 9 * (z + 1);
  return cell < 13 ? cell : cell - 1;
}

constexpr glm::ivec3 directionAt(int index) {
  const int cell = index < 13 ? index : index + 1;
  return {cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
}

/// The codes a stored byte can be in (shaders/attenuation_code.glsl has the same two).
enum class AttenuationCode : int {
  Depth8 = 0,   ///< round(255 * sqrt(min(tau, 16) / 16)); keeps ratios of small transmittances
  Linear8 = 1,  ///< round(255 * transmittance); the paper's
};

inline constexpr double kMaximumCodedDepth = 16.0;
/// What Linear8 means by a transmittance of 0.
inline constexpr double kOpaqueDepth = 32.0;

/// World length of a lattice step (path-length correction on), or the voxel size for every step (the paper's
/// literal product, off).
double stepLength(const glm::dmat4& indexToWorld, glm::ivec3 direction, bool pathLengthCorrection);

/// In double precision.
int encodeOpticalDepth(AttenuationCode code, double opticalDepth);
double decodeOpticalDepth(AttenuationCode code, int byte);

/// The bilinear look-up of a general direction (Section 5 of the design, after Subr et al. 2007,
/// Section 3.3): four lattice directions of one cube face and their weights, which add up to 1.
struct DirectionBlend {
  std::array<int, 4> directions;
  std::array<double, 4> weights;
};
DirectionBlend bilinearDirections(glm::dvec3 direction);

/// The paper's look-up: the lattice direction nearest on the face of the cube, that is direction / max
/// |component| with every component rounded to {-1,0,1}, halves towards 0. (Nearest by angle would move the
/// borders by 4 degrees at most.) Both look-ups need a direction other than 0.
int nearestDirection(glm::dvec3 direction);

}  // namespace freevoxels
