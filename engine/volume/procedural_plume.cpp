// A trail of smoke that spirals upwards: a bent cone with a domed end, its surface displaced by cellular
// noise that grows with the cone, its inside torn by gradient noise.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/volume/procedural_fields.h"
#include "engine/volume/procedural_noise.h"

namespace freevoxels {

namespace {

using glm::vec3;

constexpr float kBottom = -0.47f, kTop = 0.36f;    // of the axis
constexpr float kAround = 0.31f, kTurns = 0.85f;   // the axis is a helix
constexpr float kNarrow = 0.014f, kWide = 0.076f;  // radius of the smoke, below and above

constexpr std::array<Billow, 2> kSmokeBillows{{{12.0f, 0.9f}, {31.0f, 0.5f}}};  // amplitudes in radii
constexpr float kReach = 0.7f;  // half the sum of the amplitudes
constexpr float kSoft = 0.35f;  // width of the edge, in radii
constexpr float kSmokeWarp = 0.05f;

float angleAt(float t) {
  return 2.0f * std::numbers::pi_v<float> * kTurns * t;
}

vec3 axisAt(float t) {
  return {kAround * std::cos(angleAt(t)), glm::mix(kBottom, kTop, t), kAround * std::sin(angleAt(t))};
}

/// The derivative of the axis with respect to t.
vec3 alongAxis(float t) {
  const float speed = 2.0f * std::numbers::pi_v<float> * kTurns * kAround;
  return {-speed * std::sin(angleAt(t)), kTop - kBottom, speed * std::cos(angleAt(t))};
}

float radiusAt(float t) {
  return glm::mix(kNarrow, kWide, std::pow(t, 0.8f));
}

/// Largest distance of smoke from the axis at parameter t.
float reachAt(float t) {
  return radiusAt(t) * (1.0f + kReach) + kSmokeWarp * t;
}

/// Parameter t of the point of the axis that is nearest to p, as found by a few steps from p's height.
float nearestOnAxis(vec3 p) {
  float t = std::clamp((p.y - kBottom) / (kTop - kBottom), 0.0f, 1.0f);
  for (int step = 0; step < 3; ++step) {
    const vec3 along = alongAxis(t);
    t = std::clamp(t + 0.8f * glm::dot(p - axisAt(t), along) / glm::dot(along, along), 0.0f, 1.0f);
  }
  return t;
}

}  // namespace

float plumeClearance(vec3 position) {
  constexpr int kPoints = 64;
  float clearance = 1.0f;
  for (int i = 0; i <= kPoints; ++i) {
    const float t = float(i) / kPoints;
    clearance = std::min(clearance, glm::length(position - axisAt(t)) - reachAt(t));
  }
  return clearance - 0.5f * glm::length(alongAxis(0.0f)) / kPoints;  // for the axis between the sample points
}

float plumeDensity(vec3 position) {
  const float t = nearestOnAxis(position);
  const float radius = radiusAt(t);
  const vec3 axis = axisAt(t);
  if (glm::length(position - axis) > reachAt(t)) return 0.0f;

  const vec3 warped = position + kSmokeWarp * t * gradientNoise3(position * 5.0f, 61u);
  float distance = glm::length(warped - axis) / radius - 1.0f;  // in radii
  const float calm = glm::smoothstep(0.0f, 0.25f, t);
  for (std::size_t i = 0; i < kSmokeBillows.size(); ++i) {
    const vec3 place = warped * kSmokeBillows[i].frequency;
    distance -= calm * kSmokeBillows[i].amplitude * (billowNoise(place, 71u + std::uint32_t(i)) - 0.5f);
  }
  if (distance > 0.0f) return 0.0f;
  const float body = glm::smoothstep(0.0f, kSoft, -distance);
  const float torn = std::clamp(0.75f + 0.6f * fractalNoise(warped * 13.0f, 3, 81u), 0.1f, 1.0f);
  // It thins out as it widens.
  const float density = body * glm::mix(1.0f, torn, calm) * glm::mix(1.0f, 0.3f, t);
  constexpr float kThinnest = 1.0f / 512.0f;  // less cannot be seen, but would cost a splat
  return density < kThinnest ? 0.0f : density;
}

}  // namespace freevoxels
