#include "engine/reference/light_march.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/reference/ray_march.h"

namespace freevoxels {

namespace {

/// A cell of an n x n x 6 grid on the faces of a cube.
std::size_t partOfCube(glm::dvec3 direction, int n) {
  const glm::dvec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto along = [&](int other) {
    const double across = direction[(axis + other) % 3] / size[axis];
    return std::min(int(0.5 * n * (across + 1.0)), n - 1);
  };
  return std::size_t(along(1) + n * (along(2) + n * (2 * axis + (direction[axis] > 0.0 ? 1 : 0))));
}

}  // namespace

/// Directions on a spiral from pole to pole, each with the same part of the sphere (Fibonacci lattice).
std::vector<LightMarch::Ray> LightMarch::evenRays(int count) {
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, across = std::sqrt(1.0 - z * z);
    rays.push_back({{across * std::cos(turn * i), across * std::sin(turn * i), z}, glm::dvec3(1.0 / count)});
  }
  return rays;
}

std::vector<LightMarch::Ray> LightMarch::environmentRays(const Lighting& lighting, int count) {
  const int n = int(std::ceil(std::sqrt(count / 6.0)));
  std::vector<Ray> rays(std::size_t(6 * n * n), {glm::dvec3(0.0), glm::dvec3(0.0)});
  for (int row = 0; row < environmentRows(*lighting.environment); ++row)
    for (const EnvironmentPart& part : environmentRow(*lighting.environment, row)) {
      Ray& ray = rays[partOfCube(part.direction, n)];
      const glm::dvec3 light =
          part.solidAngle / (4.0 * std::numbers::pi) * (part.radiance + lighting.ambient);
      ray.light += light;
      ray.direction += (light.r + light.g + light.b) * part.direction;
    }
  std::erase_if(rays, [](const Ray& ray) { return ray.light == glm::dvec3(0.0); });
  for (Ray& ray : rays) ray.direction = glm::normalize(ray.direction);
  return rays;
}

LightMarch::LightMarch(const ReferenceField& field, const glm::dmat4& indexToWorld, const Lighting& lighting,
                       const RaySource& eye, int ambientRays, const Progress& progress)
    : field_(field),
      toWorld_(indexToWorld),
      lighting_(lighting),
      eye_(eye),
      channels_(lighting.environment || lighting.isTinted() ? 3 : 1) {
  for (const Light& light : lighting.lights) sources_.push_back(lightSource(light, indexToWorld));
  if (!lighting.hasAmbient()) return;
  marchAmbient(lighting.environment ? environmentRays(lighting, ambientRays) : evenRays(ambientRays),
               progress);
}

glm::dvec3 LightMarch::transmittance(glm::dvec3 position, glm::dvec3 direction, double end) const {
  const MarchedRay ray{
      .origin = position, .direction = direction, .worldLength = glm::length(toWorld_ * direction)};
  return glm::exp(-marchDepth(field_, ray, end) * lighting_.tint);
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
  return light.color * irradiance * octaves(transmittance(position, way, end), glm::dot(-worldWay / length, toEye));
}

/// The sum over all octaves of scattering, weighted by the phase function for the cosine between the
/// directions before and after scattering.
glm::dvec3 LightMarch::octaves(glm::dvec3 transmittance, double cosine) const {
  glm::dvec3 sum(0.0);
  for (int octave = 0; octave < lighting_.scattering; ++octave) {
    const double scale = lighting_.octaveScale(octave);
    sum += scale * phaseFunction(scale * lighting_.phaseG, cosine) * glm::pow(transmittance, glm::dvec3(scale));
  }
  return sum;
}

