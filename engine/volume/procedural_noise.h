#pragma once
// Noise for the procedural volumes. Integer hashes only: the same on every machine.

#include <cstdint>
#include <glm/glm.hpp>

namespace freevoxels {

/// Perlin's gradient noise, about -0.7..0.7.
float gradientNoise(glm::vec3 p, std::uint32_t seed);

/// Three values of gradient noise, with the seeds `seed`, `seed` + 1 and `seed` + 2.
glm::vec3 gradientNoise3(glm::vec3 p, std::uint32_t seed);

/// Octaves of gradient noise, each of half the amplitude, about -1..1.
float fractalNoise(glm::vec3 p, int octaves, std::uint32_t seed);

/// Worley's cellular noise as domes, 0..1: 1 at the cells' points, with creases where the domes of two points
/// meet.
float billowNoise(glm::vec3 p, std::uint32_t seed);

/// A layer of billowNoise.
struct Billow {
  float frequency, amplitude;
};

}  // namespace freevoxels
