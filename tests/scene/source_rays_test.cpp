// Rays from sources outside, beside and inside of volumes: every voxel lies between four rays of its fan, and
// the optical depths along them are those of a march along the voxel's own line of sight.

#include "engine/scene/source_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/reference/reference_depth.h"
#include "engine/reference/reference_rays.h"
#include "engine/scene/directions.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

const glm::ivec3 kSize(20, 13, 17);

std::vector<RaySource> sources() {
  return {{.place = {60.0, 20.0, 33.0}},
          {.place = {-25.0, -31.0, -28.0}},
          {.place = {9.5, 6.0, 60.0}},
          {.place = {20.4, 6.2, 8.1}},    // just outside of a face
          {.place = {8.3, 5.7, 9.1}},     // inside
          {.place = {8.0, 5.0, 9.0}},     // at a voxel
          {.place = {8.0, 5.4, 9.7}},     // in a plane of voxels
          {.place = {-0.5, 6.0, 3.3}},    // on a face
          {.place = {19.5, -0.5, 16.5}},  // on a corner
          {.place = {1e6, 2e5, -3e5}},
          {.place = {0.0, 0.0, 1.0}, .atInfinity = true},
          {.place = {-1.0, 1.0, 1.0}, .atInfinity = true},
          {.place = {0.3, -2.0, 0.7}, .atInfinity = true}};
}

template <typename Visit>
void forEachVoxel(const Visit& visit) {
  for (int z = 0; z < kSize.z; ++z)
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) visit(glm::ivec3(x, y, z));
}

glm::dvec3 fromSource(const RaySource& source, glm::dvec3 position) {
  return source.atInfinity ? -source.place : position - source.place;
}

TEST(RayFans, EveryVoxelLiesBetweenTheRaysOfItsFanWithTwoOnEitherSide) {
  for (const RaySource& source : sources()) {
    const std::array<FaceRays, 6> fans = faceRays(kSize, source);
    forEachVoxel([&](glm::ivec3 voxel) {
      if (fromSource(source, voxel) == glm::dvec3(0.0)) return;
      const FaceRays& fan = fans[std::size_t(fanIndex(fromSource(source, voxel)))];
      const int plane = (voxel[fan.axis] - fan.firstPlane) * fan.direction;
      ASSERT_GE(plane, 0);
      ASSERT_LT(plane, fan.planeCount);
      const double up = voxel[fan.axis] - fan.farthest;
      for (int side = 0; side < 2; ++side) {
        const double apart = fan.spacing * (1.0 + fan.convergence * up);
        const double place =
            (voxel[(fan.axis + 1 + side) % 3] - fan.origin[side] - fan.slope[side] * up) / apart;
        ASSERT_GE(place, 1.0) << source.place.x;
        ASSERT_LE(place, fan.rayCount[side] - 2.0) << source.place.x;
      }
    });
  }
}

TEST(RayFans, RaysPassTheSource) {
  for (const RaySource& source : sources()) {
    if (source.atInfinity) continue;
    for (const FaceRays& fan : faceRays(kSize, source)) {
      if (fan.planeCount == 0) continue;
      const glm::dvec2 offset = fan.spacing * glm::dvec2(3.0, 5.0);
      const double up = source.place[fan.axis] - fan.farthest;
      const glm::dvec2 there = fan.origin + offset + (fan.slope + offset * fan.convergence) * up;
      EXPECT_NEAR(there.x, source.place[(fan.axis + 1) % 3], 1e-6);
      EXPECT_NEAR(there.y, source.place[(fan.axis + 2) % 3], 1e-6);
    }
  }
}

TEST(RayFans, MirroredSourcesHaveMirroredRays) {
  for (const RaySource& source : sources()) {
    RaySource mirrored{.place = -source.place, .atInfinity = source.atInfinity};
    if (!source.atInfinity) mirrored.place += glm::dvec3(kSize - 1);
    const std::array<FaceRays, 6> fans = faceRays(kSize, source), mirroredFans = faceRays(kSize, mirrored);
    for (std::size_t i = 0; i < fans.size(); ++i) {
      const FaceRays &fan = fans[i], &mirror = mirroredFans[i ^ 1];
      ASSERT_EQ(mirror.planeCount, fan.planeCount);
      if (fan.planeCount == 0) continue;
      EXPECT_NEAR(mirror.spacing, fan.spacing, 1e-9);
      for (int side = 0; side < 2; ++side) {
        const double last = kSize[(fan.axis + 1 + side) % 3] - 1;
        const double between = (last - mirror.origin[side] - fan.origin[side]) / fan.spacing;
        EXPECT_NEAR(between, std::round(between), 1e-6) << source.place.x;
      }
    }
  }
}

