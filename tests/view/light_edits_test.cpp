#include "apps/view/light_edits.h"

#include <gtest/gtest.h>

#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels {
namespace {

void expectNear(glm::dvec3 a, glm::dvec3 b, double most = 1e-12) {
  EXPECT_LT(glm::distance(a, b), most) << a.x << "," << a.y << "," << a.z;
}

LightingDescription everything() {
  LightingDescription options;
  options.lights.resize(1);
  options.ambient = glm::dvec3(0.1);
  options.environment = "sky.exr";
  options.environmentRotation = options.environmentIntensity = 2.0;
  options.phaseG = 0.5;
  options.tint = glm::dvec3(2.0);
  options.attenuation = LightAttenuation::Exact;
  options.shading = Shading::Gradient;
  options.surface = 0.5;
  return options;
}

TEST(LightEdits, WhatIsTakenOutTakesAlongWhatSaysNothingWithoutIt) {
  // Every subset of what the others may need.
  for (int taken = 0; taken < 16; ++taken) {
    LightingDescription options = everything();
    if (taken & 1) options.lights.clear();
    if (taken & 2) options.ambient.reset();
    if (taken & 4) options.environment.reset();
    if (taken & 8) options.shading = Shading::Scatter;
    dropIdleOptions(options);
    EXPECT_NO_THROW(options.check()) << taken;
    EXPECT_EQ(options.phaseG.has_value(), (taken & 1) == 0);
    EXPECT_EQ(options.surface.has_value(), (taken & 9) == 0);
    EXPECT_EQ(options.environmentRotation.has_value(), (taken & 4) == 0);
    EXPECT_EQ(options.tint.has_value(), (taken & 7) != 7);
  }
}

TEST(LightEdits, AnglesAreThoseOfAnOrbit) {
  expectNear(directionOf({0.0, 0.0}), {0.0, 0.0, 1.0});
  expectNear(directionOf({90.0, 0.0}), {1.0, 0.0, 0.0});
  expectNear(directionOf({-35.0, 90.0}), {0.0, 1.0, 0.0});
  for (const glm::dvec2 angles : {glm::dvec2(35.0, 25.0), {-170.0, -60.0}, {120.0, 5.0}})
    EXPECT_LT(glm::distance(anglesOf(3.0 * directionOf(angles)), angles), 1e-9);
}

TEST(LightEdits, ABallHasAFrontAndBeyondItsEdgeABack) {
  expectNear(directionOnBall({0.0, 0.0}), {0.0, 0.0, 1.0});
  expectNear(directionOnBall({0.6, 0.0}), {0.6, 0.0, 0.8});
  expectNear(directionOnBall({0.0, 1.0}), {0.0, 1.0, 0.0});
  expectNear(directionOnBall({0.0, -1.4}), {0.0, -0.6, -0.8});
  expectNear(directionOnBall({7.0, 0.0}), {0.0, 0.0, -1.0});
}

TEST(LightEdits, ANewLightComesFromTheUpperLeftOfTheCamera) {
  const Volume cube = makeProcedural("cube", 16);
  const Camera camera = framingCamera(cube, 140.0, 10.0, 1.0, {});
  const glm::dmat3 toCamera(worldToCamera(camera));
  for (const bool atInfinity : {true, false}) {
    const LightingDescription::GivenLight given = newLight(camera, cube, atInfinity, 0);
    EXPECT_EQ(given.light.atInfinity, atInfinity);
    EXPECT_FALSE(given.hasIntensity);
    const glm::dvec3 seen = toCamera * given.light.place;  // the cube is around the origin
    EXPECT_LT(seen.x, 0.0);
    EXPECT_GT(seen.y, 0.0);
    EXPECT_GT(seen.z, 0.0);
    if (!atInfinity) {
      const glm::dvec3 index(glm::inverse(cube.indexToWorld) * glm::dvec4(given.light.place, 1.0));
      EXPECT_TRUE(glm::any(glm::lessThan(index, glm::dvec3(-0.5))) || glm::any(glm::greaterThan(index, glm::dvec3(cube.dimensions) - 0.5)));
    }
    const LightingDescription::GivenLight second = newLight(camera, cube, atInfinity, 1);
    EXPECT_GT((toCamera * second.light.place).x, 0.0);
    EXPECT_LT(second.light.intensity, 0.5 * defaultIntensity(second.light, cube));
    EXPECT_GT(defaultIntensity(given.light, cube), 0.0);
  }
  EXPECT_EQ(defaultIntensity({}, cube), kDefaultIrradiance);
}

}  // namespace
}  // namespace freevoxels
