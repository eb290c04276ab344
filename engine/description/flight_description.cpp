#include "engine/description/flight_description.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/description/scene_fields.h"
#include "engine/description/scene_json.h"
#include "engine/description/text_values.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

constexpr const char *kFlight = "flight", *kFlightKeys = "keys", *kFlightTime = "time";
/// The fields of a scene that a key has.
constexpr std::array<std::string_view, 6> kFlightFields{"camera-position", "look-at", "up", "fov", "orthographic", "light"};
constexpr double kMostFlightTime = 1e30;

/// What sentences call a flight, and one of its keys.
std::string flightName(const std::string& text) {
  return fmt::format("{} '{}'", kFlight, isInlineJson(text) ? "inline" : printable(text));
}
std::string keyName(const std::string& flight, std::size_t index) {
  return fmt::format("{}: key {}", flight, index + 1);
}

/// Runs `work`, whose errors are of what `place` calls.
template <typename Work>
auto inFlight(const std::string& place, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    fail(ErrorKind::Input, "{}: {}", place, error.what());
  }
}

/// The field that a key of JSON means, by the name of its option or as scene files have it, with '-' or '_'.
const SceneField& flightField(const std::string& place, std::string key) {
  std::ranges::replace(key, '_', '-');
  std::vector<std::string> names{kFlightTime};
  for (const std::string_view name : kFlightFields) {
    const SceneField& field = sceneField(name);
    if (key == field.name || key == field.key()) return field;
    names.push_back(field.name);
  }
  fail(ErrorKind::Input, "{} knows no \"{}\"{}", place, quotedPart(key), suggestion(key, names));
}

double readFlightTime(const std::string& place, const Json& value) {
  if (!value.is_number() || !(std::abs(value.get<double>()) <= kMostFlightTime))
    fail(ErrorKind::Input, "{} takes a number from {:g} to {:g} for \"{}\", not {}", place, -kMostFlightTime, kMostFlightTime, kFlightTime,
         inShort(value));
  return value.get<double>();
}

void refuseMissing(const std::string& place, const std::string& key, bool has, const char* form) {
  if (!has) fail(ErrorKind::Input, "{} has no \"{}\": give it {}", place, key, form);
}

FlightKeyDescription readFlightKey(const std::string& place, const Json& object) {
  if (!object.is_object()) fail(ErrorKind::Input, "{} takes an object such as {{\"time\": 0, ...}}, not {}", place, inShort(object));
  SceneDescription scene;
  SceneFieldSet given;
  std::optional<double> time;
  for (const auto& [key, value] : object.items()) {
    if (key == kFlightTime) {
      time = readFlightTime(place, value);
      continue;
    }
    const SceneField& field = flightField(place, key);
    const Json list = field.repeated && !value.is_array() ? Json::array({value}) : value;
    const auto texts = fieldTexts(field, list, "", fmt::format("{}: \"{}\"", place, field.name));
    if (texts.empty()) fail(ErrorKind::Input, "{} has an empty list \"{}\": give a light, or leave the list out", place, field.name);
    inFlight(place, [&] { field.read(scene, texts); });
    for (const SceneField* other : given)
      if (field.isOrExcludes(*other))
        fail(ErrorKind::Input, "{}: \"{}\" and \"{}\" exclude each other: keep one of them", place, other->name, field.name);
    given.insert(&field);
  }
  refuseMissing(place, kFlightTime, time.has_value(), "a number that grows from key to key");
  refuseMissing(place, "camera-position", scene.camera.position.has_value(), "as [x, y, z]");
  refuseMissing(place, "look-at", scene.camera.lookAt.has_value(), "as [x, y, z]");
  inFlight(place, [&] { scene.camera.check(); });
  return {.time = *time, .camera = scene.camera, .lights = scene.lighting.lights};
}

/// The list of a flight's keys.
const Json& flightKeysOf(const std::string& name, const Json& root) {
  if (!root.is_object()) fail(ErrorKind::Input, "{} must be an object {{\"{}\": [...]}}, not {}", name, kFlightKeys, inShort(root));
  const std::array<std::string, 1> known{kFlightKeys};
  for (const auto& [key, value] : root.items())
    if (key != kFlightKeys) fail(ErrorKind::Input, "{} knows no \"{}\"{}", name, quotedPart(key), suggestion(key, known));
  if (!root.contains(kFlightKeys) || !root[kFlightKeys].is_array())
    fail(ErrorKind::Input, "{} has no list \"{}\": give one with a camera at each of several times", name, kFlightKeys);
  const Json& keys = root[kFlightKeys];
  if (keys.size() < kMinFlightKeys || keys.size() > kMaxFlightKeys)
    fail(ErrorKind::Input, "{} has {} key{}, and a flight takes {} to {}: give so many", name, keys.size(), keys.size() == 1 ? "" : "s",
         kMinFlightKeys, kMaxFlightKeys);
  return keys;
}