std::unique_ptr<LightMarch::Reaching> LightMarch::marchBrick(glm::ivec3 position,
                                                             const std::vector<Ray>& rays) const {
  const ReferenceField::Brick* const brick = field_.brick(position);
  if (!brick) return nullptr;
  constexpr int cells = ReferenceField::kBrickCells, n = kBrickPoints;
  const glm::dvec3 first = position * cells - 1;
  auto reaching = std::make_unique<Reaching>(std::size_t(n * n * n * channels_), -1.0f);
  const auto march = [&](glm::ivec3 point) {
    float* const parts = &(*reaching)[std::size_t((point.x + n * (point.y + n * point.z)) * channels_)];
    if (parts[0] >= 0.0f) return;
    const glm::dvec3 at = first + glm::dvec3(point) / double(kPointsPerVoxel);
    const glm::dvec3 toEye = glm::normalize(toWorld_ * (eye_.atInfinity ? eye_.place : eye_.place - at));
    glm::dvec3 sum(0.0);
    for (const Ray& ray : rays) {
      const glm::dvec3 way = glm::normalize(toWorld_ * ray.direction);
      sum += ray.light * octaves(transmittance(at, ray.direction, std::numeric_limits<double>::infinity()), -glm::dot(way, toEye));
    }
    for (int c = 0; c < channels_; ++c) parts[c] = float(4.0 * std::numbers::pi * sum[c]);
  };
  for (int cell = 0; cell < cells * cells * cells; ++cell) {
    const glm::ivec3 corner(cell % cells, cell / cells % cells, cell / cells / cells);
    if (!field_.isFilled(*brick, corner)) continue;
    for (int i = 0; i < 27; ++i) march(kPointsPerVoxel * corner + glm::ivec3(i % 3, i / 3 % 3, i / 9));
  }
  return reaching;
}

void LightMarch::marchAmbient(std::vector<Ray> rays, const Progress& progress) {
  const glm::dmat3 toIndex = glm::inverse(toWorld_);
  for (Ray& ray : rays) ray.direction = toIndex * ray.direction;
  const glm::ivec3 bricks = field_.brickCount();
  const std::size_t layer = std::size_t(bricks.x) * std::size_t(bricks.y);
  ambient_.resize(layer * std::size_t(bricks.z));
  for (int z = 0; z < bricks.z; ++z) {
    if (progress) progress("marching for ambient light", double(z) / bricks.z);
    tbb::parallel_for(std::size_t(0), layer, [&](std::size_t i) {
      const glm::ivec3 position(int(i % std::size_t(bricks.x)), int(i / std::size_t(bricks.x)), z);
      ambient_[std::size_t(z) * layer + i] = marchBrick(position, rays);
    });
  }
}

glm::dvec3 LightMarch::reachingFromAll(glm::dvec3 position) const {
  constexpr int cells = ReferenceField::kBrickCells, n = kBrickPoints;
  const glm::ivec3 bricks = field_.brickCount();
  const glm::ivec3 brick =
      glm::clamp(glm::ivec3((position + 1.0) / double(cells)), glm::ivec3(0), bricks - 1);
  const auto& reaching =
      ambient_[std::size_t(brick.x) +
               std::size_t(bricks.x) * (std::size_t(brick.y) + std::size_t(bricks.y) * std::size_t(brick.z))];
  if (!reaching) return glm::dvec3(0.0);
  const glm::dvec3 local = double(kPointsPerVoxel) * (position + 1.0 - glm::dvec3(brick * cells));
  const glm::ivec3 low = glm::clamp(glm::ivec3(local), glm::ivec3(0), glm::ivec3(n - 2));
  glm::dvec3 sum(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 point = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 share = 1.0 - glm::abs(local - glm::dvec3(point));
    const float* const parts = &(*reaching)[std::size_t((point.x + n * (point.y + n * point.z)) * channels_)];
    for (int c = 0; c < channels_; ++c) sum[c] += share.x * share.y * share.z * double(parts[c]);
  }
  if (channels_ == 1) sum = glm::dvec3(sum.x);
  return lighting_.environment ? sum : lighting_.ambient * sum;
}

glm::dvec3 LightMarch::scattered(glm::dvec3 position, glm::dvec3 toEye) const {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < sources_.size(); ++i) sum += scatteredFrom(i, position, toEye);
  if (!ambient_.empty()) sum += reachingFromAll(position);
  return sum;
}

}  // namespace freevoxels
