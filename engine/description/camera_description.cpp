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
  if (position && lookAt) {
    checkCamera(given(*this));
    return;
  }
  Camera lens = given(*this);
  lens.position = glm::dvec3(0.0, 0.0, 1.0);
  lens.lookAt = glm::dvec3(0.0);
  lens.up = up && *up == glm::dvec3(0.0) ? *up : glm::dvec3(0.0, 1.0, 0.0);
  checkCamera(lens);
}

glm::dvec2 CameraDescription::angles() const {
  return orbit.value_or(glm::dvec2(kDefaultAzimuth, kDefaultElevation));
}

std::vector<Camera> CameraDescription::resolve(glm::dvec3 upOfVolume, const std::function<Subject()>& content, int frameCount) const {
  const Camera base = given(*this, upOfVolume);
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