/// Fails for a key that does not go on from the one before it.
void checkFlightOrder(const std::string& name, const FlightDescription& flight, std::size_t index) {
  const FlightKeyDescription &key = flight.keys[index], &before = flight.keys[index - 1];
  if (!(key.time > before.time))
    fail(ErrorKind::Input, "{} is at the time {}, which is not after that of key {}, {}: order the keys by ascending times",
         keyName(name, index), key.time, index, before.time);
  if (key.camera.orthographicHeight.has_value() != before.camera.orthographicHeight.has_value())
    fail(ErrorKind::Input, "{} is {}, and key {} is not: give all keys \"orthographic\", or none", keyName(name, index),
         key.camera.orthographicHeight ? "orthographic" : "perspective", index);
}

Flight resolvedFlight(const std::string& name, const FlightDescription& description, const Volume& volume) {
  Flight flight;
  for (std::size_t i = 0; i < description.keys.size(); ++i) {
    const FlightKeyDescription& given = description.keys[i];
    FlightKey key{.time = given.time, .camera = {}, .lights = {}};
    const auto camera = [&] {
      return given.camera
          .resolve(
              volume, [] { return Subject{}; }, 1)
          .front();
    };
    key.camera = inFlight(keyName(name, i), camera);
    key.lights = resolvedLights(given.lights, volume);
    flight.keys.push_back(std::move(key));
  }
  return flight;
}

}  // namespace

Flight FlightDescription::resolve(const Volume& volume) const {
  return resolvedFlight(kFlight, *this, volume);
}

FlightDescription readFlight(const std::string& text) {
  const std::string name = flightName(text);
  const Json root = isInlineJson(text) ? parseJson(kFlight, "inline", text) : readJson(kFlight, text);
  FlightDescription flight;
  for (const Json& object : flightKeysOf(name, root)) {
    const std::size_t index = flight.keys.size();
    flight.keys.push_back(readFlightKey(keyName(name, index), object));
    if (index > 0) checkFlightOrder(name, flight, index);
  }
  return flight;
}

std::string flightText(const FlightDescription& flight) {
  Json keys = Json::array();
  for (const FlightKeyDescription& key : flight.keys) {
    Json object = {{kFlightTime, parseJsonQuietly(numberText(key.time))}};
    SceneDescription scene;
    scene.camera = key.camera;
    scene.lighting.lights = key.lights;
    for (const std::string_view name : kFlightFields) {
      const SceneField& field = sceneField(name);
      for (const std::string& text : field.texts(scene)) {
        const Json value = fieldJson(field, text, std::nullopt);
        if (field.repeated)
          object[field.name].push_back(value);
        else
          object[field.name] = value;
      }
    }
    keys.push_back(std::move(object));
  }
  const Json root = {{kFlightKeys, std::move(keys)}};
  return root.dump();
}

std::vector<FrameView> flightViews(const std::string& text, const Volume& volume, int frameCount) {
  const std::string name = flightName(text);
  const Flight flight = resolvedFlight(name, readFlight(text), volume);
  std::vector<FrameView> views;
  for (int frame = 0; frame < frameCount; ++frame) {
    const double time = flight.timeOfFrame(frame, frameCount);
    views.push_back({.camera = flight.cameraAt(time), .lights = flight.lightsAt(time)});
    try {
      checkCamera(views.back().camera);
    } catch (const Error& error) {
      fail(ErrorKind::Input, "{} at the time {}: {} of the keys around it", name, time, error.what());
    }
  }
  return views;
}

LightingDescription lightingOfFlight(const LightingDescription& lighting, const std::string& text) {
  LightingDescription ofFlight = lighting;
  const FlightDescription flight = readFlight(text);
  const auto first = std::ranges::find_if(flight.keys, [](const FlightKeyDescription& key) { return !key.lights.empty(); });
  if (first != flight.keys.end()) ofFlight.lights = first->lights;
  return ofFlight;
}

}  // namespace freevoxels
