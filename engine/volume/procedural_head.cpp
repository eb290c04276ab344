// A head of ellipsoids after the idea of the Shepp-Logan phantom: nested tissues whose order and opacity are
// known.
#include <algorithm>
#include <cmath>

#include "engine/volume/procedural_fields.h"

namespace freevoxels {

namespace {

using glm::vec3;

constexpr float kSkin = 0.12f, kMuscle = 0.2f, kEye = 0.25f, kBrain = 0.35f, kBone = 1.0f;
constexpr float kSkullThickness = 0.028f;

/// Signed distance to an ellipsoid, exact at its surface to first order (|k|(|k|-1)/|∇| of its implicit
/// function).
float ellipsoid(vec3 p, vec3 center, vec3 radii) {
  const vec3 q = (p - center) / radii;
  const float length = glm::length(q);
  const float gradient = glm::length(q / radii);
  return gradient > 0.0f ? length * (length - 1.0f) / gradient : -std::min({radii.x, radii.y, radii.z});
}

float smoothUnion(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0f) / width;
  return std::min(a, b) - h * h * width * 0.25f;
}

/// Upright cylinder from below the cube to `top`.
float neck(vec3 p, float radius, float top) {
  return std::max(glm::length(glm::vec2(p.x, p.z + 0.06f)) - radius, p.y - top);
}

/// Signed distance to the skin. The head is symmetric: x is folded to its right half.
float skinSurface(vec3 p) {
  const float cranium = ellipsoid(p, {0.0f, 0.13f, -0.03f}, {0.255f, 0.295f, 0.325f});
  const float face = ellipsoid(p, {0.0f, -0.08f, 0.09f}, {0.185f, 0.275f, 0.215f});
  const float nose = ellipsoid(p, {0.0f, -0.03f, 0.315f}, {0.036f, 0.07f, 0.06f});
  const float ear = ellipsoid(p, {0.25f, 0.02f, -0.04f}, {0.028f, 0.075f, 0.045f});
  float surface = smoothUnion(cranium, face, 0.08f);
  surface = smoothUnion(surface, nose, 0.04f);
  surface = smoothUnion(surface, ear, 0.02f);
  return smoothUnion(surface, neck(p, 0.135f, -0.15f), 0.08f);
}

float craniumInside(vec3 p) {
  return ellipsoid(p, {0.0f, 0.14f, -0.035f}, {0.193f, 0.232f, 0.262f});
}

float skull(vec3 p) {
  const float inside = craniumInside(p);
  const float vault = std::max(inside - kSkullThickness, -inside);
  const float cheek = ellipsoid(p, {0.0f, -0.02f, 0.13f}, {0.15f, 0.12f, 0.13f});
  const float upperJaw = ellipsoid(p, {0.0f, -0.13f, 0.16f}, {0.085f, 0.06f, 0.085f});
  float bone = std::max(smoothUnion(smoothUnion(vault, cheek, 0.03f), upperJaw, 0.03f), -inside);
  const float socket = ellipsoid(p, {0.082f, 0.035f, 0.245f}, {0.057f, 0.05f, 0.095f});
  const float nasalCavity = ellipsoid(p, {0.0f, -0.045f, 0.26f}, {0.03f, 0.05f, 0.09f});
  const float behindCheek = ellipsoid(p, {0.0f, -0.08f, 0.05f}, {0.105f, 0.09f, 0.1f});
  return std::max(bone, -std::min({socket, nasalCavity, behindCheek}));
}

/// A horseshoe under the upper jaw with its branches up to the skull's base.
float lowerJaw(vec3 p) {
  const float outer = ellipsoid(p, {0.0f, -0.16f, 0.06f}, {0.15f, 0.15f, 0.2f});
  const float inner = ellipsoid(p, {0.0f, -0.15f, 0.045f}, {0.122f, 0.15f, 0.175f});
  const float horseshoe = std::max({outer, -inner, p.y + 0.185f, -p.z - 0.03f});
  const float branch = ellipsoid(p, {0.128f, -0.12f, 0.0f}, {0.016f, 0.11f, 0.042f});
  return smoothUnion(horseshoe, branch, 0.02f);
}

float spine(vec3 p) {
  const float discs = 0.006f * std::cos(p.y * 120.0f);
  return std::max(glm::length(glm::vec2(p.x, p.z + 0.085f)) - 0.042f - discs, p.y + 0.1f);
}

float teeth(vec3 p) {
  const float row = std::abs(glm::length(glm::vec2(p.x, p.z - 0.13f)) - 0.083f) - 0.011f;
  const float gaps = 0.004f - 0.004f * std::cos(std::atan2(p.x, p.z - 0.13f) * 22.0f);
  return std::max({row + gaps, std::abs(p.y + 0.182f) - 0.022f, 0.13f - p.z});
}

float brainSurface(vec3 p) {
  const float folds = std::sin(p.x * 75.0f + 3.0f * std::sin(p.y * 31.0f)) *
                      std::sin(p.y * 67.0f + 2.0f * std::sin(p.z * 37.0f)) *
                      std::sin(p.z * 71.0f + 3.0f * std::sin(p.x * 29.0f));
  const float halves = 0.012f * std::exp(-p.x * p.x / 0.0002f);
  return craniumInside(p) + 0.014f + 0.006f * folds + halves;
}

}  // namespace

float headDensity(vec3 position, float voxelSize) {
  const vec3 p(std::abs(position.x), position.y, position.z);
  const auto coverage = [&](float distance) { return std::clamp(0.5f - distance / voxelSize, 0.0f, 1.0f); };
  const float skin = skinSurface(p);
  float density = coverage(skin) * kSkin;
  if (density == 0.0f) return 0.0f;
  const auto fill = [&](float distance, float value) {
    density = glm::mix(density, value, coverage(distance));
  };
  fill(skin + 0.022f, kMuscle);
  fill(craniumInside(p), kSkin);  // the fluid around the brain
  fill(brainSurface(p), kBrain);
  fill(glm::length(p - vec3(0.082f, 0.035f, 0.245f)) - 0.042f, kEye);
  fill(std::min({skull(p), lowerJaw(p), spine(p), teeth(p)}), kBone);
  return density;
}

}  // namespace freevoxels
