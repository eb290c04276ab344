// Flights as JSON and back, what they come to for a volume, and what is refused.

#include "engine/description/flight_description.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/description/scene_json.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels::test {

namespace {

/// A volume whose up direction is +z, of 10 x 10 x 10 voxels.
Volume uprightVolume() {
  Volume volume;
  volume.dimensions = glm::ivec3(10);
  volume.up = {0.0, 0.0, 1.0};
  return volume;
}

FlightDescription perspectiveFlight() {
  return {.keys = {{.time = -1.0 / 3.0,
                    .camera = {.position = glm::dvec3(1e9, -2.5, 1.0 / 7.0), .lookAt = glm::dvec3(0.0)},
                    .lights = {{.light = {.place = {1.0, 2.0, 1e-7}, .color = {0.1, 1.0, 2.0}, .intensity = 7.5}, .hasIntensity = true},
                               {.light = {.place = {-1.0, 0.0, 0.1}, .atInfinity = false}}}},
                   {.time = 0.1,
                    .camera = {.position = glm::dvec3(0.0, 3.0, 0.0),
                               .lookAt = glm::dvec3(0.1, 0.2, 0.3),
                               .up = glm::dvec3(0.0, 0.1, 1.0),
                               .verticalFov = 100.0 / 3.0}},
                   {.time = 1e20, .camera = {.position = glm::dvec3(1.0), .lookAt = glm::dvec3(0.0)}}}};
}

FlightDescription flatFlight() {
  return {.keys = {{.time = 0.0, .camera = {.position = glm::dvec3(0.0, -3.0, 0.0), .lookAt = glm::dvec3(0.0), .orthographicHeight = 0.7}},
                   {.time = 2.0, .camera = {.position = glm::dvec3(3.0, 0.0, 0.0), .lookAt = glm::dvec3(0.0), .orthographicHeight = 1e3}}}};
}

constexpr const char* kFirstKey = R"({"time": 0, "camera-position": [0, 0, 2], "look-at": [0, 0, 0]})";

/// A flight of two keys, of which the second one is given.
std::string flightWith(const std::string& second) {
  return fmt::format(R"({{"keys": [{}, {}]}})", kFirstKey, second);
}

}  // namespace

TEST(FlightDescription, SurvivesTheWayToJsonAndBack) {
  for (const FlightDescription& flight : {perspectiveFlight(), flatFlight()}) {
    EXPECT_EQ(readFlight(flightText(flight)), flight) << flightText(flight);
    EXPECT_EQ(flightText(readFlight(flightText(flight))), flightText(flight));
  }
}

TEST(FlightDescription, SurvivesTheWayToASceneFileAndBack) {
  const TemporaryFolder folder;
  SceneDescription scene;
  scene.camera.flight = flightText(perspectiveFlight());
  writeScene(folder / "s.json", scene);
  EXPECT_EQ(readScene(folder / "s.json"), scene) << readBytes(folder / "s.json");
  EXPECT_TRUE(nlohmann::json::parse(readBytes(folder / "s.json")).at("camera").at("flight").is_object());
}

TEST(FlightDescription, FilesAreRelativeToTheFolderOfTheScene) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scenes");
  writeBytes(folder / "flight.json", flightText(flatFlight()));
  writeBytes(folder / "scenes/s.json", R"({"camera": {"flight": "../flight.json"}})");
  const SceneDescription scene = readScene(folder / "scenes/s.json");
  EXPECT_EQ(scene.camera.flight, (folder / "flight.json").string());
  EXPECT_EQ(readFlight(*scene.camera.flight), flatFlight());
  writeScene(folder / "scenes/t.json", scene);
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "scenes/t.json")).at("camera").at("flight"), "../flight.json");
}

TEST(FlightDescription, KeysTakeWhatScenesTake) {
  const FlightDescription flight = readFlight(R"({"keys": [
      {"time": 0, "camera_position": "0,0,2", "look-at": [0, 0, 0], "up": "0,1,0", "light": "direction=1,0,0,intensity=2"},
      {"time": 1, "camera-position": [2, 0, 0], "look-at": [0, 0, 0], "fov": "50",
       "lights": [{"position": [1, 2, 3], "color": [1, 1, 1]}]}]})");
  EXPECT_EQ(flight.keys[0].camera.position, glm::dvec3(0.0, 0.0, 2.0));
  EXPECT_EQ(flight.keys[0].camera.up, glm::dvec3(0.0, 1.0, 0.0));
  ASSERT_EQ(flight.keys[0].lights.size(), 1u);
  EXPECT_EQ(flight.keys[0].lights[0].light.intensity, 2.0);
  EXPECT_EQ(flight.keys[1].camera.verticalFov, 50.0);
  ASSERT_EQ(flight.keys[1].lights.size(), 1u);
  EXPECT_FALSE(flight.keys[1].lights[0].hasIntensity || flight.keys[1].lights[0].light.atInfinity);
}

