// Conventions: world space is right-handed; the camera looks along -z of its own space, x to the right, y up.
// Pixels count from the top left corner of the image, x to the right and y down, so that the centre of pixel
// (i, j) is at (i + 1/2, j + 1/2).

#include "engine/scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Sine of the smallest angle between the view and `up`.
constexpr double kMinUpAngle = 1e-6;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

bool isFinite(glm::dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Axes {
  glm::dvec3 right, up, forward;
};

Axes cameraAxes(const Camera& camera) {
  const glm::dvec3 forward = glm::normalize(camera.lookAt - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  return {right, glm::cross(right, forward), forward};
}

/// Half the height of the visible area: at distance 1 for a perspective camera, at any distance for an
/// orthographic one.
double halfHeight(const Camera& camera) {
  return camera.orthographic ? camera.orthographicHeight / 2.0 : std::tan(radians(camera.verticalFov) / 2.0);
}

/// The rotation from +y to `up` on the shortest way.
glm::dmat3 fromYUp(glm::dvec3 up) {
  const glm::dvec3 y(0.0, 1.0, 0.0), to = glm::normalize(up);
  if (glm::length(glm::cross(y, to)) < kMinUpAngle) {
    const double side = to.y < 0.0 ? -1.0 : 1.0;
    return glm::dmat3({1.0, 0.0, 0.0}, {0.0, side, 0.0}, {0.0, 0.0, side});
  }
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), std::acos(std::clamp(to.y, -1.0, 1.0)), glm::cross(y, to)));
}

}  // namespace

void checkCamera(const Camera& camera) {
  if (!isFinite(camera.position))
    fail(ErrorKind::Usage, "the camera position is not a finite number; change {}", Parameter("camera-position"));
  if (!isFinite(camera.lookAt))
    fail(ErrorKind::Usage, "the look-at point is not a finite number; change {}", Parameter("look-at"));
  if (!isFinite(camera.up)) fail(ErrorKind::Usage, "the up vector is not a finite number; change {}", Parameter("up"));
  const glm::dvec3 view = camera.lookAt - camera.position;
  const double distance = glm::length(view);
  const double scale = std::max(glm::length(camera.position), glm::length(camera.lookAt));
  if (!std::isfinite(distance))
    fail(ErrorKind::Usage,
         "the camera is too far away to compute with; change {} or {}", Parameter("camera-position"), Parameter("look-at"));
  if (!(distance > 1e-12 * scale))
    fail(ErrorKind::Usage, "the camera stands at its look-at point; change {} or {}", Parameter("camera-position"), Parameter("look-at"));
  const double upLength = glm::length(camera.up);
  if (!(upLength > 0.0) || !std::isfinite(upLength))
    fail(ErrorKind::Usage, "the up vector has no usable length; change {}", Parameter("up"));
  if (glm::length(glm::cross(view / distance, camera.up / upLength)) < kMinUpAngle)
    fail(ErrorKind::Usage, "the up vector points along the view; change {}", Parameter("up"));
  if (camera.orthographic) {
    if (!(camera.orthographicHeight > 0.0) || !std::isfinite(camera.orthographicHeight))
      fail(ErrorKind::Usage, "the height {} of the orthographic image is not above 0; change {}",
           camera.orthographicHeight, Parameter("orthographic"));
  } else if (!(camera.verticalFov > 0.0 && camera.verticalFov < 180.0)) {
    fail(ErrorKind::Usage, "the field of view {} is not between 0 and 180 degrees; change {}",
         camera.verticalFov, Parameter("fov"));
  }
}

glm::dmat4 worldToCamera(const Camera& camera) {
  const Axes axes = cameraAxes(camera);
  const std::array<glm::dvec3, 3> rows = {axes.right, axes.up, -axes.forward};
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = rows[std::size_t(row)][column];
    matrix[3][row] = -glm::dot(rows[std::size_t(row)], camera.position);
  }
  return matrix;
}

glm::dmat4 worldToNdc(const Camera& camera, double aspect) {
  const double half = halfHeight(camera);
  glm::dmat4 projection(0.0);
  projection[0][0] = 1.0 / (half * aspect);
  projection[1][1] = 1.0 / half;
  if (camera.orthographic) {
    projection[2][2] = -1.0;  // z is the distance t from the eye plane
    projection[3][3] = 1.0;
  } else {
    projection[3][2] = 1.0;  // z is 1/t: the matrix stays invertible without a near or far plane
    projection[2][3] = -1.0;
  }
  return projection * worldToCamera(camera);
}

glm::dvec3 orbitDirection(glm::dvec3 up, double azimuth, double elevation) {
  const double az = radians(azimuth), el = radians(elevation);
  return fromYUp(up) * glm::dvec3(std::sin(az) * std::cos(el), std::sin(el), std::cos(az) * std::cos(el));
}

