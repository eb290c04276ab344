#include "engine/validation/homogeneous_box.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace freevoxels {

namespace {

/// The box from -1/2 to dimensions - 1/2 in index space.
struct Box {
  glm::dvec3 low{-0.5}, high;

  /// Whether a ray with this direction that enters at `p` stays 2 voxels away from the other faces until it
  /// is 2 voxels inside.
  bool awayFromEdges(glm::dvec3 p, glm::dvec3 direction) const {
    const glm::dvec3 depth = glm::min(p - low, high - p), speed = glm::abs(direction);
    const int face = depth.x <= depth.y && depth.x <= depth.z ? 0 : depth.y <= depth.z ? 1 : 2;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != face && depth[axis] < 2.0 + 2.0 * speed[axis] / speed[face]) return false;
    return true;
  }
};

struct Chord {
  double length = 0.0;  ///< in lengths of the ray's direction
  bool interior = false;
};

Chord chordOf(const Box& box, glm::dvec3 origin, glm::dvec3 direction) {
  const glm::dvec3 a = (box.low - origin) / direction, b = (box.high - origin) / direction;
  const glm::dvec3 near = glm::min(a, b), far = glm::max(a, b);
  const double enter = std::max({near.x, near.y, near.z}), leave = std::min({far.x, far.y, far.z});
  if (!(leave > enter)) return {};
  return {leave - enter, box.awayFromEdges(origin + enter * direction, direction) &&
                             box.awayFromEdges(origin + leave * direction, direction)};
}

}  // namespace

glm::dmat4 cubeTransform(glm::ivec3 dimensions) {
  const double size = 1.0 / double(std::max({dimensions.x, dimensions.y, dimensions.z}));
  const glm::dmat4 scaled = glm::scale(glm::dmat4(1.0), glm::dvec3(size));
  return glm::translate(scaled, -0.5 * glm::dvec3(dimensions - 1));
}

glm::dmat4 shearedTransform(glm::ivec3 dimensions) {
  glm::dmat4 shear(1.0);
  shear[0] = {0.9, 0.2, 0.0, 0.0};
  shear[1] = {-0.3, 0.6, 0.1, 0.0};
  shear[2] = {0.1, 0.0, 1.4, 0.0};
  return shear * cubeTransform(dimensions);
}

int voxelsAhead(glm::ivec3 voxel, glm::ivec3 direction, glm::ivec3 dimensions) {
  int count = std::numeric_limits<int>::max();
  for (int axis = 0; axis < 3; ++axis)
    if (direction[axis] != 0)
      count = std::min(count, direction[axis] > 0 ? dimensions[axis] - 1 - voxel[axis] : voxel[axis]);
  return count;
}

BoxImage boxImage(const Volume& volume, double sigma, glm::vec3 color, const Camera& camera, glm::ivec2 size) {
  constexpr int kSamples = 4;
  const PixelRays rays = pixelRays(camera, size, volume.indexToWorld);
  const Box box{.high = glm::dvec3(volume.dimensions) - 0.5};
  BoxImage image{.image = {.size = size, .pixels = {}, .depth = {}}, .interior = {}};
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      double alpha = 0.0;
      bool interior = true;
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const double px = x + (sample % kSamples + 0.5) / kSamples;
        const double py = y + (sample / kSamples + 0.5) / kSamples;
        const glm::dvec3 direction = rays.direction + px * rays.directionX + py * rays.directionY;
        const Chord chord = chordOf(box, rays.origin + px * rays.originX + py * rays.originY, direction);
        const double world = glm::length(glm::dmat3(volume.indexToWorld) * direction);
        alpha += -std::expm1(-sigma * chord.length * world) / (kSamples * kSamples);
        interior = interior && chord.interior;
      }
      image.image.pixels.emplace_back(glm::dvec4(glm::dvec3(color) * alpha, alpha));
      image.interior.push_back(interior);
    }
  return image;
}

}  // namespace freevoxels
