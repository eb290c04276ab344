#include "engine/scene/orbit.h"

#include <fmt/format.h>

#include "engine/volume/subject.h"
#include "tests/splatting/framed_box.h"

namespace freevoxels {
namespace {

using test::box;
using test::largestNdc;
using test::obliqueTransform;

constexpr double kWithMargin = 1.0 / 1.03;

double distanceOf(const Camera& camera) {
  return glm::length(camera.position - camera.lookAt);
}

Camera base(bool orthographic) {
  Camera camera;
  camera.orthographic = orthographic;
  camera.verticalFov = 50.0;
  return camera;
}

TEST(Orbit, KeepsOneDistanceThatCutsNothing) {
  for (const Volume& volume : {box({40, 3, 7}, glm::dmat4(1.0)), box({3, 50, 7}, obliqueTransform())})
    for (const bool orthographic : {false, true})
      for (const double aspect : {0.4, 1.0, 2.5})
        for (const double elevation : {-30.0, 0.0, 25.0, 90.0}) {
          SCOPED_TRACE(fmt::format("{} {} {}", orthographic, aspect, elevation));
          const std::vector<Camera> orbit =
              framingOrbit(volume, 10.0, elevation, 36, aspect, base(orthographic));
          ASSERT_EQ(orbit.size(), 36u);
          double largest = 0.0;
          for (const Camera& camera : orbit) {
            ASSERT_NO_THROW(checkCamera(camera));
            EXPECT_NEAR(distanceOf(camera), distanceOf(orbit[0]), 1e-12 * distanceOf(orbit[0]));
            EXPECT_EQ(camera.orthographicHeight, orbit[0].orthographicHeight);
            EXPECT_EQ(camera.lookAt, orbit[0].lookAt);
            const double reach = largestNdc(volume, camera, aspect);
            EXPECT_LE(reach, kWithMargin + 1e-9);
            largest = std::max(largest, reach);
          }
          EXPECT_NEAR(largest, kWithMargin, 1e-6) << "one frame is as near as it can be";
        }
}

TEST(Orbit, AFrameNearerThanTheOthersNeedWouldBeCut) {
  const Volume plank = box({40, 3, 7}, glm::dmat4(1.0));
  const Camera endOn = framingCamera(plank, 90.0, 0.0, 1.0, base(false));
  const std::vector<Camera> orbit = framingOrbit(plank, 90.0, 0.0, 4, 1.0, base(false));
  EXPECT_GT(distanceOf(orbit[0]), 1.2 * distanceOf(endOn));
}

TEST(Orbit, HasEqualStepsOfAzimuth) {
  const Volume volume = box({4, 5, 6}, obliqueTransform());
  const std::vector<Camera> orbit = framingOrbit(volume, 35.0, 25.0, 8, 1.0, base(false));
  const auto direction = [](const Camera& camera) {
    return (camera.position - camera.lookAt) / distanceOf(camera);
  };
  for (int i = 0; i < 8; ++i) {
    const Camera alone = framingCamera(volume, 35.0 + 45.0 * i, 25.0, 1.0, base(false));
    EXPECT_LT(glm::length(direction(orbit[std::size_t(i)]) - direction(alone)), 1e-12) << i;
  }
  const glm::dvec3 first = direction(orbit[0]), opposite = direction(orbit[4]);
  EXPECT_LT(glm::length(first * glm::dvec3(-1, 1, -1) - opposite), 1e-12);
}

TEST(Orbit, OfOneFrameIsTheFramingCamera) {
  const Volume volume = box({4, 5, 6}, obliqueTransform());
  for (const bool orthographic : {false, true}) {
    const Camera alone = framingCamera(volume, 35.0, 25.0, 1.5, base(orthographic));
    const Camera orbit = framingOrbit(volume, 35.0, 25.0, 1, 1.5, base(orthographic)).front();
    EXPECT_LT(glm::length(orbit.position - alone.position), 1e-12);
    EXPECT_EQ(orbit.lookAt, alone.lookAt);
    EXPECT_EQ(orbit.orthographicHeight, alone.orthographicHeight);
  }
}

TEST(Orbit, FromAboveTheImageTurns) {
  const std::vector<Camera> orbit =
      framingOrbit(box({4, 5, 6}, glm::dmat4(1.0)), 0.0, 90.0, 4, 1.0, base(false));
  for (const Camera& camera : orbit) EXPECT_NEAR(camera.position.x, camera.lookAt.x, 1e-12);
  EXPECT_LT(glm::length(orbit[0].up + orbit[2].up), 1e-12);
  EXPECT_LT(std::abs(glm::dot(orbit[0].up, orbit[1].up)), 1e-12);
}

TEST(Orbit, APositionTurnsAboutUpThroughTheLookAtPoint) {
  Camera start;
  start.position = {7.0, 2.0, 5.0};
  start.lookAt = {3.0, 1.0, -1.0};
  start.up = {0.0, 0.0, 3.0};  // its length does not matter
  const std::vector<Camera> orbit = orbitAboutUp(start, 4);
  ASSERT_EQ(orbit.size(), 4u);
  EXPECT_EQ(orbit[0].position, start.position);
  // (4, 1) turned by a quarter about +z is (-1, 4); z stays.
  EXPECT_LT(glm::length(orbit[1].position - glm::dvec3(2.0, 5.0, 5.0)), 1e-12);
  EXPECT_LT(glm::length(orbit[2].position - glm::dvec3(-1.0, 0.0, 5.0)), 1e-12);
  EXPECT_LT(glm::length(orbit[3].position - glm::dvec3(4.0, -3.0, 5.0)), 1e-12);
  for (const Camera& camera : orbit) {
    EXPECT_EQ(camera.up, start.up);
    EXPECT_EQ(camera.lookAt, start.lookAt);
  }
}

TEST(Orbit, BothTurnTheSameWay) {
  const Volume volume = box({4, 5, 6}, obliqueTransform());
  const std::vector<Camera> framing = framingOrbit(volume, 35.0, 25.0, 7, 1.0, base(false));
  const std::vector<Camera> turned = orbitAboutUp(framing[0], 7);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_LT(glm::length(framing[i].position - turned[i].position), 1e-9) << i;
}

}  // namespace
}  // namespace freevoxels
