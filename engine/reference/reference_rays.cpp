#include "engine/reference/reference_rays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/scene/directions.h"

namespace freevoxels {

namespace {

std::uint16_t encodeRayDepth(double depth) {
  return std::uint16_t(std::lround(65535.0 * std::sqrt(std::clamp(depth / kOpaqueDepth, 0.0, 1.0))));
}

glm::dvec2 offsetOf(const FaceRays& fan, glm::ivec2 ray) {
  return fan.spacing * glm::dvec2(ray);
}

/// The ray's slope per voxel along the positive axis.
glm::dvec2 slopeOf(const FaceRays& fan, glm::ivec2 ray) {
  return fan.slope + offsetOf(fan, ray) * fan.convergence;
}

/// The point where the ray meets the plane at this coordinate of the axis.
glm::dvec2 meets(const FaceRays& fan, glm::ivec2 ray, int coordinate) {
  return fan.origin + offsetOf(fan, ray) + slopeOf(fan, ray) * (coordinate - fan.farthest);
}

class RayMarch {
 public:
  RayMarch(const Volume& volume, std::span<const double> extinction, const RaySource& source)
      : volume_(volume), extinction_(extinction), source_(source) {}

  /// Writes the codes of one ray.
  void run(const FaceRays& fan, glm::ivec2 ray, std::vector<std::uint16_t>& codes) const;

 private:
  double extinctionAt(int axis, int plane, glm::ivec2 side) const;
  double interpolated(int axis, int plane, glm::dvec2 side) const;
  double sourceCut(const FaceRays& fan, glm::ivec2 ray) const;

  const Volume& volume_;
  const std::span<const double> extinction_;
  const RaySource source_;
};

double RayMarch::extinctionAt(int axis, int plane, glm::ivec2 side) const {
  glm::ivec3 v;
  v[axis] = plane;
  v[(axis + 1) % 3] = side.x;
  v[(axis + 2) % 3] = side.y;
  const glm::ivec3 n = volume_.dimensions;
  if (v.x < 0 || v.y < 0 || v.z < 0 || v.x >= n.x || v.y >= n.y || v.z >= n.z) return 0.0;
  return extinction_[volume_.at(v.x, v.y, v.z)];
}

double RayMarch::interpolated(int axis, int plane, glm::dvec2 side) const {
  const glm::ivec2 low(glm::floor(side));
  double sum = 0.0;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const glm::ivec2 corner = low + glm::ivec2(a, b);
      const glm::dvec2 share = 1.0 - glm::abs(side - glm::dvec2(corner));
      sum += share.x * share.y * extinctionAt(axis, plane, corner);
    }
  return sum;
}

/// For a ray that starts inside the volume, the path in front of its first layer, in layers: the extinction
/// along it is linear between the planes on both sides of the source. Negative if the source is in that
/// layer.
double RayMarch::sourceCut(const FaceRays& fan, glm::ivec2 ray) const {
  if (source_.atInfinity) return 0.0;
  const double distance = std::min(std::abs(fan.firstPlane - source_.place[fan.axis]), 1.0);
  const auto at = [&](int plane) { return interpolated(fan.axis, plane, meets(fan, ray, plane)); };
  const double first = at(fan.firstPlane), before = at(fan.firstPlane - fan.direction);
  const double source = distance * before + (1.0 - distance) * first;
  return distance * (source + first) / 2.0 - first / 2.0;
}

void RayMarch::run(const FaceRays& fan, glm::ivec2 ray, std::vector<std::uint16_t>& codes) const {
  const glm::dvec2 slope = slopeOf(fan, ray);
  glm::dvec3 step;
  step[fan.axis] = 1.0;
  step[(fan.axis + 1) % 3] = slope.x;
  step[(fan.axis + 2) % 3] = slope.y;
  const double layer = glm::length(glm::dmat3(volume_.indexToWorld) * step);
  double depth = layer * sourceCut(fan, ray);
  for (int k = 0; k < fan.planeCount; ++k) {
    const int plane = fan.firstPlane + fan.direction * k;
    codes[std::size_t(ray.x) + std::size_t(fan.rayCount.x) * std::size_t(ray.y) +
          std::size_t(fan.rays()) * std::size_t(k)] = encodeRayDepth(depth);
    depth += layer * interpolated(fan.axis, plane, meets(fan, ray, plane));
  }
}

}  // namespace

RayCodes referenceRays(const Volume& volume, std::span<const double> extinction, const RaySource& source) {
  FV_CHECK_EQ(extinction.size(), volume.voxelCount());
  const RayMarch march(volume, extinction, source);
  const std::array<FaceRays, 6> fans = faceRays(volume.dimensions, source);
  RayCodes codes;
  for (std::size_t f = 0; f < fans.size(); ++f) {
    const FaceRays& fan = fans[f];
    codes[f].resize(fan.rays() * std::size_t(fan.planeCount));
    if (codes[f].empty()) continue;
    tbb::parallel_for(0, fan.rayCount.y, [&](int j) {
      for (int i = 0; i < fan.rayCount.x; ++i) march.run(fan, {i, j}, codes[f]);
    });
  }
  return codes;
}

double decodeRayDepth(std::uint16_t code) {
  const double part = code / 65535.0;
  return kOpaqueDepth * part * part;
}

bool isReadAt(const FaceRays& fan, glm::ivec3 dimensions, glm::ivec2 ray, int plane) {
  const glm::dvec2 place = meets(fan, ray, fan.firstPlane + fan.direction * plane);
  const glm::dvec2 last(dimensions[(fan.axis + 1) % 3] - 1, dimensions[(fan.axis + 2) % 3] - 1);
  const double reach = 2.0 * fan.spacing;  // of the spline, where the rays are farthest apart
  return glm::all(glm::greaterThanEqual(place, glm::dvec2(-reach))) &&
         glm::all(glm::lessThanEqual(place, last + reach));
}

}  // namespace freevoxels
