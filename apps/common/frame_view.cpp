#include "apps/common/frame_view.h"

#include "engine/core/error.h"
#include "engine/scene/orbit.h"

namespace freevoxels {

namespace {

Camera cameraIn(const Scene& film, const CameraDescription& own, const CameraDescription& given) {
  CameraDescription resized = own;
  resized.size = given.size;
  if (given == resized) return film.camera;
  const auto content = [] { return Subject{}; };
  if (given.flight) return given.resolve(*film.volume, content, 1).front();
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
  const Camera camera = seen.resolve(*film.volume, content, 1).front();
  const bool isMoved = !given.position && (own.position || own.flight || given.angles() != own.angles());
  return isMoved ? movedTo(given.angles(), given.up.value_or(film.volume->up), camera) : camera;
}

Classification classificationIn(const Scene& film, const ClassificationDescription& own, const ClassificationDescription& given) {
  Classification seen = film.classification;
  if (given == own) return seen;
  if (given.transferFunction || given.window != own.window || (given.densityScale && seen.transferFunction)) {
    const Classification replaced = given.resolve(*film.volume, seen.emission.has_value());
    seen.transferFunction = replaced.transferFunction;
    seen.order = replaced.order;
    seen.densityScale = replaced.densityScale;
    seen.albedo = replaced.albedo;
    return seen;
  }
  const TransferChange change{.opacity = given.opacity.value_or(1.0) / own.opacity.value_or(1.0), .inverted = given.invert != own.invert};
  if (seen.transferFunction) seen.transferFunction = changed(*seen.transferFunction, change);
  seen.densityScale = given.densityScale ? *given.densityScale * given.opacity.value_or(1.0) : seen.densityScale * change.opacity;
  if (given.albedo) seen.albedo = glm::vec3(*given.albedo);
  return seen;
}

std::optional<Emission> emissionIn(const Scene& film, const EmissionDescription& own, const EmissionDescription& given) {
  std::optional<Emission> seen = film.classification.emission;
  if (given == own) return seen;
  if (given.emission == false) return std::nullopt;
  if (!seen && given.isAsked())
    fail(ErrorKind::Usage, "the film does not shine, and a frame of it cannot: give {} for the whole sequence", Parameter("emission"));
  if (seen) {
    seen->strength = given.strength.value_or(seen->strength);
    seen->temperatureScale = given.temperatureScale.value_or(seen->temperatureScale);
    seen->temperatureOffset = given.temperatureOffset.value_or(seen->temperatureOffset);
  }
  return seen;
}

}  // namespace

Camera movedTo(glm::dvec2 orbit, glm::dvec3 up, Camera camera) {
  const double distance = glm::length(camera.position - camera.lookAt);
  camera.up = up;
  const Camera there = framingCamera({.points = {glm::dvec3(-1.0), glm::dvec3(1.0)}}, orbit.x, orbit.y, 1.0, camera);
  camera.up = there.up;
  camera.position = camera.lookAt + distance * glm::normalize(there.position - there.lookAt);
  return camera;
}

Scene filmWith(const Scene& film, const SceneDescription& own, const SceneDescription& given) {
  Scene seen = film;
  seen.camera = cameraIn(film, own.camera, given.camera);
  if (given.lighting != own.lighting || given.camera.flight != own.camera.flight)
    seen.lighting = given.resolveLighting(*film.volume, film.classification, film.camera);
  if (film.volume->classificationIsFixed) return seen;
  seen.classification = classificationIn(film, own.classification, given.classification);
  seen.classification.emission = emissionIn(film, own.emission, given.emission);
  return seen;
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