Camera framed(const Camera& camera, const Subject& subject, double aspect) {
  const Axes axes = cameraAxes(camera);
  // Radius of the points; half the image's height; distance from the centre to the eye.
  double radius = 0.0, halfImage = 0.0, distance = 0.0;
  for (const glm::dvec3& point : subject.points) {
    const glm::dvec3 offset = point - subject.centre;
    const double needed = (1.0 + subject.margin) *
                          std::max(std::abs(glm::dot(offset, axes.up)), std::abs(glm::dot(offset, axes.right)) / aspect);
    radius = std::max(radius, glm::length(offset));
    halfImage = std::max(halfImage, needed);
    distance = std::max(distance, needed / halfHeight(camera) - glm::dot(offset, axes.forward));
  }
  Camera moved = camera;
  if (camera.orthographic) moved.orthographicHeight = 2.0 * halfImage;
  moved.lookAt = subject.centre;
  moved.position = subject.centre - (camera.orthographic ? 2.0 * radius : distance) * axes.forward;
  return moved;
}

glm::dvec3 imageCentre(const Camera& camera, const Subject& subject) {
  const Axes axes = cameraAxes(camera);
  // A point at x beside the axis and nearer to the eye by z is seen at x / (d - z) from the distance d. The
  // axis is moved to where the largest x + t z equals the largest -x + t z, with t the tangent of half the
  // field of view.
  const double tangent = camera.orthographic ? 0.0 : halfHeight(camera);
  glm::dvec3 centre = subject.centre;
  for (const glm::dvec3& axis : {axes.right, axes.up}) {
    double low = std::numeric_limits<double>::max(), high = -low;
    for (const glm::dvec3& point : subject.points) {
      const glm::dvec3 offset = point - subject.centre;
      const double across = glm::dot(offset, axis), nearer = -tangent * glm::dot(offset, axes.forward);
      low = std::min(low, across - nearer);
      high = std::max(high, across + nearer);
    }
    if (low <= high) centre += 0.5 * (low + high) * axis;
  }
  return centre;
}

Camera framingCamera(const Subject& subject, double azimuth, double elevation, double aspect, const Camera& base) {
  const glm::dvec3 toEye = orbitDirection(base.up, azimuth, elevation);
  Camera camera = base;
  camera.lookAt = glm::dvec3(0.0);
  camera.position = toEye;
  // Straight above or below, `up` does not determine the roll. Use the limit of lower elevations.
  if (glm::length(glm::cross(glm::normalize(base.up), toEye)) < kMinUpAngle) camera.up = orbitDirection(base.up, azimuth, elevation + 90.0);
  return framed(camera, subject, aspect);
}

RaySource eyeSource(const Camera& camera, const glm::dmat4& indexToWorld) {
  const glm::dmat4 worldToIndex = glm::inverse(indexToWorld);
  if (camera.orthographic)
    return {.place = glm::dmat3(worldToIndex) * (camera.position - camera.lookAt), .atInfinity = true};
  return {.place = glm::dvec3(worldToIndex * glm::dvec4(camera.position, 1.0))};
}

bool eyeIsInside(const Camera& camera, glm::ivec3 dimensions, const glm::dmat4& indexToWorld) {
  return isInside(eyeSource(camera, indexToWorld), dimensions);
}

PixelRays PixelRays::countedFrom(glm::dvec2 position) const {
  PixelRays moved = *this;
  moved.origin += position.x * originX + position.y * originY;
  moved.direction += position.x * directionX + position.y * directionY;
  return moved;
}

glm::dmat3 PixelRays::indexToPixel() const {
  return glm::inverse(orthographic ? glm::dmat3(originX, originY, direction) : glm::dmat3(directionX, directionY, direction));
}

PixelRays pixelRays(const Camera& camera, glm::ivec2 imageSize, const glm::dmat4& indexToWorld) {
  const glm::dmat4 worldToIndex = glm::inverse(indexToWorld);
  const glm::dmat3 linear(worldToIndex);
  const Axes axes = cameraAxes(camera);
  const glm::dvec2 size(imageSize);
  // Both cameras have square pixels: the width follows from the height.
  const double half = halfHeight(camera);
  const double pixel = 2.0 * half / size.y;
  const glm::dvec3 stepX = linear * (axes.right * pixel);
  const glm::dvec3 stepY = linear * (axes.up * -pixel);
  const glm::dvec3 topLeft = linear * (axes.up * half - axes.right * (half * size.x / size.y));

  PixelRays rays{};
  rays.orthographic = camera.orthographic;
  rays.origin = glm::dvec3(worldToIndex * glm::dvec4(camera.position, 1.0));
  rays.direction = linear * axes.forward;
  if (camera.orthographic) {
    rays.origin += topLeft;
    rays.originX = stepX;
    rays.originY = stepY;
  } else {
    rays.direction += topLeft;
    rays.directionX = stepX;
    rays.directionY = stepY;
  }
  return rays;
}

}  // namespace freevoxels