TEST(RayFans, AreNoMoreThanTheyMayBe) {
  for (const RaySource& source : sources())
    for (const FaceRays& fan : faceRays(kSize, source)) {
      const int a = kSize[(fan.axis + 1) % 3], b = kSize[(fan.axis + 2) % 3];
      EXPECT_LE(fan.rays(), std::uint64_t(6 * (a + 4) * (b + 4) + 24 * (a + b + 24)));
    }
}

/// Bilinear in the planes of the fan's axis; a layer of every plane between the voxel and the source.
double marchedDepth(const Volume& volume, const RaySource& source, glm::ivec3 voxel) {
  const glm::dvec3 ray = fromSource(source, voxel);
  const int axis = fanIndex(ray) / 2;
  const glm::dvec3 layer = ray / std::abs(ray[axis]);
  const auto extinction = [&](glm::dvec3 p) {
    double sum = 0.0;
    const glm::ivec3 low(glm::floor(p + 1e-9));
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 v = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 share = glm::max(1.0 - glm::abs(p - glm::dvec3(v)), 0.0);
      if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, kSize))) continue;
      sum += share.x * share.y * share.z * volume.scalar(v.x, v.y, v.z);
    }
    return sum;
  };
  const auto at = [&](int k) { return extinction(glm::dvec3(voxel) - double(k) * layer); };
  double depth = 0.0;
  int nearest = 0;
  for (int k = 1; k <= kSize[axis]; ++k) {
    if (!source.atInfinity && double(k) >= std::abs(ray[axis])) break;
    depth += at(k);
    nearest = k;
  }
  // From the source to its nearest plane, where the march has half a layer: the integral of what is linear
  // between the planes on either side.
  const double rest = source.atInfinity ? 1.0 : std::min(std::abs(ray[axis]) - nearest, 1.0);
  const double first = at(nearest), before = at(nearest + 1);
  depth += rest * first + rest * rest / 2.0 * (before - first) - first / 2.0;
  return std::max(depth, 0.0) * glm::length(glm::dmat3(volume.indexToWorld) * layer);
}

/// A volume without edges: what interpolation between rays adds stays below a fiftieth of the largest depth.
TEST(RayFans, DepthsAreThoseOfEachVoxelsOwnLineOfSight) {
  const Volume volume = makeVolume(kSize, glm::dmat4(0.25), [](int x, int y, int z) {
    const auto window = [](int i, int n) { return std::sin(3.14159265 * (i + 1.0) / (n + 1.0)); };
    const double inside = window(x, kSize.x) * window(y, kSize.y) * window(z, kSize.z);
    return inside * inside * (1.0 + 0.8 * std::sin(0.2 * x) * std::cos(0.25 * y) * std::sin(0.15 * z + 1.0));
  });
  const std::vector<float> scalars = denseScalars(volume);
  const std::vector<double> extinction(scalars.begin(), scalars.end());
  for (const RaySource& source : sources()) {
    const auto depth = rayDepth(volume, source, referenceRays(volume, extinction, source));
    double worst = 0.0, deepest = 0.0;
    forEachVoxel([&](glm::ivec3 voxel) {
      if ((voxel.x + 2 * voxel.y + 3 * voxel.z) % 11 != 0 || fromSource(source, voxel) == glm::dvec3(0.0))
        return;
      const double marched = marchedDepth(volume, source, voxel);
      worst = std::max(worst, std::abs(depth->at({0, voxel}) - marched));
      deepest = std::max(deepest, marched);
    });
    EXPECT_LT(worst, 0.02 * deepest) << source.place.x;
    EXPECT_GT(deepest, 1.0);
  }
}

TEST(RayFans, SlopesAreTheChangeOfDepth) {
  const Volume volume =
      makeVolume(kSize, glm::dmat4(1.0), [](int x, int y, int) { return 0.02 * x + 0.01 * y; });
  const std::vector<float> scalars = denseScalars(volume);
  const std::vector<double> extinction(scalars.begin(), scalars.end());
  const RaySource above{.place = {0.0, 0.0, 1.0}, .atInfinity = true};
  const auto depth = rayDepth(volume, above, referenceRays(volume, extinction, above));
  const glm::ivec3 voxel(9, 6, 7);
  const int layers = kSize.z - 1 - voxel.z;
  const double expected = layers * (0.02 * 9 + 0.01 * 6);
  const double halfCode =
      std::sqrt(expected * kOpaqueDepth) / 65535.0;  // of the 16 bits that a depth is kept in
  EXPECT_NEAR(depth->at({0, voxel}), expected, 1.01 * halfCode);
  EXPECT_NEAR(depth->slope({0, voxel}, 0), layers * 0.02, 3.0 * halfCode);
  EXPECT_NEAR(depth->slope({0, voxel}, 1), layers * 0.01, 3.0 * halfCode);
  const glm::dvec3 gradient = depth->gradient({0, voxel}, {0.0, 0.0, 4.0}, 0.24);
  EXPECT_NEAR(gradient.z, -0.24, 1e-9);
}

}  // namespace
}  // namespace freevoxels