TEST(FlightDescription, WhatKeysLeaveOpenIsThatOfTheVolume) {
  const Volume volume = uprightVolume();
  const Flight flight = perspectiveFlight().resolve(volume);
  EXPECT_EQ(flight.keys[0].camera.up, volume.up);
  EXPECT_EQ(flight.keys[0].camera.verticalFov, Camera{}.verticalFov);
  EXPECT_EQ(flight.keys[0].lights[0].intensity, 7.5);
  EXPECT_EQ(flight.keys[0].lights[1].intensity, defaultIntensity(flight.keys[0].lights[1], volume));
  EXPECT_TRUE(flight.keys[1].lights.empty());
  EXPECT_EQ(flight.keys[1].camera.up, glm::dvec3(0.0, 0.1, 1.0));
  EXPECT_NO_THROW(SceneDescription{.camera = {.flight = flightText(flatFlight())}}.camera.check());
}

TEST(FlightDescription, FramesHaveTheCamerasAndTheLightsOfTheFlight) {
  const auto volume = std::make_shared<const Volume>(uprightVolume());
  SceneDescription scene;
  scene.camera.flight = flightText(perspectiveFlight());
  Scene resolved{.volume = volume, .classification = {}};
  scene.resolveView(resolved);
  const Flight flight = perspectiveFlight().resolve(*volume);
  EXPECT_EQ(resolved.camera.position, flight.keys[0].camera.position);
  ASSERT_TRUE(resolved.lighting);
  EXPECT_EQ(resolved.lighting->lights, flight.keys[0].lights) << "and not the default lights";
  EXPECT_EQ(resolved.lighting->ambient, glm::dvec3(0.0));
  const std::vector<FrameView> views = scene.views(resolved, 3);
  ASSERT_EQ(views.size(), 3u);
  for (int frame = 0; frame < 3; ++frame) {
    const double time = flight.timeOfFrame(frame, 3);
    EXPECT_EQ(views[std::size_t(frame)].camera.position, flight.cameraAt(time).position);
    EXPECT_EQ(views[std::size_t(frame)].lights, flight.lightsAt(time));
  }
  EXPECT_EQ(scene.cameras(resolved, 3)[1].position, views[1].camera.position);
  resolved.show(views[2]);
  EXPECT_EQ(resolved.camera.position, views[2].camera.position);
  EXPECT_EQ(resolved.lighting->lights, views[2].lights);
}

TEST(FlightDescription, WithoutLightsTheSceneKeepsItsOwn) {
  SceneDescription scene;
  scene.camera.flight = flightText(flatFlight());
  scene.lighting.lights = {{.light = {.place = {1.0, 0.0, 0.0}}}};
  Scene resolved{.volume = std::make_shared<const Volume>(uprightVolume()), .classification = {}};
  scene.resolveView(resolved);
  const std::optional<Lighting> lighting = resolved.lighting;
  resolved.show(scene.views(resolved, 2)[1]);
  EXPECT_EQ(resolved.lighting, lighting);
  EXPECT_EQ(resolved.camera.orthographicHeight, 1e3);
}

TEST(FlightDescription, ASavedTurnKeepsItsFlight) {
  SceneDescription scene;
  scene.camera.flight = flightText(flatFlight());
  Scene resolved{.volume = std::make_shared<const Volume>(uprightVolume()), .classification = {}};
  scene.resolveView(resolved);
  const SceneDescription turn = scene.resolvedTurn(resolved, 5), one = scene.resolved(resolved);
  EXPECT_EQ(turn.camera.flight, scene.camera.flight);
  EXPECT_EQ(turn.camera.frames, 5);
  EXPECT_FALSE(turn.camera.position);
  EXPECT_FALSE(one.camera.flight);
  EXPECT_EQ(one.camera.position, resolved.camera.position);
}

TEST(FlightDescription, FlightsExcludeOtherCameras) {
  for (const char* name : {"orbit", "camera-position", "look-at", "up", "fov", "orthographic", "slice"})
    EXPECT_TRUE(sceneField("flight").isOrExcludes(sceneField(name))) << name;
  for (const char* name : {"size", "frames", "holdout", "light"}) EXPECT_FALSE(sceneField("flight").isOrExcludes(sceneField(name))) << name;
}

