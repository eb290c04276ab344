#include "engine/scene/directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace freevoxels {
namespace {

constexpr DirectionSet kSets[] = {DirectionSet::Directions26, DirectionSet::Directions98};
constexpr AttenuationCode kCodes[] = {AttenuationCode::Depth8, AttenuationCode::Linear8};

glm::dvec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

TEST(Directions, AreTheSurfaceOfTheCubeInAscendingOrder) {
  EXPECT_EQ(directionCount(DirectionSet::Directions26), 26);
  EXPECT_EQ(directionCount(DirectionSet::Directions98), 98);
  for (const DirectionSet set : kSets) {
    const int k = int(set), count = directionCount(set);
    EXPECT_EQ(directionSetOf(std::size_t(count)), set);
    int index = 0, number = 0;
    for (int z = -k; z <= k; ++z)
      for (int y = -k; y <= k; ++y)
        for (int x = -k; x <= k; ++x) {
          const glm::ivec3 cell(x, y, z);
          EXPECT_EQ(cellNumber(set, cell), number++);
          if (std::max({std::abs(x), std::abs(y), std::abs(z)}) < k) continue;
          ASSERT_EQ(directionIndex(set, cell), index);
          EXPECT_EQ(directionCell(set, index), cell);
          EXPECT_EQ(directionCell(set, count - 1 - index), -cell);
          EXPECT_EQ(directionAt(set, index), glm::dvec3(cell) / double(k));
          ++index;
        }
    EXPECT_EQ(index, count);
  }
}

TEST(Directions, StepIsTheWorldLengthOrTheVoxelSize) {
  glm::dmat4 matrix(1.0);
  matrix[0] = {2.0, 0.0, 0.0, 0.0};
  matrix[1] = {1.0, 3.0, 0.0, 0.0};  // sheared
  matrix[2] = {0.0, 0.0, 4.5, 0.0};
  matrix[3] = {7.0, 7.0, 7.0, 1.0};
  EXPECT_DOUBLE_EQ(stepLength(matrix, {1, 0, 0}, true), 2.0);
  EXPECT_DOUBLE_EQ(stepLength(matrix, {1, 1, 0}, true), std::sqrt(9.0 + 9.0));
  EXPECT_DOUBLE_EQ(stepLength(matrix, {-1, 1, 1}, true), std::sqrt(1.0 + 9.0 + 4.5 * 4.5));
  EXPECT_DOUBLE_EQ(stepLength(matrix, {1, 0.5, 0}, true), std::sqrt(2.5 * 2.5 + 1.5 * 1.5));
  EXPECT_NEAR(stepLength(matrix, {1, 0, 0}, false), 3.0, 1e-12);  // the cube root of 2 * 3 * 4.5
  EXPECT_NEAR(stepLength(matrix, {-1, 1, 1}, false), 3.0, 1e-12);
  EXPECT_NEAR(stepLength(matrix, {1, 0.5, 0}, false), 3.0, 1e-12);
}

TEST(Directions, CodesHaveTheirEndsAndDecodeToHalfACode) {
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Depth8, 0.0), 0);
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Depth8, 16.0), 255);
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Depth8, 1e9), 255);
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Depth8, 4.0), 128);  // 127.5
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Linear8, 0.0), 255);
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Linear8, 1e9), 0);
  EXPECT_EQ(encodeOpticalDepth(AttenuationCode::Linear8, std::log(2.0)), 128);
  EXPECT_DOUBLE_EQ(decodeOpticalDepth(AttenuationCode::Depth8, 255), 16.0);
  EXPECT_DOUBLE_EQ(decodeOpticalDepth(AttenuationCode::Linear8, 0), kOpaqueDepth);
  for (const AttenuationCode code : kCodes) {
    for (int byte = 0; byte < 256; ++byte) {
      EXPECT_EQ(encodeOpticalDepth(code, decodeOpticalDepth(code, byte)), byte);
    }
    for (double depth = 0.0; depth < 12.0; depth += 0.01)
      EXPECT_NEAR(std::exp(-decodeOpticalDepth(code, encodeOpticalDepth(code, depth))), std::exp(-depth),
                  0.0068);
  }
}

TEST(Directions, BilinearReproducesTheTablesDirections) {
  for (const DirectionSet set : kSets)
    for (int index = 0; index < directionCount(set); ++index)
      for (const double scale : {1.0, 1e-30, 37.5}) {
        const glm::dvec3 direction = scale * directionAt(set, index);
        const DirectionBlend blend = bilinearDirections(set, direction);
        double weight = 0.0;
        for (std::size_t i = 0; i < 4; ++i)
          if (blend.directions[i] == index) weight += blend.weights[i];
        EXPECT_NEAR(weight, 1.0, 1e-14);
        EXPECT_EQ(nearestDirection(set, direction), index);
      }
}

