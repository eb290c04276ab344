#pragma once
// Internal to the procedural*.cpp files: the fields that need more than a few lines. Positions are in the
// world cube
// [-1/2, 1/2]³ with y up; results are densities in 0..1, exactly 0 outside.

#include <glm/glm.hpp>

namespace freevoxels {

/// A cumulus: billows over a flattish base, soft at the edge, thinner where it frays into wisps.
float cloudDensity(glm::vec3 position);

/// A spiral of smoke from the bottom to the top, in about a twentieth of its box.
float plumeDensity(glm::vec3 position);
/// A distance from `position` within which there is no smoke.
float plumeClearance(glm::vec3 position);

/// Smoke over a fire, thin where the fire is hot.
float fireDensity(glm::vec3 position);
/// In kelvin; 0 where nothing burns.
float fireTemperature(glm::vec3 position);

/// A head in front view along -z, with nested tissues of different density: skin 0.1 to 0.2, brain 0.3 to
/// 0.4, bone 1. Surfaces are smoothed over `voxelSize`.
float headDensity(glm::vec3 position, float voxelSize);

}  // namespace freevoxels
