#include "apps/view/navigation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr double kPoleMargin = 0.01;  // radians between the line of sight and `up`

struct Axes {
  glm::dvec3 right, up, ahead;
};

Axes axesOf(const Camera& camera) {
  const glm::dmat4 rows = glm::transpose(worldToCamera(camera));
  return {glm::dvec3(rows[0]), glm::dvec3(rows[1]), -glm::dvec3(rows[2])};
}

glm::dvec3 rotated(glm::dvec3 vector, glm::dvec3 axis, double angle) {
  return vector * std::cos(angle) + glm::cross(axis, vector) * std::sin(angle) +
         axis * glm::dot(axis, vector) * (1.0 - std::cos(angle));
}

/// `vector`, which the camera looks along or against, turned by angles about the pole and about the camera's right; not beyond the poles.
glm::dvec3 swung(glm::dvec3 vector, const Camera& camera, glm::dvec3 pole, double around, double upwards) {
  pole = glm::normalize(pole);
  const double toPole = std::acos(std::clamp(glm::dot(glm::normalize(vector), pole), -1.0, 1.0));
  const double within = toPole - std::clamp(toPole - upwards, kPoleMargin, glm::pi<double>() - kPoleMargin);
  const glm::dvec3 across = glm::cross(vector, pole);
  const Axes axes = axesOf(camera);
  const double facing = glm::dot(vector, axes.ahead) > 0.0 ? 1.0 : -1.0;
  // Along the pole, the right of the image says which way is round.
  const glm::dvec3 side = glm::length(across) > 1e-3 * glm::length(vector) ? glm::normalize(across) : facing * axes.right;
  return rotated(rotated(vector, side, within), pole, around);
}

double heightAtLookAt(const Camera& camera) {
  if (camera.orthographic) return camera.orthographicHeight;
  return 2.0 * glm::distance(camera.position, camera.lookAt) *
         std::tan(0.5 * glm::radians(camera.verticalFov));
}

}  // namespace

Camera orbited(const Camera& camera, const glm::dvec3& pole, glm::dvec2 drag) {
  Camera moved = camera;
  const glm::dvec3 arm = camera.position - camera.lookAt;
  moved.position = camera.lookAt + swung(arm, camera, pole, -glm::pi<double>() * drag.x, -glm::pi<double>() * drag.y);
  moved.up = pole;
  return moved;
}

Camera panned(const Camera& camera, glm::dvec2 drag) {
  const Axes axes = axesOf(camera);
  const glm::dvec3 way = -heightAtLookAt(camera) * (drag.x * axes.right + drag.y * axes.up);
  Camera moved = camera;
  moved.position += way;
  moved.lookAt += way;
  return moved;
}

Camera dollied(const Camera& camera, double factor) {
  FV_CHECK_LT(0.0, factor);
  Camera moved = camera;
  moved.position = camera.lookAt + factor * (camera.position - camera.lookAt);
  moved.orthographicHeight *= factor;
  return moved;
}

Camera turned(const Camera& camera, const glm::dvec3& pole, glm::dvec2 drag) {
  Camera moved = camera;
  const double field = glm::radians(camera.orthographic ? Camera{}.verticalFov : camera.verticalFov);
  moved.lookAt = camera.position + swung(camera.lookAt - camera.position, camera, pole, -field * drag.x, field * drag.y);
  moved.up = pole;
  return moved;
}

Camera flown(const Camera& camera, glm::dvec3 way) {
  const Axes axes = axesOf(camera);
  const glm::dvec3 step = way.x * axes.right + way.y * axes.up + way.z * axes.ahead;
  Camera moved = camera;
  moved.position += step;
  moved.lookAt += step;
  return moved;
}

Camera alongAxis(const Camera& camera, const glm::dvec3& pole, int axis) {
  FV_CHECK_LT(axis, 6);
  glm::dvec3 side(0.0);
  side[axis / 2] = axis % 2 == 0 ? 1.0 : -1.0;
  Camera moved = camera;
  moved.position = camera.lookAt + glm::distance(camera.position, camera.lookAt) * side;
  const double alongPole = glm::dot(side, glm::normalize(pole));
  const glm::dvec3 front = std::abs(pole.z) > std::abs(pole.y) ? glm::dvec3(0.0, -1.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
  constexpr double kParallel = 0.999;
  moved.up = std::abs(alongPole) < kParallel ? pole : alongPole > 0.0 ? -front : front;
  return moved;
}

Camera withOtherProjection(const Camera& camera) {
  Camera other = camera;
  other.orthographic = !camera.orthographic;
  if (other.orthographic) {
    other.orthographicHeight = heightAtLookAt(camera);
  } else {
    const double distance =
        0.5 * camera.orthographicHeight / std::tan(0.5 * glm::radians(camera.verticalFov));
    other.position = camera.lookAt + distance * glm::normalize(camera.position - camera.lookAt);
  }
  return other;
}

}  // namespace freevoxels