/// The blend of the corners is the direction itself: it is linear on a face of the cube. The corners are
/// those of one quad.
TEST(Directions, BilinearWeightsAddUpAndBlendToTheDirection) {
  std::mt19937 random(1);
  for (int i = 0; i < 4000; ++i) {
    const DirectionSet set = kSets[i % 2];
    const glm::dvec3 direction = randomDirection(random);
    const glm::dvec3 absolute = glm::abs(direction);
    const double largest = std::max({absolute.x, absolute.y, absolute.z});
    const DirectionBlend blend = bilinearDirections(set, direction);
    double sum = 0.0;
    glm::dvec3 mean(0.0);
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_GE(blend.weights[c], 0.0);
      ASSERT_GE(blend.directions[c], 0);
      ASSERT_LT(blend.directions[c], directionCount(set));
      sum += blend.weights[c];
      const glm::dvec3 corner = directionAt(set, blend.directions[c]);
      mean += blend.weights[c] * corner;
      EXPECT_TRUE(
          glm::all(glm::lessThan(glm::abs(corner - direction / largest), glm::dvec3(1.0 / int(set)))));
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_LT(glm::length(mean - direction / largest), 1e-14);
    EXPECT_EQ(std::set<int>(blend.directions.begin(), blend.directions.end()).size(), 4u);
  }
}

/// Any function of the directions must look up to the same on both sides of a face, edge or line between
/// quads.
TEST(Directions, BilinearIsContinuousAcrossFacesAndQuads) {
  std::mt19937 random(2);
  for (int i = 0; i < 6000; ++i) {
    const DirectionSet set = kSets[i % 2];
    const auto lookUp = [&](glm::dvec3 direction) {
      const DirectionBlend blend = bilinearDirections(set, direction);
      double sum = 0.0;
      for (std::size_t c = 0; c < 4; ++c) sum += blend.weights[c] * std::sin(1.0 + 5.0 * blend.directions[c]);
      return sum;
    };
    glm::dvec3 direction = randomDirection(random);
    const int a = i % 3, b = (i + 1) % 3;
    const double ratios[] = {-1.0, -0.5, 0.0, 0.5, 1.0};
    direction[a] = ratios[i / 6 % 5] * direction[b];
    glm::dvec3 nudge(0.0);
    nudge[a] = 1e-9 * glm::length(direction);
    EXPECT_NEAR(lookUp(direction - nudge), lookUp(direction + nudge), 1e-6);
  }
}

TEST(Directions, NearestRoundsOnTheFaceOfTheCubeHalvesTowardsZero) {
  const auto nearest = [](DirectionSet set, glm::dvec3 direction) {
    return directionCell(set, nearestDirection(set, direction));
  };
  const DirectionSet k1 = DirectionSet::Directions26, k2 = DirectionSet::Directions98;
  EXPECT_EQ(nearest(k1, {2.0, 0.99, -0.99}), glm::ivec3(1, 0, 0));
  EXPECT_EQ(nearest(k1, {2.0, 1.01, -0.99}), glm::ivec3(1, 1, 0));
  EXPECT_EQ(nearest(k1, {-2.0, 1.01, -1.01}), glm::ivec3(-1, 1, -1));
  EXPECT_EQ(nearest(k1, {2.0, 1.0, -1.0}), glm::ivec3(1, 0, 0));
  EXPECT_EQ(nearest(k2, {4.0, 0.99, -1.01}), glm::ivec3(2, 0, -1));
  EXPECT_EQ(nearest(k2, {2.99, -4.0, 3.01}), glm::ivec3(1, -2, 2));
  EXPECT_EQ(nearest(k2, {1.0, 3.0, -4.0}), glm::ivec3(0, 1, -2));
}

/// Nearest is one of the bilinear corners, the heaviest.
TEST(Directions, NearestIsTheHeaviestBilinearCorner) {
  std::mt19937 random(3);
  for (int i = 0; i < 4000; ++i) {
    const DirectionSet set = kSets[i % 2];
    const glm::dvec3 direction = randomDirection(random);
    const DirectionBlend blend = bilinearDirections(set, direction);
    const auto heaviest =
        std::max_element(blend.weights.begin(), blend.weights.end()) - blend.weights.begin();
    EXPECT_EQ(nearestDirection(set, direction), blend.directions[std::size_t(heaviest)]);
  }
}

}  // namespace
}  // namespace freevoxels
