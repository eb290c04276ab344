#include "engine/scene/flight.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <span>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// The length of a sum of unit vectors below which it has no usable direction.
constexpr double kNoDirection = 1e-6;

/// A segment from one key to the next one, and the fraction of its time that has passed: 0 at a key.
struct FlightPlace {
  std::size_t before = 0;
  double part = 0.0;
};

FlightPlace placeAt(std::span<const FlightKey> keys, double time) {
  const auto next = std::ranges::upper_bound(keys, time, {}, &FlightKey::time);
  if (next == keys.begin()) return {};
  const auto before = std::size_t(next - keys.begin()) - 1;
  if (next == keys.end()) return {.before = before};
  return {.before = before, .part = (time - keys[before].time) / (next->time - keys[before].time)};
}

/// The change of a value, a number or a vector that `valueOf` gives of a key, since the key before a place that is no key.
template <typename ValueOf>
auto changeSince(std::span<const FlightKey> keys, FlightPlace place, const ValueOf& valueOf) {
  const std::size_t before = place.before, after = before + 1;
  const double length = keys[after].time - keys[before].time;
  // The derivative at a key, times the length of the segment, of which the neighbours' time is not less.
  const auto tangent = [&](std::size_t key) {
    const FlightKey &last = keys[key == 0 ? 0 : key - 1], &next = keys[std::min(key + 1, keys.size() - 1)];
    return (valueOf(next) - valueOf(last)) * (length / (next.time - last.time));
  };
  const double s = place.part, rest = 1.0 - s;
  return (valueOf(keys[after]) - valueOf(keys[before])) * (s * s * (3.0 - 2.0 * s)) + tangent(before) * (s * rest * rest) -
         tangent(after) * (s * s * rest);
}

glm::dvec3 unitUp(const FlightKey& key) {
  return glm::normalize(key.camera.up);
}

/// The direction that is up half-way along the rotation from one camera's orientation to another's.
glm::dvec3 upBetween(const Camera& before, const Camera& after) {
  const auto orientation = [](const Camera& camera) { return glm::quat_cast(glm::transpose(glm::dmat3(worldToCamera(camera)))); };
  return glm::slerp(orientation(before), orientation(after), 0.5) * glm::dvec3(0.0, 1.0, 0.0);
}

glm::dvec3 upAt(std::span<const FlightKey> keys, FlightPlace place) {
  const FlightKey &before = keys[place.before], &after = keys[place.before + 1];
  glm::dvec3 up = unitUp(before) + changeSince(keys, place, unitUp);
  // Ups that are more than a right angle apart would come near 0 on the way. This moves them aside, and has no slope at the keys.
  const double apart = -glm::dot(unitUp(before), unitUp(after)), bow = 4.0 * place.part * (1.0 - place.part);
  if (apart > 0.0) up += apart * bow * bow * upBetween(before.camera, after.camera);
  const double length = glm::length(up);
  return length > kNoDirection ? up / length : unitUp(before);
}

/// Half the height of what a perspective camera sees at distance 1.
double halfTangent(const Camera& camera) {
  return std::tan(glm::radians(camera.verticalFov) / 2.0);
}

/// Equal differences of it are equal factors of the size of things on the image.
double logHeight(const FlightKey& key) {
  return std::log(key.camera.orthographic ? key.camera.orthographicHeight : halfTangent(key.camera));
}

/// Changes the height of what a camera sees by the exponential of `change`. It stays exactly as it is for 0.
void changeHeight(Camera& camera, double change) {
  if (camera.orthographic) {
    camera.orthographicHeight *= std::exp(change);
    return;
  }
  const double tangent = halfTangent(camera);
  // The difference of two arcus tangents.
  camera.verticalFov += 2.0 * glm::degrees(std::atan2(tangent * std::expm1(change), 1.0 + tangent * tangent * std::exp(change)));
}

Light mixedLight(const Light& before, const Light& after, double part) {
  Light light = before;
  light.color += (after.color - before.color) * part;
  light.intensity += (after.intensity - before.intensity) * part;
  if (before.place == after.place) return light;
  if (!before.atInfinity) {
    light.place += (after.place - before.place) * part;
    return light;
  }
  light.place = glm::normalize(before.place) * (1.0 - part) + glm::normalize(after.place) * part;
  const double length = glm::length(light.place);
  light.place = length > kNoDirection ? light.place / length : before.place;
  return light;
}

}  // namespace

double Flight::timeOfFrame(int frame, int frames) const {
  FV_CHECK_LT(frame, frames);
  const double first = keys.front().time, last = keys.back().time;
  if (frame == 0) return first;
  return frame == frames - 1 ? last : first + (last - first) * frame / (frames - 1);
}

Camera Flight::cameraAt(double time) const {
  const FlightPlace place = placeAt(keys, time);
  Camera camera = keys[place.before].camera;
  if (place.part == 0.0) {
    camera.up = glm::normalize(camera.up);
    return camera;
  }
  camera.position += changeSince(keys, place, [](const FlightKey& key) { return key.camera.position; });
  camera.lookAt += changeSince(keys, place, [](const FlightKey& key) { return key.camera.lookAt; });
  camera.up = upAt(keys, place);
  changeHeight(camera, changeSince(keys, place, logHeight));
  return camera;
}

std::vector<Light> Flight::lightsAt(double time) const {
  const auto hasLights = [](const FlightKey& key) { return !key.lights.empty(); };
  const auto next = std::ranges::upper_bound(keys, time, {}, &FlightKey::time);
  const auto before = std::find_if(std::make_reverse_iterator(next), keys.rend(), hasLights);
  const auto after = std::find_if(next, keys.end(), hasLights);
  if (before == keys.rend()) return after == keys.end() ? std::vector<Light>() : after->lights;
  std::vector<Light> lights = before->lights;
  if (after == keys.end() || time == before->time || !std::ranges::equal(lights, after->lights, {}, &Light::atInfinity, &Light::atInfinity))
    return lights;
  const double part = (time - before->time) / (after->time - before->time);
  for (std::size_t i = 0; i < lights.size(); ++i) lights[i] = mixedLight(lights[i], after->lights[i], part);
  return lights;
}

}  // namespace freevoxels
