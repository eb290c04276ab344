#include <algorithm>
#include <cmath>

#include "engine/description/flight_description.h"
#include "engine/description/scene_description.h"
#include "engine/scene/orbit.h"

namespace freevoxels {

namespace {

/// The camera of what is given.
Camera given(const CameraDescription& description, glm::dvec3 upwards = {0.0, 1.0, 0.0}) {
  Camera camera{.up = description.up.value_or(upwards)};
  camera.lookAt = description.lookAt.value_or(camera.lookAt);
  camera.position = description.position.value_or(camera.position);
  camera.verticalFov = description.verticalFov.value_or(camera.verticalFov);
  camera.orthographic = description.orthographicHeight.has_value();
  camera.orthographicHeight = description.orthographicHeight.value_or(camera.orthographicHeight);
  return camera;
}

/// An axis of the world that is not along the view.
glm::dvec3 axisAcross(glm::dvec3 view) {
  return std::abs(view.y) > std::abs(view.x) ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
}

}  // namespace

void CameraDescription::look(const Camera& from) {
  *this = {.position = from.position, .lookAt = from.lookAt, .up = from.up, .size = size, .frames = frames, .holdout = holdout};
  if (from.orthographic)
    orthographicHeight = from.orthographicHeight;
  else
    verticalFov = from.verticalFov;
}

std::shared_ptr<const Holdout> CameraDescription::readHoldout() const {
  if (!holdout) return nullptr;
  std::shared_ptr<const Holdout> read = freevoxels::readHoldout(*holdout);
  checkHoldoutSize(*read, size);
  return read;
}

void CameraDescription::check() const {
  if (flight) {
    readFlight(*flight);
    return;
  }
  Camera camera = given(*this);
  const bool isPlaced = position && lookAt;
  if (!isPlaced) {
    camera.position = glm::dvec3(0.0, 0.0, 1.0);
    camera.lookAt = glm::dvec3(0.0);
  }
  // The up direction of the volume, or the view, is not known here.
  if (!up || (!isPlaced && *up != glm::dvec3(0.0))) camera.up = axisAcross(camera.lookAt - camera.position);
  checkCamera(camera);
}

glm::dvec2 CameraDescription::angles() const {
  return orbit.value_or(glm::dvec2(kDefaultAzimuth, kDefaultElevation));
}

std::vector<Camera> CameraDescription::resolve(const Volume& volume, const std::function<Subject()>& content, int frameCount) const {
  if (flight) {
    std::vector<Camera> cameras;
    for (FrameView& view : flightViews(*flight, volume, frameCount)) cameras.push_back(view.camera);
    return cameras;
  }
  const Camera base = given(*this, volume.up);
  if (position && lookAt) {
    checkCamera(base);
    return orbitAboutUp(base, frameCount);
  }
  Subject subject = content();
  if (position) {
    Camera start = base;
    start.lookAt = subject.centre;
    checkCamera(start);
    return orbitAboutUp(start, frameCount);
  }
  const double aspect = double(size.x) / double(size.y);
  if (frameCount == 1 && !lookAt)
    subject.centre = imageCentre(framingCamera(subject, angles().x, angles().y, aspect, base), subject);
  std::vector<Camera> cameras = framingOrbit(subject, angles().x, angles().y, frameCount, aspect, base);
  for (Camera& camera : cameras) {
    const glm::dvec3 at = lookAt.value_or(camera.lookAt);
    camera.position = at + (camera.position - camera.lookAt);
    camera.lookAt = at;
    camera.orthographicHeight = base.orthographicHeight;
    checkCamera(camera);
  }
  return cameras;
}

}  // namespace freevoxels
