#pragma once
// Light from all directions: a latitude-longitude image of radiance that arrives from infinitely far away.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/directions.h"

namespace freevoxels {

/// +y is up. Columns follow OpenEXR's latitude-longitude maps: the middle column is towards +z, the column a
/// quarter of the width from the left towards +x. A pixel at u from the left, in 0..1, is at the azimuth 360
/// (1/2 - u) about +y from +z, counted like a camera's orbit.
struct Environment {
  glm::ivec2 size{0};               ///< twice as wide as high
  std::vector<glm::vec3> radiance;  ///< linear Rec.709; row 0 is nearest to +y
  double rotation = 0.0;            ///< about +y, in degrees, added to the azimuths
  double intensity = 1.0;           ///< factor of the radiance
  std::uint64_t negativeValues = 0;  ///< of the file, that count as 0: lossy compression makes values such as -6e-8
};

/// Reads an environment. Fails with ErrorKind::Input if the file is not an OpenEXR image with R, G and B that
/// is twice as wide as high, or if it has non-finite pixels.
Environment readEnvironment(const std::filesystem::path& file);

/// A pixel of an environment, or a part of one.
struct EnvironmentPart {
  glm::dvec3 direction;  ///< unit vector in world space
  double solidAngle;
  glm::dvec3 radiance;  ///< includes the intensity
};

/// The number of rows of parts. Pixels are subdivided until there are at least 512 rows; the solid angles of
/// all rows add up to 4 pi.
int environmentRows(const Environment& environment);
std::vector<EnvironmentPart> environmentRow(const Environment& environment, int row);

/// For each direction of a table, in the order of directions.h, the mean radiance over the part of the sphere
/// that it represents (directionShares in lighting.h). Weighted by the shares they add up to the mean over
/// the sphere. The result does not depend on the number of threads.
std::vector<glm::dvec3> directionRadiances(const Environment& environment, DirectionSet set,
                                           const glm::dmat4& indexToWorld);

}  // namespace freevoxels
