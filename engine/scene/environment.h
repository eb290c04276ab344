#pragma once
// Light from all around: a lat-long picture of radiance that comes from infinitely far away.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/directions.h"

namespace freevoxels {

/// +y is up. The columns are as OpenEXR has them in its lat-long maps: the one in the middle is towards +z,
/// the one a quarter of the width from the left towards +x. So a pixel at u from the left, in 0..1, is at the
/// azimuth 360 (1/2 - u) about +y from +z, which is how a camera's orbit counts.
struct Environment {
  glm::ivec2 size{0};               ///< twice as wide as high
  std::vector<glm::vec3> radiance;  ///< linear Rec.709; row 0 is the one around +y
  double rotation = 0.0;            ///< about +y, in degrees: is added to the azimuths
  double intensity = 1.0;           ///< by which the radiance is multiplied
  std::uint64_t negativeValues = 0;  ///< of the file, that count as 0: lossy compression makes values such as -6e-8
};

/// Fails with ExitCode::Input where the file is no OpenEXR picture with R, G and B, twice as wide as high, or
/// has pixels that are not finite.
Environment readEnvironment(const std::filesystem::path& file);

/// A pixel of an environment, or a part of one.
struct EnvironmentPart {
  glm::dvec3 direction;  ///< where it is in the world, of length 1
  double solidAngle;
  glm::dvec3 radiance;  ///< with the intensity
};

/// Pixels are divided until there are at least 512 rows of parts: of all rows together the solid angles add
/// up to 4 pi.
int environmentRows(const Environment& environment);
std::vector<EnvironmentPart> environmentRow(const Environment& environment, int row);

/// The mean radiance of each direction of a table, over the part of the sphere around a voxel that the
/// direction stands for (directionShares in lighting.h): times the shares they add up to the mean over the
/// sphere. In the order of directions.h; the same whatever the number of threads.
std::vector<glm::dvec3> directionRadiances(const Environment& environment, DirectionSet set,
                                           const glm::dmat4& indexToWorld);

}  // namespace freevoxels
