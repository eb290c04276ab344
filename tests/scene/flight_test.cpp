#include "engine/scene/flight.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace freevoxels {
namespace {

/// Keys at unequal times, with ups that turn and fields of view that change.
Flight curvedFlight() {
  return {.keys = {{.time = -1.0, .camera = {.position = {3.0, 1.0, 2.0}, .lookAt = {0.0, 0.1, 0.0}}},
                   {.time = 0.1,
                    .camera = {.position = {-1.0, 0.7, 3.0}, .lookAt = {0.3, 0.0, 0.2}, .up = {0.3, 2.0, 0.0}, .verticalFov = 62.0}},
                   {.time = 0.7, .camera = {.position = {-2.5, 0.2, 0.1}, .up = {0.0, 1.0, 1.0}, .verticalFov = 20.0}},
                   {.time = 4.0, .camera = {.position = {0.1, -1.0, -3.0}, .lookAt = {0.0, 0.0, 1.0}, .verticalFov = 110.0}}}};
}

Flight orthographicFlight() {
  Flight flight = curvedFlight();
  double height = 3.0;
  for (FlightKey& key : flight.keys) {
    key.camera.orthographic = true;
    key.camera.verticalFov = Camera{}.verticalFov;
    key.camera.orthographicHeight = height *= 0.4;
  }
  return flight;
}

/// Everything of a camera that moves, as one list.
std::vector<double> flightNumbers(const Camera& c) {
  return {c.position.x, c.position.y, c.position.z, c.lookAt.x,    c.lookAt.y,          c.lookAt.z,
          c.up.x,       c.up.y,       c.up.z,       c.verticalFov, c.orthographicHeight};
}

Light lightTowards(glm::dvec3 direction, double intensity = 1.0) {
  return {.place = direction, .intensity = intensity};
}

}  // namespace

TEST(Flight, PassesThroughItsKeysExactly) {
  for (const Flight& flight : {curvedFlight(), orthographicFlight()})
    for (const FlightKey& key : flight.keys) {
      const Camera camera = flight.cameraAt(key.time);
      EXPECT_EQ(camera.position, key.camera.position);
      EXPECT_EQ(camera.lookAt, key.camera.lookAt);
      EXPECT_EQ(camera.up, glm::normalize(key.camera.up));
      EXPECT_EQ(camera.verticalFov, key.camera.verticalFov);
      EXPECT_EQ(camera.orthographicHeight, key.camera.orthographicHeight);
    }
}

TEST(Flight, ItsDerivativesAreContinuousAtKeys) {
  constexpr double kStep = 1e-6;
  for (const Flight& flight : {curvedFlight(), orthographicFlight()})
    for (std::size_t key = 1; key + 1 < flight.keys.size(); ++key) {
      const double time = flight.keys[key].time;
      const auto before = flightNumbers(flight.cameraAt(time - kStep)), at = flightNumbers(flight.cameraAt(time)),
                 after = flightNumbers(flight.cameraAt(time + kStep));
      for (std::size_t i = 0; i < at.size(); ++i) {
        EXPECT_NEAR((at[i] - before[i]) / kStep, (after[i] - at[i]) / kStep, 2e-3) << "number " << i << " of key " << key;
        EXPECT_NEAR(at[i], after[i], 1e-3);
      }
    }
}

TEST(Flight, AtAKeyTheDerivativeIsTheDifferenceOfItsNeighbours) {
  constexpr double kStep = 1e-6;
  const Flight flight = curvedFlight();
  const glm::dvec3 slope = (flight.cameraAt(0.1 + kStep).position - flight.cameraAt(0.1 - kStep).position) / (2.0 * kStep);
  const glm::dvec3 expected = (flight.keys[2].camera.position - flight.keys[0].camera.position) / 1.7;
  EXPECT_LT(glm::length(slope - expected), 1e-5);
}

TEST(Flight, OfTwoKeysIsALineAtConstantSpeed) {
  const Camera first{.position = {3.0, 1.0, 2.0}, .verticalFov = 20.0},
      last{.position = {-1.0, 5.0, 2.5}, .lookAt = {1.0, 0.0, 0.0}, .verticalFov = 60.0};
  const Flight flight{.keys = {{.time = 2.0, .camera = first}, {.time = 7.0, .camera = last}}};
  const auto size = [](double fov) { return std::tan(glm::radians(fov) / 2.0); };
  for (int i = 0; i <= 20; ++i) {
    const double part = i / 20.0;
    const Camera camera = flight.cameraAt(2.0 + 5.0 * part);
    EXPECT_LT(glm::length(camera.position - glm::mix(first.position, last.position, part)), 1e-14);
    EXPECT_LT(glm::length(camera.lookAt - glm::mix(first.lookAt, last.lookAt, part)), 1e-14);
    EXPECT_NEAR(size(camera.verticalFov), size(20.0) * std::pow(size(60.0) / size(20.0), part), 1e-13);
  }
}

TEST(Flight, WhatIsTheSameInAllKeysStaysExactly) {
  Flight flight = curvedFlight();
  for (FlightKey& key : flight.keys) {
    key.camera = {.position = {0.1, 0.7, 1.0 / 3.0}, .lookAt = {0.3, 1e-3, 7.1}, .verticalFov = 33.3};
    key.lights = {lightTowards({0.3, 0.1, 0.7}, 0.1)};
  }
  for (int i = 0; i <= 50; ++i) {
    const double time = -1.0 + 0.1 * i;
    EXPECT_EQ(flightNumbers(flight.cameraAt(time)), flightNumbers(flight.keys[0].camera)) << time;
    EXPECT_EQ(flight.lightsAt(time), flight.keys[0].lights) << time;
  }
}

