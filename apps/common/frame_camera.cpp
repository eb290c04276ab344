#include "apps/common/frame_camera.h"

#include "engine/scene/orbit.h"

namespace freevoxels {

Camera movedTo(glm::dvec2 orbit, glm::dvec3 up, Camera camera) {
  const double distance = glm::length(camera.position - camera.lookAt);
  camera.up = up;
  const Camera there = framingCamera({.points = {glm::dvec3(-1.0), glm::dvec3(1.0)}}, orbit.x, orbit.y, 1.0, camera);
  camera.up = there.up;
  camera.position = camera.lookAt + distance * glm::normalize(there.position - there.lookAt);
  return camera;
}

Camera cameraInFilm(const Scene& film, const CameraDescription& own, const CameraDescription& given) {
  CameraDescription resized = own;
  resized.size = given.size;
  if (given == resized) return film.camera;
  CameraDescription seen;
  seen.look(film.camera);
  seen.size = given.size;
  if (given.position) seen.position = given.position;
  if (given.lookAt) seen.lookAt = given.lookAt;
  if (given.up) seen.up = given.up;
  if (given.verticalFov || given.orthographicHeight) {
    seen.verticalFov = given.verticalFov;
    seen.orthographicHeight = given.orthographicHeight;
  }
  const Camera camera = seen.resolve(film.volume->up, [] { return Subject{}; }, 1).front();
  const bool isMoved = !given.position && (own.position || given.angles() != own.angles());
  return isMoved ? movedTo(given.angles(), given.up.value_or(film.volume->up), camera) : camera;
}

nlohmann::json keywordsOf(const Camera& camera, glm::ivec2 size) {
  using Json = nlohmann::json;
  CameraDescription given;
  given.look(camera);
  const auto triple = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
  Json keywords{{"camera-position", triple(*given.position)}, {"look-at", triple(*given.lookAt)}, {"up", triple(*given.up)}};
  if (given.orthographicHeight) keywords["orthographic"] = *given.orthographicHeight;
  if (given.verticalFov) keywords["fov"] = *given.verticalFov;
  keywords["size"] = {size.x, size.y};
  return keywords;
}

}  // namespace freevoxels
