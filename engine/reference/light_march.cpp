#include "engine/reference/light_march.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/reference/ray_march.h"

namespace freevoxels {

namespace {

/// Of a sphere: a spiral from pole to pole, each with the same share (Fibonacci's lattice).
std::vector<glm::dvec3> evenDirections(int count) {
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, across = std::sqrt(1.0 - z * z);
    directions.emplace_back(across * std::cos(turn * i), across * std::sin(turn * i), z);
  }
  return directions;
}

}  // namespace

LightMarch::LightMarch(const ReferenceField& field, const glm::dmat4& indexToWorld, const Lighting& lighting,
                       int ambientRays, const Progress& progress)
    : field_(field), toWorld_(indexToWorld), lighting_(lighting) {
  for (const Light& light : lighting.lights) sources_.push_back(lightSource(light, indexToWorld));
  if (lighting.ambient != glm::dvec3(0.0)) marchAmbient(ambientRays, progress);
}

double LightMarch::transmittance(glm::dvec3 position, glm::dvec3 direction, double end) const {
  const MarchedRay ray{
      .origin = position, .direction = direction, .worldLength = glm::length(toWorld_ * direction)};
  return std::exp(-marchDepth(field_, ray, end));
}

glm::dvec3 LightMarch::scatteredFrom(std::size_t i, glm::dvec3 position, glm::dvec3 toEye) const {
  const Light& light = lighting_.lights[i];
  const RaySource& source = sources_[i];
  const glm::dvec3 way = source.atInfinity ? source.place : source.place - position;
  const glm::dvec3 worldWay = toWorld_ * way;
  const double length = glm::length(worldWay);
  if (!(length > 0.0)) return glm::dvec3(0.0);
  const double end = source.atInfinity ? std::numeric_limits<double>::infinity() : 1.0;
  const double irradiance = light.intensity / (source.atInfinity ? 1.0 : length * length);
  const double phase = phaseFunction(lighting_.phaseG, glm::dot(-worldWay / length, toEye));
  return light.color * (irradiance * phase * transmittance(position, way, end));
}

std::unique_ptr<LightMarch::Reaching> LightMarch::marchBrick(
    glm::ivec3 position, const std::vector<glm::dvec3>& directions) const {
  const ReferenceField::Brick* const brick = field_.brick(position);
  if (!brick) return nullptr;
  constexpr int cells = ReferenceField::kBrickCells, n = kBrickPoints;
  const glm::dvec3 first = position * cells - 1;
  auto reaching = std::make_unique<Reaching>();
  reaching->fill(-1.0f);
  const auto march = [&](glm::ivec3 point) {
    float& part = (*reaching)[std::size_t(point.x + n * (point.y + n * point.z))];
    if (part >= 0.0f) return;
    const glm::dvec3 at = first + glm::dvec3(point) / double(kPointsPerVoxel);
    double sum = 0.0;
    for (const glm::dvec3& direction : directions)
      sum += transmittance(at, direction, std::numeric_limits<double>::infinity());
    part = float(sum / double(directions.size()));
  };
  for (int cell = 0; cell < cells * cells * cells; ++cell) {
    const glm::ivec3 corner(cell % cells, cell / cells % cells, cell / cells / cells);
    if (!ReferenceField::isFilled(*brick, corner)) continue;
    for (int i = 0; i < 27; ++i) march(kPointsPerVoxel * corner + glm::ivec3(i % 3, i / 3 % 3, i / 9));
  }
  return reaching;
}

void LightMarch::marchAmbient(int rays, const Progress& progress) {
  std::vector<glm::dvec3> directions = evenDirections(rays);
  const glm::dmat3 toIndex = glm::inverse(toWorld_);
  for (glm::dvec3& direction : directions) direction = toIndex * direction;
  const glm::ivec3 bricks = field_.brickCount();
  const std::size_t layer = std::size_t(bricks.x) * std::size_t(bricks.y);
  ambient_.resize(layer * std::size_t(bricks.z));
  for (int z = 0; z < bricks.z; ++z) {
    if (progress) progress("marching for ambient light", double(z) / bricks.z);
    tbb::parallel_for(std::size_t(0), layer, [&](std::size_t i) {
      const glm::ivec3 position(int(i % std::size_t(bricks.x)), int(i / std::size_t(bricks.x)), z);
      ambient_[std::size_t(z) * layer + i] = marchBrick(position, directions);
    });
  }
}

double LightMarch::reachingFromAll(glm::dvec3 position) const {
  constexpr int cells = ReferenceField::kBrickCells, n = kBrickPoints;
  const glm::ivec3 bricks = field_.brickCount();
  const glm::ivec3 brick =
      glm::clamp(glm::ivec3((position + 1.0) / double(cells)), glm::ivec3(0), bricks - 1);
  const auto& reaching =
      ambient_[std::size_t(brick.x) +
               std::size_t(bricks.x) * (std::size_t(brick.y) + std::size_t(bricks.y) * std::size_t(brick.z))];
  if (!reaching) return 0.0;
  const glm::dvec3 local = double(kPointsPerVoxel) * (position + 1.0 - glm::dvec3(brick * cells));
  const glm::ivec3 low = glm::clamp(glm::ivec3(local), glm::ivec3(0), glm::ivec3(n - 2));
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 point = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 share = 1.0 - glm::abs(local - glm::dvec3(point));
    sum +=
        share.x * share.y * share.z * double((*reaching)[std::size_t(point.x + n * (point.y + n * point.z))]);
  }
  return sum;
}

glm::dvec3 LightMarch::scattered(glm::dvec3 position, glm::dvec3 toEye) const {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < sources_.size(); ++i) sum += scatteredFrom(i, position, toEye);
  if (!ambient_.empty()) sum += lighting_.ambient * reachingFromAll(position);
  return sum;
}

}  // namespace freevoxels