TEST(Flight, KeysNextToEachOtherInTimeAreACut) {
  Flight flight = curvedFlight();
  flight.keys[2].time = std::nextafter(0.1, 1.0);
  for (const double time : {-0.5, 0.1, flight.keys[2].time, 0.2, 2.0, 3.9}) {
    const Camera camera = flight.cameraAt(time);
    for (const double number : flightNumbers(camera)) EXPECT_TRUE(std::isfinite(number)) << time;
    EXPECT_LT(glm::length(camera.position), 10.0) << time;
  }
}

TEST(Flight, OppositeUpsTurnAndStayValid) {
  const std::vector<std::pair<glm::dvec3, glm::dvec3>> ends{{{0.0, 0.0, 3.0}, {0.0, 0.0, 3.0}},    // a roll
                                                            {{0.0, 1.0, 3.0}, {0.0, -1.0, -3.0}},  // over the top
                                                            {{0.0, 0.0, 3.0}, {3.0, 0.0, 0.1}}};
  for (const auto& [from, to] : ends)
    for (const glm::dvec3 up : {glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(1e-9, -1.0, 0.0), glm::dvec3(0.3, -1.0, 0.1)}) {
      const Flight flight{.keys = {{.time = 0.0, .camera = {.position = from, .up = {0.0, 1.0, 0.0}}},
                                   {.time = 1.0, .camera = {.position = to, .up = up}}}};
      glm::dvec3 before = flight.cameraAt(0.0).up;
      for (int i = 1; i <= 1000; ++i) {
        const Camera camera = flight.cameraAt(i / 1000.0);
        EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-12);
        EXPECT_LT(glm::length(camera.up - before), 0.02) << i;
        before = camera.up;
      }
    }
}

TEST(Flight, ARollStaysACameraThatCanBeDrawn) {
  const Flight flight{.keys = {{.time = 0.0, .camera = {.position = {0.0, 0.0, 3.0}}},
                               {.time = 1.0, .camera = {.position = {1.0, 0.0, 3.0}, .up = {0.0, -1.0, 0.0}}}}};
  for (int i = 0; i <= 100; ++i) EXPECT_NO_THROW(checkCamera(flight.cameraAt(i / 100.0))) << i;
}

TEST(Flight, FramesAreAtEqualStepsOfTimeFromTheFirstKeyToTheLast) {
  const Flight flight = curvedFlight();
  EXPECT_EQ(flight.timeOfFrame(0, 1), -1.0);
  EXPECT_EQ(flight.timeOfFrame(0, 6), -1.0);
  EXPECT_DOUBLE_EQ(flight.timeOfFrame(2, 6), 1.0);
  EXPECT_EQ(flight.timeOfFrame(5, 6), 4.0);
  EXPECT_EQ(flight.cameraAt(flight.timeOfFrame(6, 7)).position, flight.keys.back().camera.position);
  EXPECT_EQ(flight.cameraAt(-5.0).position, flight.keys.front().camera.position);
  EXPECT_EQ(flight.cameraAt(50.0).position, flight.keys.back().camera.position);
}

TEST(Flight, LightsMoveInALineBetweenKeysThatHaveThem) {
  Flight flight = curvedFlight();
  EXPECT_TRUE(flight.lightsAt(0.3).empty());
  const Light lamp{.place = {1.0, 2.0, 3.0}, .atInfinity = false, .color = {1.0, 0.0, 0.5}, .intensity = 2.0};
  Light other = lamp;
  other.place = {3.0, 2.0, -1.0};
  other.color = {0.0, 1.0, 0.5};
  flight.keys[1].lights = {lightTowards({2.0, 0.0, 0.0}), lamp};
  flight.keys[3].lights = {lightTowards({0.0, 0.5, 0.0}, 5.0), other};
  EXPECT_EQ(flight.lightsAt(-1.0), flight.keys[1].lights) << "before the first key with lights";
  EXPECT_EQ(flight.lightsAt(0.1), flight.keys[1].lights);
  EXPECT_EQ(flight.lightsAt(4.0), flight.keys[3].lights);
  EXPECT_EQ(flight.lightsAt(9.0), flight.keys[3].lights);
  const std::vector<Light> middle = flight.lightsAt(0.5 * (0.1 + 4.0));
  ASSERT_EQ(middle.size(), 2u);
  EXPECT_LT(glm::length(middle[0].place - glm::normalize(glm::dvec3(1.0, 1.0, 0.0))), 1e-12);
  EXPECT_DOUBLE_EQ(middle[0].intensity, 3.0);
  EXPECT_LT(glm::length(middle[1].place - glm::dvec3(2.0, 2.0, 1.0)), 1e-12);
  EXPECT_LT(glm::length(middle[1].color - glm::dvec3(0.5)), 1e-12);
  EXPECT_FALSE(middle[1].atInfinity);
}

TEST(Flight, OtherNumbersOrKindsOfLightsChangeAtTheLaterKey) {
  Flight flight = curvedFlight();
  const std::vector<Light> one{lightTowards({1.0, 0.0, 0.0})}, two{one[0], one[0]},
      position{{.place = {1.0, 0.0, 0.0}, .atInfinity = false}};
  for (const std::vector<Light>& later : {two, position}) {
    flight.keys[0].lights = one;
    flight.keys[2].lights = later;
    EXPECT_EQ(flight.lightsAt(0.69), one);
    EXPECT_EQ(flight.lightsAt(0.7), later);
    EXPECT_EQ(flight.lightsAt(0.71), later);
  }
  flight.keys[2].lights = {lightTowards({-1.0, 0.0, 0.0})};
  EXPECT_EQ(glm::length(flight.lightsAt(-0.15)[0].place), 1.0) << "half-way between opposite directions";
}

}  // namespace freevoxels