TEST(FlightDescription, WrongFlightsAreRefusedByFileAndKey) {
  const TemporaryFolder folder;
  const std::string file = (folder / "f.json").string();
  const auto expect = [&](const std::string& json, const std::string& part) {
    SCOPED_TRACE(json);
    writeBytes(folder / "f.json", json);
    expectRefusal([&] { readFlight(file); }, ErrorKind::Input, {"flight '" + file + "'", part});
    if (json.starts_with('{')) expectRefusal([&] { readFlight(json); }, ErrorKind::Input, {"flight 'inline'", part});
  };
  const auto expectOfSecond = [&](const std::string& second, const std::string& part) { expect(flightWith(second), part); };
  expect("[]", R"(must be an object {"keys": [...]}, not [])");
  expect("{]", "is not valid JSON");
  expect(R"({"kees": []})", R"(knows no "kees"; did you mean 'keys'?)");
  expect("{}", R"(has no list "keys": give one)");
  expect(R"({"keys": 3})", R"(has no list "keys")");
  expect(fmt::format(R"({{"keys": [{}]}})", kFirstKey), "has 1 key, and a flight takes 2 to 10000: give so many");
  expectOfSecond("3", R"(key 2 takes an object such as {"time": 0, ...}, not 3)");
  expectOfSecond(R"({"camera-position": [0, 0, 2], "look-at": [0, 0, 0]})", R"(key 2 has no "time": give it a number)");
  expectOfSecond(R"({"time": "soon", "camera-position": [0, 0, 2], "look-at": [0, 0, 0]})", R"(for "time", not "soon")");
  expectOfSecond(R"({"time": 1e31, "camera-position": [0, 0, 2], "look-at": [0, 0, 0]})", R"(from -1e+30 to 1e+30 for "time", not 1e+31)");
  expectOfSecond(R"({"time": 1, "look-at": [0, 0, 0]})", R"(key 2 has no "camera-position": give it as [x, y, z])");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2]})", R"(key 2 has no "look-at": give it as [x, y, z])");
  expectOfSecond(R"({"time": 0, "camera-position": [0, 0, 2], "look-at": [0, 0, 0]})",
                 "key 2 is at the time 0, which is not after that of key 1, 0: order the keys by ascending times");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "orthographic": 3})",
                 R"(key 2 is orthographic, and key 1 is not: give all keys "orthographic", or none)");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "fob": 3})",
                 R"(key 2 knows no "fob"; did you mean 'fov'?)");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "orbit": [1, 2]})", R"(key 2 knows no "orbit")");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": true})", R"(key 2: "look-at" takes X,Y,Z, not true)");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0], "look-at": [0, 0, 0]})",
                 "key 2: camera-position takes X,Y,Z, finite numbers, not '0,0'");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 2]})",
                 "key 2: the camera stands at its look-at point; change camera-position or look-at");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "fov": 180})",
                 "key 2: the field of view 180 is not between 0 and 180 degrees");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "fov": 30, "orthographic": 1})", "exclude each other");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "up": [0, 0, 1]})",
                 "the up vector points along the view");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "light": []})", R"(key 2 has an empty list "light")");
  expectOfSecond(R"({"time": 1, "camera-position": [0, 0, 2], "look-at": [0, 0, 0], "light": [{"direction": [0, 0, 0]}]})",
                 "points nowhere");
  expectRefusal([&] { readFlight((folder / "none.json").string()); }, ErrorKind::Input, {"flight", "none.json"});
}

TEST(FlightDescription, CamerasThatCannotDrawAreRefusedByTheirTime) {
  const std::string through = flightWith(R"({"time": 4, "camera-position": [0, 0, -2], "look-at": [0, 0, 0]})");
  EXPECT_EQ(flightViews(through, Volume(), 2).size(), 2u);
  expectRefusal([&] { flightViews(through, Volume(), 3); }, ErrorKind::Input,
                {"flight 'inline' at the time 2: the camera stands at its look-at point", "of the keys around it"});
  expectRefusal([&] { flightViews(through, uprightVolume(), 2); }, ErrorKind::Input,
                {"flight 'inline': key 1: the up vector points along the view"});
}

TEST(CameraDescription, AViewWithoutAnUpDirectionIsCheckedWithThatOfTheVolume) {
  const CameraDescription alongY{.position = glm::dvec3(0.0, -30.0, 0.0), .lookAt = glm::dvec3(0.0)};
  EXPECT_NO_THROW(alongY.check());
  const auto resolve = [&](const Volume& volume) {
    return alongY.resolve(
        volume, [] { return Subject{}; }, 1);
  };
  EXPECT_EQ(resolve(uprightVolume()).front().up, glm::dvec3(0.0, 0.0, 1.0));
  expectRefusal([&] { resolve(Volume()); }, ErrorKind::Usage, {"the up vector points along the view"});
}

}  // namespace freevoxels::test
