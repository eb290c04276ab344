// A camp fire: a few tongues of flame, each a column that narrows upwards and is bent and torn by noise that
// grows with the height. Hottest in its core; smoke above and around it.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/volume/procedural_fields.h"
#include "engine/volume/procedural_noise.h"

namespace freevoxels {

namespace {

using glm::vec3;

constexpr float kGround = -0.45f;
constexpr float kHottest = 1900.0f, kCoolest = 900.0f;  // kelvin, of the core and the rim

struct Tongue {
  float x, z;            // of its foot
  float radius, height;  // of its foot, and of its tip above the ground
};
constexpr std::array<Tongue, 6> kTongues{{{0.0f, 0.0f, 0.12f, 0.70f},
                                          {0.08f, 0.03f, 0.10f, 0.47f},
                                          {-0.08f, 0.04f, 0.10f, 0.55f},
                                          {0.02f, -0.09f, 0.09f, 0.42f},
                                          {-0.05f, -0.06f, 0.08f, 0.33f},
                                          {0.05f, 0.09f, 0.08f, 0.38f}}};

/// `position` moved sideways like a flame in the wind, more with growing height.
vec3 bent(vec3 position, float height) {
  const vec3 slow = gradientNoise3(position * vec3(3.5f, 2.0f, 3.5f), 91u);
  const vec3 fast = gradientNoise3(position * vec3(10.0f, 5.0f, 10.0f), 92u);
  const vec3 fine = gradientNoise3(position * vec3(24.0f, 11.0f, 24.0f), 96u);
  const vec3 moved = 0.13f * slow + 0.07f * fast + 0.03f * fine;
  return position + std::min(0.25f + 2.5f * height, 1.2f) * moved * vec3(1.0f, 0.6f, 1.0f);
}

/// 1 in a tongue's core, 0 at its surface and outside.
float depthIn(const Tongue& tongue, vec3 position) {
  const float up = (position.y - kGround) / tongue.height;
  if (up < 0.0f || up > 1.0f) return 0.0f;
  // Round at the foot, pointed at the tip.
  const float radius = tongue.radius * std::sqrt(std::min(up * 8.0f, 1.0f)) * std::pow(1.0f - up, 0.8f);
  const float distance =
      std::hypot(position.x - tongue.x * (1.0f - 0.6f * up), position.z - tongue.z * (1.0f - 0.6f * up));
  return distance < radius ? 1.0f - distance / radius : 0.0f;
}

float flameDepth(vec3 position) {
  const float height = position.y - kGround;
  if (height < 0.0f || std::hypot(position.x, position.z) > 0.45f) return 0.0f;
  const vec3 place = bent(position, height);
  float outside = 1.0f;
  for (const Tongue& tongue : kTongues) outside *= 1.0f - depthIn(tongue, place);
  return 1.0f - outside;
}

}  // namespace

float fireTemperature(vec3 position) {
  const float depth = flameDepth(position);
  if (depth == 0.0f) return 0.0f;
  const float torn = 1.0f + 0.5f * fractalNoise(position * vec3(18.0f, 7.0f, 18.0f), 3, 93u);
  const float height = (position.y - kGround) / 0.7f;
  // It cools upwards.
  const float core = glm::smoothstep(0.0f, 0.8f, depth) * torn * (1.0f - 0.3f * height);
  return glm::mix(kCoolest, kHottest, std::clamp(core, 0.0f, 1.0f));
}

float fireDensity(vec3 position) {
  const float height = position.y - kGround;
  if (height < 0.0f) return 0.0f;
  const float flame = flameDepth(position);
  const vec3 place = bent(position, height) + 0.10f * height * gradientNoise3(position * 6.0f, 94u);
  const float radius = 0.07f + 0.20f * height, distance = std::hypot(place.x, place.z) / radius;
  if (distance > 1.0f && flame == 0.0f) return 0.0f;
  // Little around the flames, most above them; it thins out as it rises.
  const float column = glm::smoothstep(0.15f, 0.6f, height) * (1.0f - glm::smoothstep(0.6f, 0.95f, height));
  const float torn =
      std::clamp(0.35f + 1.3f * fractalNoise(place * vec3(9.0f, 6.0f, 9.0f), 4, 95u), 0.0f, 1.0f);
  const float smoke = 0.4f * column * torn * glm::smoothstep(0.0f, 0.8f, 1.0f - distance);
  const float density = std::max(smoke, 0.04f * flame);
  constexpr float kThinnest = 1.0f / 512.0f;  // less cannot be seen, but would cost a splat
  return density < kThinnest ? 0.0f : density;
}

}  // namespace freevoxels
