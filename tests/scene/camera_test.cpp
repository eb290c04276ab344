#include "engine/scene/camera.h"

#include <limits>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/volume/subject.h"
#include "tests/refusal.h"
#include "tests/splatting/framed_box.h"

namespace freevoxels {
namespace {

using test::box;
using test::largestNdc;
using test::obliqueTransform;
using test::transformed;

Camera obliqueCamera(bool orthographic) {
  Camera camera;
  camera.position = {7.0, 3.0, 9.0};
  camera.lookAt = {4.5, -1.0, 2.0};
  camera.up = {0.1, 1.0, 0.2};
  camera.orthographic = orthographic;
  camera.orthographicHeight = 3.0;
  camera.verticalFov = 40.0;
  return camera;
}

TEST(Camera, CameraSpaceHasTheEyeAtZeroAndLooksAlongMinusZ) {
  const Camera camera = obliqueCamera(false);
  const glm::dmat4 matrix = worldToCamera(camera);
  EXPECT_NEAR(glm::length(transformed(matrix, camera.position)), 0.0, 1e-12);
  const glm::dvec3 target = transformed(matrix, camera.lookAt);
  EXPECT_NEAR(target.x, 0.0, 1e-12);
  EXPECT_NEAR(target.y, 0.0, 1e-12);
  EXPECT_NEAR(target.z, -glm::length(camera.lookAt - camera.position), 1e-12);
  EXPECT_GT((glm::dmat3(matrix) * camera.up).y, 0.0);
  EXPECT_NEAR((glm::dmat3(matrix) * camera.up).x, 0.0, 1e-12);
  EXPECT_NEAR(glm::determinant(matrix), 1.0, 1e-12);
}

TEST(Camera, NdcReachesOneAtTheEdgeOfTheFieldOfView) {
  Camera camera;  // at z = 1, looking at the origin
  camera.verticalFov = 90.0;
  const glm::dvec3 corner = transformed(worldToNdc(camera, 2.0), {2.0, 1.0, 0.0});
  EXPECT_NEAR(corner.x, 1.0, 1e-12);
  EXPECT_NEAR(corner.y, 1.0, 1e-12);
  camera.orthographic = true;
  camera.orthographicHeight = 6.0;
  const glm::dvec3 flat = transformed(worldToNdc(camera, 2.0), {6.0, -3.0, -5.0});
  EXPECT_NEAR(flat.x, 1.0, 1e-12);
  EXPECT_NEAR(flat.y, -1.0, 1e-12);
}

/// A point on a pixel's ray must project to that pixel, at the distance that it was made with.
TEST(Camera, PixelRaysAgreeWithTheProjection) {
  const glm::dmat4 indexToWorld = obliqueTransform();
  const glm::ivec2 size(40, 30);
  for (const bool orthographic : {false, true}) {
    const Camera camera = obliqueCamera(orthographic);
    const PixelRays rays = pixelRays(camera, size, indexToWorld);
    EXPECT_EQ(rays.orthographic, orthographic);
    for (const double x : {0.0, 0.5, 17.25, 40.0})
      for (const double y : {0.0, 11.5, 30.0})
        for (const double t : {0.5, 9.0}) {
          const glm::dvec3 index = rays.origin + x * rays.originX + y * rays.originY +
                                   t * (rays.direction + x * rays.directionX + y * rays.directionY);
          const glm::dvec3 world = transformed(indexToWorld, index);
          const glm::dvec3 ndc = transformed(worldToNdc(camera, 40.0 / 30.0), world);
          EXPECT_NEAR((ndc.x + 1.0) / 2.0 * size.x, x, 1e-9);
          EXPECT_NEAR((1.0 - ndc.y) / 2.0 * size.y, y, 1e-9);
          EXPECT_NEAR(-transformed(worldToCamera(camera), world).z, t, 1e-9);
        }
  }
}

TEST(Camera, RaysCountedFromThePositionOfAPixelAreTheSameRays) {
  for (const bool orthographic : {false, true}) {
    const PixelRays rays = pixelRays(obliqueCamera(orthographic), {40, 30}, obliqueTransform());
    const PixelRays moved = rays.countedFrom({20.0, 15.0});
    const glm::dvec3 origin = moved.origin - 20.0 * moved.originX + 4.5 * moved.originY;
    const glm::dvec3 direction = moved.direction - 20.0 * moved.directionX + 4.5 * moved.directionY;
    EXPECT_LT(glm::length(origin - (rays.origin + 19.5 * rays.originY)), 1e-12);
    EXPECT_LT(glm::length(direction - (rays.direction + 19.5 * rays.directionY)), 1e-12);
  }
}

TEST(Camera, RowZeroIsTheTopOfTheImageAndColumnZeroTheLeft) {
  const Camera camera;  // looks along -z with y up
  for (const bool orthographic : {false, true}) {
    Camera c = camera;
    c.orthographic = orthographic;
    const PixelRays rays = pixelRays(c, {8, 8}, glm::dmat4(1.0));
    const glm::dvec3 topLeft = rays.origin + rays.direction;
    EXPECT_LT(topLeft.x, 0.0);
    EXPECT_GT(topLeft.y, 0.0);
  }
}

TEST(Camera, FramesTheWholeBoxWithASmallMargin) {
  const std::vector<Volume> volumes = {box({8, 8, 8}, glm::dmat4(1.0)), box({1, 1, 1}, obliqueTransform()),
                                       box({3, 50, 7}, obliqueTransform())};
  for (const Volume& volume : volumes)
    for (const bool orthographic : {false, true})
      for (const double aspect : {0.4, 1.0, 2.5})
        for (const double azimuth : {-170.0, 0.0, 35.0, 90.0})
          for (const double elevation : {-90.0, -30.0, 25.0, 90.0}) {
            Camera base;
            base.orthographic = orthographic;
            base.verticalFov = 70.0;
            const Camera camera = framingCamera(volume, azimuth, elevation, aspect, base);
            ASSERT_NO_THROW(checkCamera(camera));
            EXPECT_NEAR(largestNdc(volume, camera, aspect), 1.0 / 1.03, 1e-6)
                << aspect << " " << azimuth << " " << elevation;
          }
}

TEST(Camera, AzimuthTurnsFromPlusZTowardsPlusXAndElevationRises) {
  const Volume volume = box({2, 2, 2}, glm::dmat4(1.0));
  const auto direction = [&](double azimuth, double elevation) {
    const Camera camera = framingCamera(volume, azimuth, elevation, 1.0, Camera{});
    return glm::normalize(camera.position - camera.lookAt);
  };
  EXPECT_LT(glm::length(direction(0, 0) - glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::length(direction(90, 0) - glm::dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(direction(0, 90) - glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_GT(direction(35, 25).y, 0.4);
}

TEST(Camera, OrbitsAboutTheUpDirection) {
  const auto expectNear = [](glm::dvec3 a, glm::dvec3 b) { EXPECT_LT(glm::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z; };
  const glm::dvec3 z(0.0, 0.0, 2.0);
  expectNear(orbitDirection(z, 0, 0), {0, -1, 0});
  expectNear(orbitDirection(z, 90, 0), {1, 0, 0});
  expectNear(orbitDirection(z, 0, 90), {0, 0, 1});
  expectNear(orbitDirection({0, -1, 0}, 0, 90), {0, -1, 0});
  for (const glm::dvec3 up : {glm::dvec3(1, 2, 3), glm::dvec3(-1, 0, 0), glm::dvec3(0.3, -5, 0.1)})
    for (const double azimuth : {-100.0, 0.0, 35.0}) {
      EXPECT_NEAR(glm::dot(orbitDirection(up, azimuth, 30.0), glm::normalize(up)), 0.5, 1e-12);
      const glm::dvec3 before = orbitDirection(up, azimuth, 0.0), after = orbitDirection(up, azimuth + 90.0, 0.0);
      expectNear(glm::cross(before, after), glm::normalize(up));
    }
}

TEST(Camera, ImageCentreMakesOppositeMarginsEqual) {
  Subject subject{.centre = {1.0, 2.0, 3.0}, .margin = 0.1};
  for (const glm::dvec3 offset : {glm::dvec3(4, 0, 0), glm::dvec3(-1, 0.5, 2), glm::dvec3(0, -3, 1), glm::dvec3(1, 1, -5)})
    subject.points.push_back(subject.centre + offset);
  for (const bool orthographic : {false, true}) {
    Camera base;
    base.orthographic = orthographic;
    const Camera before = framingCamera(subject, 40.0, 20.0, 1.0, base);
    Subject centred = subject;
    centred.centre = imageCentre(before, subject);
    const Camera camera = framed(before, centred, 1.0);
    EXPECT_LT(glm::length(glm::normalize(before.lookAt - before.position) - glm::normalize(camera.lookAt - camera.position)), 1e-12);
    glm::dvec2 low(1e9), high(-1e9);
    for (const glm::dvec3& point : subject.points) {
      const glm::dvec2 ndc(transformed(worldToNdc(camera, 1.0), point));
      low = glm::min(low, ndc);
      high = glm::max(high, ndc);
    }
    EXPECT_NEAR(std::max(high.x, high.y), orthographic ? 1.0 / 1.1 : std::max(high.x, high.y), 1e-9);
    EXPECT_LE(std::max(high.x, high.y), 1.0 / 1.1 + 1e-9);
    EXPECT_NEAR(std::max(-low.x, -low.y), std::max(high.x, high.y), orthographic ? 1e-9 : 0.03);
    EXPECT_LT(glm::length(camera.position - camera.lookAt), glm::length(before.position - before.lookAt) + (orthographic ? 9.0 : 0.0));
  }
}

TEST(Camera, KeepsFieldOfViewAndUpOfTheBaseCamera) {
  Camera base;
  base.verticalFov = 12.0;
  base.up = {0, 0, 1};
  const Camera camera = framingCamera(box({2, 2, 2}, glm::dmat4(1.0)), 10, 20, 1.0, base);
  EXPECT_EQ(camera.verticalFov, 12.0);
  EXPECT_EQ(camera.up, base.up);
  EXPECT_FALSE(camera.orthographic);
}

TEST(Camera, RefusesWhatSeesNothingAndNamesTheParameters) {
  using Names = std::vector<std::string>;
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto expectRefused = [](const Names& parameters, auto change) {
    Camera camera;
    change(camera);
    const Error error = test::errorOf([&] { checkCamera(camera); });
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_EQ(error.parameters(), parameters) << error.what();
  };
  const Names place{"camera-position", "look-at"};
  expectRefused({"camera-position"}, [&](Camera& c) { c.position.y = nan; });
  expectRefused({"camera-position"}, [&](Camera& c) { c.position.y = inf; });
  expectRefused(place, [&](Camera& c) { c.position.x = c.position.y = 1e300; });
  expectRefused({"look-at"}, [&](Camera& c) { c.lookAt.z = nan; });
  expectRefused(place, [&](Camera& c) { c.lookAt = c.position; });
  expectRefused({"up"}, [&](Camera& c) { c.up.x = nan; });
  expectRefused({"up"}, [&](Camera& c) { c.up = glm::dvec3(0.0); });
  expectRefused({"up"}, [&](Camera& c) { c.up = {0, 0, -3}; });
  for (const double angle : {0.0, 180.0, nan}) expectRefused({"fov"}, [&](Camera& c) { c.verticalFov = angle; });
  for (const double height : {0.0, -1.0, nan, inf})
    expectRefused({"orthographic"}, [&](Camera& c) {
      c.orthographic = true;
      c.orthographicHeight = height;
    });
  checkCamera({.position = {5, 5, 5}});
}

}  // namespace
}  // namespace freevoxels
