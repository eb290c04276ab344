#include "engine/reference/merged_march.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/reference/reference_scattering.h"

namespace freevoxels {

namespace {

constexpr double kEndedTransmittance = 1e-7;
constexpr double kOrdersTolerance = 1e-4;

/// The trilinear interpolation between the corners of the cell around a place; 0 without a brick.
template <typename BrickAt>
glm::dvec4 interpolated(const ReferenceField& field, glm::dvec3 place, const BrickAt& brickAt) {
  constexpr int n = ReferenceField::kBrickCorners, cells = ReferenceField::kBrickCells;
  const glm::dvec3 low = glm::floor(place);
  const glm::ivec3 cell = glm::ivec3(low) + 1;  // counted from the first brick's first cell
  if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, field.dimensions() + 1))) return glm::dvec4(0.0);
  const ReferenceField::Brick* const brick = brickAt(cell / cells);
  if (brick == nullptr) return glm::dvec4(0.0);
  const glm::ivec3 local = cell % cells;
  const glm::dvec3 part = place - low;
  glm::dvec4 sum(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2), at = local + side;
    const glm::dvec3 shares = glm::mix(1.0 - part, part, glm::dvec3(side));
    sum += shares.x * shares.y * shares.z * glm::dvec4((*brick)[std::size_t(at.x + n * (at.y + n * at.z))]);
  }
  return sum;
}

}  // namespace

/// What a field has at a point: extinction times colour, extinction and emission, per world unit.
struct MergedMarch::Point {
  glm::dvec4 medium{0.0};
  glm::dvec3 emission{0.0};
};

MergedMarch::MergedMarch(std::span<const PlacedMedium> volumes, const std::optional<Lighting>& lighting, double step,
                         const Progress& progress)
    : lighting_(lighting) {
  double voxel = std::numeric_limits<double>::max();
  bool emits = false;
  for (const PlacedMedium& placed : volumes) {
    fields_.push_back({ReferenceField(*placed.volume, *placed.classification, progress), glm::inverse(placed.volume->indexToWorld)});
    for (int axis = 0; axis < 3; ++axis) voxel = std::min(voxel, glm::length(glm::dvec3(placed.volume->indexToWorld[axis])));
    emits |= brightestLight(*placed.classification, *placed.volume) > 0.0;
  }
  stepLength_ = step * voxel;
  if (!lighting_) return;
  const ScatteringMedium medium(volumes);
  deltaScale_ = deltaScaleOf(*lighting_, medium);
  if (!lighting_->hasIndirectLight() && !emits) return;
  scattered_ = referenceScattering(medium, *lighting_, kOrdersTolerance, progress);
  worldToCells_ = glm::inverse(medium.indexToWorld());
}

/// With `lastScalar`, that of the point before on the ray, as a stretch from there.
MergedMarch::Point MergedMarch::pointOn(std::size_t field, const WorldRay& ray, double t, std::optional<double>& lastScalar) const {
  const ReferenceField& own = fields_[field].field;
  const glm::dvec3 place(fields_[field].toIndex * glm::dvec4(ray.origin + t * ray.direction, 1.0));
  const glm::dvec4 value = interpolated(own, place, [&](glm::ivec3 brick) { return own.brick(brick); });
  Point point{.medium = value};
  if (own.integral() != nullptr) {
    point.medium = glm::dvec4(0.0);
    if (value.a > 0.0) {
      const double scalar = value.r / value.a;
      point.medium = value.a * own.integral()->mean(lastScalar.value_or(scalar), scalar);
      lastScalar = scalar;
    } else {
      lastScalar.reset();
    }
    return point;
  }
  point.emission = glm::dvec3(interpolated(own, place, [&](glm::ivec3 brick) { return own.emission(brick); }));
  return point;
}

/// The light from a distance `end` along the ray that reaches its origin.
glm::dvec3 MergedMarch::transmittance(const WorldRay& ray, double end) const {
  double depth = 0.0;
  for (const Field& field : fields_) {
    const MarchedRay marched{.origin = glm::dvec3(field.toIndex * glm::dvec4(ray.origin, 1.0)),
                             .direction = glm::dmat3(field.toIndex) * ray.direction,
                             .worldLength = glm::length(ray.direction)};
    depth += marchDepth(field.field, marched, end);
  }
  return glm::exp(-depth * lighting_->tint * deltaScale_);
}

glm::dvec3 MergedMarch::scatteredAt(glm::dvec3 position, glm::dvec3 toEye) const {
  glm::dvec3 sum(0.0);
  for (const Light& light : lighting_->lights) {
    const glm::dvec3 way = light.atInfinity ? light.place : light.place - position;
    const double length = glm::length(way);
    if (!(length > 0.0)) continue;
    const double irradiance = light.intensity / (light.atInfinity ? 1.0 : length * length);
    const double end = light.atInfinity ? std::numeric_limits<double>::infinity() : 1.0;
    sum +=
        light.color * irradiance * phaseFunction(lighting_->phaseG, glm::dot(-way / length, toEye)) * transmittance({position, way}, end);
  }
  if (scattered_) sum += scattered_->at(glm::dvec3(worldToCells_ * glm::dvec4(position, 1.0)), toEye);
  return sum;
}

RaySum MergedMarch::sum(const WorldRay& ray) const {
  double begin = std::numeric_limits<double>::max(), end = 0.0;
  for (const Field& field : fields_) {
    double enter = 0.0, leave = std::numeric_limits<double>::max();
    const glm::dvec3 origin(field.toIndex * glm::dvec4(ray.origin, 1.0)), direction = glm::dmat3(field.toIndex) * ray.direction;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-1.0 - origin[axis]) / direction[axis], b = (field.field.dimensions()[axis] - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (!(enter < leave)) continue;
    begin = std::min(begin, enter);
    end = std::max(end, leave);
  }
  end = std::min(end, ray.end);
  RaySum result;
  const double worldLength = glm::length(ray.direction);
  const glm::dvec3 toEye = -ray.direction / worldLength;
  const int steps = begin < end ? int(std::ceil((end - begin) * worldLength / stepLength_)) : 0;
  const double apart = steps > 0 ? (end - begin) / steps : 0.0, length = apart * worldLength;
  std::vector<std::optional<double>> scalars(fields_.size());
  double transmittance = 1.0;
  glm::dvec3 ofLight(1.0);
  for (int i = 0; i < steps && transmittance >= kEndedTransmittance; ++i) {
    const double t = begin + (i + 0.5) * apart;
    Point mixed;
    for (std::size_t field = 0; field < fields_.size(); ++field) {
      const Point point = pointOn(field, ray, t, scalars[field]);
      mixed.medium += point.medium;
      mixed.emission += point.emission;
    }
    const double depth = mixed.medium.a * length, through = std::exp(-depth);
    if (depth == 0.0 && mixed.emission == glm::dvec3(0.0)) continue;
    glm::dvec3 source(mixed.medium);
    if (lighting_ && depth > 0.0) source *= scatteredAt(ray.origin + t * ray.direction, toEye);
    for (int c = 0; c < 3; ++c) {
      const double depthOfLight = depth * deltaScale_[c];
      const double mean = depthOfLight > 1e-9 ? -std::expm1(-depthOfLight) / depthOfLight : 1.0;
      result.color[c] += ofLight[c] * mean * length * (source[c] + mixed.emission[c]);
      ofLight[c] *= std::exp(-depthOfLight);
    }
    result.distance += transmittance * (1.0 - through) * t;
    transmittance *= through;
  }
  result.opacity = 1.0 - transmittance;
  return result;
}

}  // namespace freevoxels
