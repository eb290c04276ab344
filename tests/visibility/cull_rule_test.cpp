// What lies outside of an image, and when anything can be hidden.

#include "engine/visibility/cull_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/scene/footprint.h"

namespace freevoxels {
namespace {

constexpr glm::ivec3 kDimensions{30, 20, 40};
const glm::dmat4 kTransform{
    {0.1, 0.0, 0.0, 0.0}, {0.03, 0.2, 0.0, 0.0}, {0.0, -0.04, 0.1, 0.0}, {-1.0, -2.0, -1.5, 1.0}};

Camera cameraOf(bool orthographic) {
  Camera camera{.position = {3.0, 2.0, 5.0}, .lookAt = {0.5, 0.0, 0.3}, .verticalFov = 20.0};
  camera.orthographic = orthographic;
  camera.orthographicHeight = 1.0;
  return camera;
}

bool isInside(const CullRule& rule, glm::dvec3 position) {
  const glm::dvec3 middle = 0.5 * glm::dvec3(kDimensions - 1);
  return std::ranges::all_of(rule.planes, [&](const glm::dvec4& plane) {
    return glm::dot(glm::dvec3(plane), position - middle) + plane.w >= 0.0;
  });
}

/// The planes are those of an image that is wider by a widened footprint and half a pixel.
TEST(CullRule, PlanesBoundTheImage) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  const FrameSettings settings{.size = {80, 60}, .method = SplatSettings{}};
  for (const bool orthographic : {false, true}) {
    const PixelRays rays = pixelRays(cameraOf(orthographic), settings.size, kTransform);
    const CullRule rule = cullRule(kDimensions, rays, settings);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec2 pixel = glm::dvec2(uniform(generator), uniform(generator)) * glm::dvec2(settings.size);
      const double t = 5.0 * uniform(generator);
      const glm::dvec3 position =
          rays.origin + pixel.x * rays.originX + pixel.y * rays.originY +
          t * (rays.direction + pixel.x * rays.directionX + pixel.y * rays.directionY);
      const glm::dvec2 beyond = glm::max(-pixel, pixel - glm::dvec2(settings.size));
      const double most = std::max(beyond.x, beyond.y) - (kFootprintRadius + 0.5);
      if (std::abs(most) < 1e-6 || std::abs(t) < 1e-6) continue;
      EXPECT_EQ(isInside(rule, position), most < 0.0 && t > 0.0) << pixel.x << "," << pixel.y << " at " << t;
      if (isInside(rule, position)) ++inside;
    }
    EXPECT_GT(inside, 300);
  }
}

TEST(CullRule, AVolumeInTheImageHasNothingOutside) {
  Camera camera = cameraOf(false);
  const FrameSettings settings{.size = {80, 60}, .method = SplatSettings{}};
  const auto ruleOf = [&] {
    return cullRule(kDimensions, pixelRays(camera, settings.size, kTransform), settings);
  };
  EXPECT_TRUE(ruleOf().outside);
  camera.verticalFov = 90.0;
  EXPECT_FALSE(ruleOf().outside);
}

TEST(CullRule, NothingIsHiddenFromInsideOrWithoutTheTable) {
  const auto depthOf = [](const Camera& camera, const FrameSettings& settings) {
    return cullRule(kDimensions, pixelRays(camera, settings.size, kTransform), settings).hiddenDepth;
  };
  const FrameSettings settings{.size = {80, 60}, .method = SplatSettings{.composite = Composite::Additive}};
  EXPECT_NEAR(depthOf(cameraOf(false), settings), std::log(4096.0), 1e-6);
  EXPECT_NEAR(depthOf(cameraOf(true), settings), std::log(4096.0), 1e-6);
  Camera inside = cameraOf(false);
  inside.position = glm::dvec3(kTransform * glm::dvec4(15.0, 10.0, 39.3, 1.0));
  EXPECT_EQ(depthOf(inside, settings), 0.0);
  inside.position = glm::dvec3(kTransform * glm::dvec4(15.0, 10.0, 39.7, 1.0));
  EXPECT_GT(depthOf(inside, settings), 0.0);
  for (const auto& without :
       {FrameSettings{.size = {80, 60}, .method = SplatSettings{.composite = Composite::Additive, .culling = false}},
        FrameSettings{.size = {80, 60}, .method = SplatSettings{.composite = Composite::Additive, .cullThreshold = 0.0f}},
        FrameSettings{.size = {80, 60}, .method = SplatSettings{}}, FrameSettings{.size = {80, 60}}})
    EXPECT_EQ(depthOf(cameraOf(false), without), 0.0);
}

TEST(CullRule, OnlyWhatIsDarkInFourDirectionsAroundALineOfSightHides) {
  const double hidden = 6.0;
  const glm::dmat3 cubic(0.1);
  for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98}) {
    const TableSettings table{.pathLengthCorrection = false, .directions = set};
    std::vector<double> depths(std::size_t(directionCount(set)), 0.9 * hidden);
    EXPECT_FALSE(canHide(table, depths, cubic, hidden));
    const int k = int(set);
    for (const glm::ivec3 dark : {glm::ivec3(k, 0, 0), {k, 1, 0}, {k, 0, 1}}) {
      depths[std::size_t(directionIndex(set, dark))] = hidden;
      EXPECT_FALSE(canHide(table, depths, cubic, hidden));
    }
    depths[std::size_t(directionIndex(set, {k, 1, 1}))] = hidden;
    EXPECT_TRUE(canHide(table, depths, cubic, hidden));
  }
  // A layer across a cube's diagonal is sqrt(3) times as long as along an axis.
  const std::vector<double> depths(26, hidden / std::sqrt(3.0) + 1e-6);
  EXPECT_FALSE(canHide({.pathLengthCorrection = false}, depths, cubic, hidden));
  EXPECT_FALSE(canHide({}, depths, cubic, hidden));
  EXPECT_TRUE(canHide({}, std::vector<double>(26, hidden), cubic, hidden));
}

}  // namespace
}  // namespace freevoxels
