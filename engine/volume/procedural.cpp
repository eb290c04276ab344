#include "engine/volume/procedural.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/volume/procedural_fields.h"

namespace freevoxels {

struct ProceduralFunctions {
  ProceduralKind kind;
  float (*density)(glm::vec3 position, float voxelSize);
  /// A distance within which the density is 0, or null. Boxes that are nearly empty are filled faster with
  /// it.
  float (*clearance)(glm::vec3 position) = nullptr;
  float (*temperature)(glm::vec3 position) = nullptr;  ///< in kelvin; null if the field has no temperatures
  bool isMeasured = false;                             ///< whether the values are such as scanners have, not densities
};

namespace {

using glm::vec3;

constexpr int kLargestResolution = 2048;
constexpr float kPi = std::numbers::pi_v<float>;

float cubeDensity(vec3, float) {
  return 1.0f;
}

/// Marschner and Lobb 1994, "An evaluation of reconstruction filters for volume rendering", eq. 3, over [-1,
/// 1]³.
float marschnerLobb(vec3 position, float) {
  constexpr float kFrequency = 6.0f, kAmplitude = 0.25f;
  const vec3 p = 2.0f * position;
  const float radius = std::sqrt(p.x * p.x + p.y * p.y);
  const float ripple = std::cos(2.0f * kPi * kFrequency * std::cos(kPi * radius / 2.0f));
  const float value =
      (1.0f - std::sin(kPi * p.z / 2.0f) + kAmplitude * (1.0f + ripple)) / (2.0f * (1.0f + kAmplitude));
  return std::max(value, std::numeric_limits<float>::min());  // all active
}

/// Each shell is a cos² bump over the radius; the inner ones are denser.
float shellsDensity(vec3 position, float) {
  struct Shell {
    float radius, peak;
  };
  constexpr std::array<Shell, 4> kShells{{{0.10f, 1.0f}, {0.21f, 0.6f}, {0.32f, 0.35f}, {0.43f, 0.2f}}};
  constexpr float kHalfWidth = 0.04f;
  const float radius = glm::length(position);
  float density = 0.0f;
  for (const Shell& shell : kShells) {
    const float offset = std::abs(radius - shell.radius) / kHalfWidth;
    if (offset >= 1.0f) continue;
    const float bump = std::cos(offset * kPi / 2.0f);
    density += shell.peak * bump * bump;
  }
  return density;
}

/// A lattice of rods along the three axes. Their thickness is fixed in the world: 1.8 voxels at resolution
/// 128.
float rodsDensity(vec3 position, float voxelSize) {
  constexpr float kSpacing = 1.0f / 7.0f, kRadius = 0.9f / 128.0f, kHalfExtent = 0.46f;
  const auto fromRod = [](float x) { return x - kSpacing * std::round(x / kSpacing); };
  const vec3 d(fromRod(position.x), fromRod(position.y), fromRod(position.z));
  const vec3 outside = glm::abs(position) - kHalfExtent;
  const float end = std::max({outside.x, outside.y, outside.z});
  const float nearest =
      std::sqrt(std::min({d.x * d.x + d.y * d.y, d.y * d.y + d.z * d.z, d.x * d.x + d.z * d.z}));
  const auto coverage = [&](float distance) { return std::clamp(0.5f - distance / voxelSize, 0.0f, 1.0f); };
  return coverage(nearest - kRadius) * coverage(end);
}

constexpr std::array<ProceduralFunctions, 8> kFields{{
    {{"cube", "a uniform cube of density 1"}, cubeDensity},
    {{"cloud", "a fractal cumulus cloud"}, [](vec3 position, float) { return cloudDensity(position); }},
    {{"plume", "a spiral of smoke in a box that is nearly empty"},
     [](vec3 position, float) { return plumeDensity(position); },
     plumeClearance},
    {{"fire", "flames and smoke, with temperatures, which can emit light"},
     [](vec3 position, float) { return fireDensity(position); },
     nullptr,
     fireTemperature},
    {{"marschner-lobb", "the reconstruction test signal of Marschner and Lobb"}, marschnerLobb, nullptr, nullptr, true},
    {{"shells", "nested translucent spherical shells"}, shellsDensity},
    {{"rods", "a lattice of thin rods"}, rodsDensity},
    {{"head", "a head of ellipsoids with an opaque skull"}, headDensity, nullptr, nullptr, true},
}};

float activeIf(float value) {
  return value == 0.0f ? kInactiveVoxel : value;
}

const ProceduralFunctions& fieldNamed(std::string_view name) {
  std::string names;
  for (const ProceduralFunctions& field : kFields) {
    if (field.kind.name == name) return field;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", field.kind.name);
  }
  fail(ErrorKind::Usage, "there is no procedural volume '{}'; choose one of: {}", name, names);
}

}  // namespace

const std::vector<ProceduralKind>& proceduralKinds() {
  static const std::vector<ProceduralKind> kinds = [] {
    std::vector<ProceduralKind> list;
    for (const ProceduralFunctions& field : kFields) list.push_back(field.kind);
    return list;
  }();
  return kinds;
}

ProceduralField::ProceduralField(std::string_view name, glm::ivec3 dimensions)
    : functions_(&fieldNamed(name)), dimensions_(dimensions) {
  const int longest = std::max({dimensions.x, dimensions.y, dimensions.z});
  const int shortest = std::min({dimensions.x, dimensions.y, dimensions.z});
  if (shortest < 1 || longest > kLargestResolution)
    fail(ErrorKind::Usage, "the resolution of '{}' is {}; choose one from 1 to {}", name, shortest < 1 ? shortest : longest,
         kLargestResolution);
  voxelSize_ = 1.0 / longest;
  firstCentre_ = 0.5 * voxelSize_ - 0.5 * glm::dvec3(dimensions) / double(longest);
}

glm::dmat4 ProceduralField::indexToWorld() const {
  glm::dmat4 result(voxelSize_);
  result[3] = glm::dvec4(firstCentre_, 1.0);
  return result;
}

glm::vec3 ProceduralField::place(glm::ivec3 voxel) const {
  return firstCentre_ + voxelSize_ * glm::dvec3(voxel);
}

bool ProceduralField::hasTemperatures() const {
  return functions_->temperature != nullptr;
}

bool ProceduralField::isFog() const {
  return !functions_->isMeasured;
}

float ProceduralField::density(glm::ivec3 voxel) const {
  return activeIf(functions_->density(place(voxel), float(voxelSize_)));
}

float ProceduralField::temperature(glm::ivec3 voxel) const {
  return activeIf(functions_->temperature(place(voxel)));
}

bool ProceduralField::mayHoldData(glm::ivec3 first) const {
  if (functions_->clearance == nullptr) return true;
  const double half = 0.5 * (ScalarBricks::kEdge - 1);
  const vec3 middle(firstCentre_ + voxelSize_ * (glm::dvec3(first) + half));
  return double(functions_->clearance(middle)) <= std::sqrt(3.0) * half * voxelSize_;
}

Volume makeProcedural(std::string_view name, glm::ivec3 dimensions, const Progress& progress) {
  const ProceduralField field(name, dimensions);
  const auto mayHoldData = [&](glm::ivec3 first) { return field.mayHoldData(first); };
  Volume volume{
      .source = fmt::format("procedural:{}", name), .dimensions = dimensions, .indexToWorld = field.indexToWorld(), .isFog = field.isFog()};
  volume.scalars = ScalarBricks::make(dimensions, [&](glm::ivec3 v) { return field.density(v); }, mayHoldData, progress);
  summariseValues(volume);
  if (!field.hasTemperatures()) return volume;
  volume.temperature = TemperatureGrid{
      .name = "", .values = ScalarBricks::make(dimensions, [&](glm::ivec3 v) { return field.temperature(v); }, mayHoldData, progress)};
  summariseValues(*volume.temperature);
  coverBricks(volume, volume.temperature->values);
  return volume;
}

}  // namespace freevoxels
