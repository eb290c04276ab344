// Puffs joined smoothly, their surface displaced by cellular noise (rounded billows, three octaves) and
// frayed by gradient noise.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/volume/procedural_fields.h"
#include "engine/volume/procedural_noise.h"

namespace freevoxels {

namespace {

using glm::vec3;

struct Puff {
  vec3 center;
  float radius;
};

// A broad base, a main tower left of the middle, a second one behind it, and outliers all around.
constexpr std::array<Puff, 15> kPuffs{{{{-0.02f, -0.10f, 0.00f}, 0.175f},
                                       {{-0.20f, -0.13f, 0.05f}, 0.120f},
                                       {{0.19f, -0.12f, 0.03f}, 0.130f},
                                       {{0.03f, -0.14f, 0.20f}, 0.110f},
                                       {{0.04f, -0.12f, -0.20f}, 0.125f},
                                       {{-0.08f, 0.06f, 0.01f}, 0.135f},
                                       {{-0.13f, 0.18f, -0.02f}, 0.095f},
                                       {{-0.04f, 0.25f, 0.00f}, 0.070f},
                                       {{0.12f, 0.05f, -0.07f}, 0.100f},
                                       {{0.18f, 0.13f, -0.10f}, 0.055f},
                                       {{0.08f, 0.00f, 0.13f}, 0.075f},
                                       {{-0.22f, 0.00f, -0.06f}, 0.070f},
                                       {{-0.33f, -0.16f, -0.02f}, 0.070f},
                                       {{0.34f, -0.16f, -0.03f}, 0.070f},
                                       {{0.22f, -0.17f, 0.20f}, 0.060f}}};
constexpr float kBase = -0.235f;  // height of the flat underside
constexpr float kJoin = 0.045f;   // length over which neighbouring puffs melt

constexpr std::array<Billow, 4> kBillows{{{7.0f, 0.085f}, {15.0f, 0.050f}, {32.0f, 0.024f}, {67.0f, 0.011f}}};
constexpr float kFray = 0.022f;     // amplitude of the fraying
constexpr float kSoftest = 0.075f;  // widest edge; where the cloud is deeper than this it is solid
constexpr float kWarp = 0.025f;     // amplitude of the warp of space

float smoothMinimum(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0f) / width;
  return std::min(a, b) - h * h * width * 0.25f;
}

/// Signed distance to the joined puffs, cut at the base; negative inside.
float puffDistance(vec3 p) {
  float distance = 1.0f;
  for (const Puff& puff : kPuffs)
    distance = smoothMinimum(distance, glm::length(p - puff.center) - puff.radius, kJoin);
  return -smoothMinimum(-distance, p.y - kBase, kJoin);
}

/// How far the billows from index `first` on and the fraying can move the surface, inwards or outwards.
float reach(std::size_t first) {
  float sum = 1.5f * kFray;
  for (std::size_t i = first; i < kBillows.size(); ++i) sum += 0.5f * kBillows[i].amplitude;
  return sum;
}

/// The puffs' surface with its billows. Exact only near the surface: where the finer billows can no longer
/// matter, they are left out.
float billowedDistance(vec3 p, float calm) {
  const vec3 warped = p + kWarp * gradientNoise3(p * 6.0f, 101u);
  float distance = puffDistance(warped);
  for (std::size_t i = 0; i < kBillows.size(); ++i) {
    if (distance > reach(i) || distance < -kSoftest - reach(i)) break;
    const float dome = billowNoise(warped * kBillows[i].frequency, 11u + std::uint32_t(i));
    distance -= kBillows[i].amplitude * calm * (dome - 0.5f);
  }
  return distance;
}

}  // namespace

float cloudDensity(vec3 position) {
  constexpr float kScale = 0.97f;  // the puffs above leave room around them
  const vec3 p = position * kScale + vec3(0.0f, 0.03f, 0.0f);
  const float coarse = puffDistance(p);
  if (coarse > reach(0) + kWarp) return 0.0f;

  const float aboveBase = glm::smoothstep(kBase, kBase + 0.12f, p.y);
  float distance = billowedDistance(p, glm::mix(0.4f, 1.0f, aboveBase));
  if (distance > reach(kBillows.size())) return 0.0f;

  // Crisp on the crowns, soft at the base and wherever low noise says that the cloud dissolves.
  const float noise = glm::smoothstep(-0.1f, 0.4f, gradientNoise(p * 5.0f, 31u));
  const float dissolving = std::max(noise, 0.7f * (1.0f - aboveBase));
  if (distance > -kSoftest - reach(kBillows.size()))
    distance += kFray * glm::mix(0.35f, 1.0f, dissolving) * fractalNoise(p * 26.0f, 4, 21u);
  const float body = glm::smoothstep(0.0f, glm::mix(0.018f, kSoftest, dissolving), -distance);
  const float core = glm::smoothstep(0.0f, 0.16f, -coarse);
  const float grain = 1.0f + 0.4f * fractalNoise(p * 12.0f, 3, 41u);
  const float density = std::clamp(body * glm::mix(0.4f, 0.9f, core) * grain, 0.0f, 1.0f);
  constexpr float kThinnest = 1.0f / 512.0f;  // less cannot be seen, but would cost a splat
  return density < kThinnest ? 0.0f : density;
}

}  // namespace freevoxels
