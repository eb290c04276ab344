#include "engine/scene/orbit.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

double degreesOfFrame(int frame, int frames) {
  return 360.0 * frame / frames;
}

}  // namespace

std::vector<Camera> framingOrbit(const Subject& subject, double azimuth, double elevation, int frames, double aspect,
                                 const Camera& base) {
  FV_CHECK_LT(0, frames);
  std::vector<Camera> orbit;
  double distance = 0.0, height = 0.0;
  for (int frame = 0; frame < frames; ++frame) {
    const Camera camera =
        framingCamera(subject, azimuth + degreesOfFrame(frame, frames), elevation, aspect, base);
    distance = std::max(distance, glm::length(camera.position - camera.lookAt));
    height = std::max(height, camera.orthographicHeight);
    orbit.push_back(camera);
  }
  for (Camera& camera : orbit) {
    const glm::dvec3 toEye = camera.position - camera.lookAt;
    camera.position = camera.lookAt + toEye * (distance / glm::length(toEye));
    camera.orthographicHeight = height;
  }
  return orbit;
}

std::vector<Camera> orbitAboutUp(const Camera& start, int frames) {
  FV_CHECK_LT(0, frames);
  std::vector<Camera> orbit(std::size_t(frames), start);
  const glm::dvec3 axis = glm::normalize(start.up), toEye = start.position - start.lookAt;
  for (int frame = 1; frame < frames; ++frame) {
    const double angle = glm::radians(degreesOfFrame(frame, frames));
    orbit[std::size_t(frame)].position =
        start.lookAt + glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, axis)) * toEye;
  }
  return orbit;
}

}  // namespace freevoxels
