#include "engine/validation/fly_through.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Oblique to all axes and diagonals.
const glm::dvec3 kCourse = glm::normalize(glm::dvec3(-0.55, -0.35, -0.76));
constexpr double kFarthest = 1.5;                       ///< in longest edges of the box
constexpr double kTurnBegins = 0.35, kTurnEnds = 0.65;  ///< as fractions of the path

glm::dvec3 turned(glm::dvec3 view, double angle) {
  return {view.x * std::cos(angle) + view.z * std::sin(angle), view.y * std::cos(angle),
          view.z * std::cos(angle) - view.x * std::sin(angle)};
}

}  // namespace

std::vector<Camera> flyThrough(const Volume& volume, int frames) {
  FV_CHECK_LT(1, frames);
  const glm::dvec3 extent(volume.dimensions);
  const glm::dvec3 centre(volume.indexToWorld * glm::dvec4((extent - 1.0) / 2.0, 1.0));
  double edge = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    edge = std::max(edge, extent[axis] * glm::length(glm::dvec3(volume.indexToWorld[axis])));
  std::vector<Camera> cameras;
  for (int frame = 0; frame < frames; ++frame) {
    const double way = double(frame) / (frames - 1);
    const double turn = std::clamp((way - kTurnBegins) / (kTurnEnds - kTurnBegins), 0.0, 1.0);
    Camera camera;
    camera.verticalFov = 60.0;
    camera.position = centre + (2.0 * way - 1.0) * kFarthest * edge * kCourse;
    camera.lookAt = camera.position + edge * turned(kCourse, std::numbers::pi * turn);
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace freevoxels
