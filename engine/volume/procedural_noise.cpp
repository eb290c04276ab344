#include "engine/volume/procedural_noise.h"

#include <algorithm>

namespace freevoxels {

namespace {

using glm::ivec3;
using glm::vec3;

/// Three rounds of multiply and shift over the cell's coordinates (the constants are those of MurmurHash3's
/// finaliser).
std::uint32_t hash(ivec3 cell, std::uint32_t seed) {
  std::uint32_t h = seed;
  for (int axis = 0; axis < 3; ++axis) {
    h ^= std::uint32_t(cell[axis]) * 0x9e3779b1u;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  }
  return h ^ (h >> 16);
}

/// Three numbers in 0..1 from one hash.
vec3 hashToCube(std::uint32_t h) {
  constexpr float kScale = 1.0f / 1023.0f;
  return vec3(float(h & 1023u), float((h >> 10) & 1023u), float((h >> 20) & 1023u)) * kScale;
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

}  // namespace

float gradientNoise(vec3 p, std::uint32_t seed) {
  const vec3 base = glm::floor(p);
  const vec3 t = p - base;
  const auto corner = [&](int x, int y, int z) {
    const vec3 gradient = hashToCube(hash(ivec3(base) + ivec3(x, y, z), seed)) * 2.0f - 1.0f;
    return glm::dot(gradient, t - vec3(float(x), float(y), float(z)));
  };
  const auto edge = [&](int y, int z) { return glm::mix(corner(0, y, z), corner(1, y, z), fade(t.x)); };
  const auto face = [&](int z) { return glm::mix(edge(0, z), edge(1, z), fade(t.y)); };
  return glm::mix(face(0), face(1), fade(t.z));
}

float fractalNoise(vec3 p, int octaves, std::uint32_t seed) {
  float sum = 0.0f, amplitude = 1.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * gradientNoise(p, seed + std::uint32_t(octave));
    p = p * 2.03f + vec3(17.3f, 5.1f, 11.7f);
    amplitude *= 0.5f;
  }
  return sum;
}

float billowNoise(vec3 p, std::uint32_t seed) {
  const vec3 base = glm::floor(p);
  float nearest = 1.0f;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const vec3 cell = base + vec3(float(x), float(y), float(z));
        const vec3 offset = cell + hashToCube(hash(ivec3(cell), seed)) - p;
        nearest = std::min(nearest, glm::dot(offset, offset));
      }
  return 1.0f - nearest;
}

vec3 gradientNoise3(vec3 p, std::uint32_t seed) {
  return {gradientNoise(p, seed), gradientNoise(p, seed + 1), gradientNoise(p, seed + 2)};
}

}  // namespace freevoxels
