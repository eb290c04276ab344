#include "apps/view/navigation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace freevoxels {
namespace {

constexpr glm::dvec3 kPole{0.1, 1.0, -0.2};

Camera obliqueCamera(bool orthographic = false) {
  Camera camera;
  camera.position = {3.0, 2.0, 5.0};
  camera.lookAt = {1.0, -1.0, 0.5};
  camera.up = kPole;
  camera.orthographic = orthographic;
  camera.orthographicHeight = 2.5;
  camera.verticalFov = 40.0;
  return camera;
}

double distanceOf(const Camera& camera) {
  return glm::distance(camera.position, camera.lookAt);
}

double toPole(const Camera& camera) {
  return std::acos(glm::dot(glm::normalize(camera.position - camera.lookAt), glm::normalize(camera.up)));
}

/// Where a point is on the image: x to the right, y upwards, the image from -1 to 1 in y.
glm::dvec2 onImage(const Camera& camera, glm::dvec3 point) {
  const glm::dvec4 clip = worldToNdc(camera, 1.0) * glm::dvec4(point, 1.0);
  return glm::dvec2(clip) / clip.w;
}

void expectNear(glm::dvec3 a, glm::dvec3 b) {
  EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(Navigation, AnOrbitKeepsTheDistanceTheTargetAndUp) {
  const Camera before = obliqueCamera();
  for (const glm::dvec2 drag : {glm::dvec2(0.3, 0.1), glm::dvec2(-1.7, 0.0), glm::dvec2(0.0, -0.2)}) {
    const Camera after = orbited(before, before.up, drag);
    EXPECT_NEAR(distanceOf(after), distanceOf(before), 1e-12);
    EXPECT_EQ(after.lookAt, before.lookAt);
    EXPECT_EQ(after.up, before.up);
    EXPECT_GT(glm::distance(after.position, before.position), 0.1);
  }
}

TEST(Navigation, AnOrbitOfTheImagesHeightIsHalfATurn) {
  Camera before = obliqueCamera();
  before.up = {0.0, 1.0, 0.0};
  const glm::dvec3 arm = before.position - before.lookAt;
  expectNear(orbited(before, before.up, {1.0, 0.0}).position, before.lookAt + glm::dvec3(-arm.x, arm.y, -arm.z));
  EXPECT_NEAR(toPole(orbited(before, before.up, {0.0, 0.1})) - toPole(before), 0.1 * glm::pi<double>(), 1e-12);
}

TEST(Navigation, WhatIsInFrontFollowsTheHandThatOrbits) {
  for (const bool orthographic : {false, true}) {
    const Camera before = obliqueCamera(orthographic);
    const glm::dvec3 front = before.lookAt + 0.3 * glm::normalize(before.position - before.lookAt);
    EXPECT_GT(onImage(orbited(before, before.up, {0.02, 0.0}), front).x, onImage(before, front).x + 1e-3);
    EXPECT_GT(onImage(orbited(before, before.up, {0.0, 0.02}), front).y, onImage(before, front).y + 1e-3);
  }
}

TEST(Navigation, AnOrbitStopsShortOfThePoles) {
  constexpr double kMargin = 0.01;
  const Camera top = orbited(obliqueCamera(), kPole, {0.0, -5.0}), bottom = orbited(obliqueCamera(), kPole, {0.0, 5.0});
  EXPECT_NEAR(toPole(top), kMargin, 1e-9);
  EXPECT_NEAR(toPole(bottom), glm::pi<double>() - kMargin, 1e-9);
  for (const Camera& camera : {top, bottom}) {
    EXPECT_NO_THROW(checkCamera(camera));
    const Camera again = orbited(camera, camera.up, {0.2, camera.position == top.position ? -1.0 : 1.0});
    EXPECT_NEAR(toPole(again), toPole(camera), 1e-9) << "it stays there";
    EXPECT_NO_THROW(checkCamera(again));
  }
  EXPECT_NEAR(toPole(orbited(top, top.up, {0.0, 0.25})), kMargin + 0.25 * glm::pi<double>(), 1e-9) << "and comes back";
}

TEST(Navigation, WhatIsAtTheTargetFollowsTheHandThatPans) {
  for (const bool orthographic : {false, true}) {
    const Camera before = obliqueCamera(orthographic);
    const Camera after = panned(before, {0.3, -0.2});
    expectNear(after.position - after.lookAt, before.position - before.lookAt);
    const glm::dvec2 moved = onImage(after, before.lookAt);
    EXPECT_NEAR(moved.x, 0.6, 1e-12) << "the image is 2 high";
    EXPECT_NEAR(moved.y, -0.4, 1e-12);
  }
}

TEST(Navigation, ADollyMultipliesTheDistanceAndTheHeight) {
  const Camera before = obliqueCamera(), after = dollied(before, 0.9);
  expectNear(after.position - after.lookAt, 0.9 * (before.position - before.lookAt));
  EXPECT_EQ(after.lookAt, before.lookAt);
  EXPECT_DOUBLE_EQ(after.orthographicHeight, 0.9 * before.orthographicHeight);
  expectNear(dollied(after, 1.0 / 0.9).position, before.position);
}

TEST(Navigation, TurningTheHeadKeepsTheEye) {
  const Camera before = obliqueCamera(), after = turned(before, before.up, {0.1, 0.2});
  EXPECT_EQ(after.position, before.position);
  EXPECT_NEAR(distanceOf(after), distanceOf(before), 1e-12);
  const glm::dvec2 target = onImage(after, before.lookAt);
  EXPECT_LT(target.x, -0.1) << "to the right: what was ahead is at the left";
  EXPECT_LT(target.y, -0.2);
  const Camera upwards = turned(before, before.up, {0.0, 100.0});
  EXPECT_NO_THROW(checkCamera(upwards)) << "not beyond the pole";
}

TEST(Navigation, AFlightGoesWhereTheEyeLooks) {
  const Camera before = obliqueCamera();
  const glm::dvec3 ahead = glm::normalize(before.lookAt - before.position);
  const Camera after = flown(before, {0.0, 0.0, 2.0});
  expectNear(after.position, before.position + 2.0 * ahead);
  expectNear(after.lookAt, before.lookAt + 2.0 * ahead);
  EXPECT_LT(onImage(flown(before, {0.5, 0.0, 0.0}), before.lookAt).x, 0.0);
  EXPECT_LT(onImage(flown(before, {0.0, 0.5, 0.0}), before.lookAt).y, 0.0);
}

TEST(Navigation, AxisViewsLookFromTheirSideAtTheSamePoint) {
  const Camera before = obliqueCamera();
  for (int axis = 0; axis < 6; ++axis) {
    const Camera after = alongAxis(before, kPole, axis);
    glm::dvec3 side(0.0);
    side[axis / 2] = axis % 2 == 0 ? 1.0 : -1.0;
    expectNear(after.position, before.lookAt + distanceOf(before) * side);
    EXPECT_EQ(after.lookAt, before.lookAt);
    EXPECT_NO_THROW(checkCamera(after)) << axis;
  }
}

/// Of scans, which have the head at +z and the face at -y.
TEST(Navigation, AxisViewsShowWhatIsUpUpwardsAndDragsTurnAboutItAfterwards) {
  constexpr glm::dvec3 kUp{0.0, 0.0, 1.0};
  Camera camera = obliqueCamera();
  camera.up = kUp;
  for (const int side : {0, 1, 2, 3}) EXPECT_EQ(alongAxis(camera, kUp, side).up, kUp) << side;
  for (const int side : {4, 5}) {
    const Camera along = alongAxis(camera, kUp, side);
    EXPECT_EQ(along.up, glm::dvec3(0.0, side == 4 ? 1.0 : -1.0, 0.0)) << "the face is below, or above";
    const Camera after = orbited(along, kUp, {0.0, side == 4 ? 0.25 : -0.25});
    EXPECT_EQ(after.up, kUp);
    EXPECT_NO_THROW(checkCamera(after));
    const glm::dvec3 arm = after.position - after.lookAt;
    EXPECT_NEAR(std::abs(arm.x), 0.0, 1e-9) << "upwards or downwards alone";
    EXPECT_LT(arm.y, -0.5 * glm::length(arm)) << "in front of the face";
    const glm::dvec3 level = glm::cross(after.lookAt - after.position, after.up);
    EXPECT_NEAR(glm::normalize(level).z, 0.0, 1e-12) << "the horizon stays level";
  }
}

TEST(Navigation, TheOtherProjectionKeepsTheSizeAndIsItsOwnInverse) {
  for (const bool orthographic : {false, true}) {
    const Camera before = obliqueCamera(orthographic), other = withOtherProjection(before);
    EXPECT_NE(other.orthographic, before.orthographic);
    const glm::dvec3 right = glm::normalize(
        glm::cross(before.lookAt - before.position, before.up));  // a point in the plane of the target
    const glm::dvec2 size = onImage(before, before.lookAt + 0.5 * right);
    EXPECT_LT(glm::distance(onImage(other, before.lookAt + 0.5 * right), size), 1e-12);

    const Camera back = withOtherProjection(other);
    EXPECT_EQ(back.orthographic, before.orthographic);
    EXPECT_LT(glm::distance(onImage(back, before.lookAt + 0.5 * right), size), 1e-12);
    if (!orthographic) expectNear(back.position, before.position);
    if (orthographic) {
      EXPECT_NEAR(back.orthographicHeight, before.orthographicHeight, 1e-12);
    }
  }
}

}  // namespace
}  // namespace freevoxels
