#include "engine/attenuation/directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace freevoxels {
namespace {

constexpr AttenuationCode kCodes[] = {AttenuationCode::Depth8, AttenuationCode::Linear8};

glm::dvec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

TEST(Directions, AreTheTwentySixLatticeSteps) {
  std::set<int> seen;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        const int index = directionIndex(x, y, z);
        EXPECT_EQ(directionAt(index), glm::ivec3(x, y, z));
        EXPECT_EQ(directionAt(25 - index), glm::ivec3(-x, -y, -z));
        seen.insert(index);
      }
  EXPECT_EQ(seen.size(), 26u);
  EXPECT_EQ(*seen.begin(), 0);
  EXPECT_EQ(*seen.rbegin(), 25);
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
  EXPECT_NEAR(stepLength(matrix, {1, 0, 0}, false), 3.0, 1e-12);  // the cube root of 2 * 3 * 4.5
  EXPECT_NEAR(stepLength(matrix, {-1, 1, 1}, false), 3.0, 1e-12);
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

TEST(Directions, BilinearReproducesLatticeDirections) {
  for (int index = 0; index < kDirectionCount; ++index)
    for (const double scale : {1.0, 1e-30, 37.5}) {
      const DirectionBlend blend = bilinearDirections(scale * glm::dvec3(directionAt(index)));
      double weight = 0.0;
      for (std::size_t i = 0; i < 4; ++i)
        if (blend.directions[i] == index) weight += blend.weights[i];
      EXPECT_DOUBLE_EQ(weight, 1.0);
      EXPECT_EQ(nearestDirection(scale * glm::dvec3(directionAt(index))), index);
    }
}

/// The blend of the corners is the direction itself: it is linear on a face of the cube.
TEST(Directions, BilinearWeightsAddUpAndBlendToTheDirection) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 direction = randomDirection(random);
    const glm::dvec3 absolute = glm::abs(direction);
    const double largest = std::max({absolute.x, absolute.y, absolute.z});
    const DirectionBlend blend = bilinearDirections(direction);
    double sum = 0.0;
    glm::dvec3 mean(0.0);
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_GE(blend.weights[c], 0.0);
      ASSERT_GE(blend.directions[c], 0);
      ASSERT_LT(blend.directions[c], kDirectionCount);
      sum += blend.weights[c];
      mean += blend.weights[c] * glm::dvec3(directionAt(blend.directions[c]));
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_LT(glm::length(mean - direction / largest), 1e-14);
    EXPECT_EQ(std::set<int>(blend.directions.begin(), blend.directions.end()).size(), 4u);
  }
}

/// Any function of the lattice directions must look up to the same on both sides of a face, edge or middle
/// line.
TEST(Directions, BilinearIsContinuousAcrossFacesAndQuads) {
  const auto lookUp = [](glm::dvec3 direction) {
    const DirectionBlend blend = bilinearDirections(direction);
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c) sum += blend.weights[c] * std::sin(1.0 + 5.0 * blend.directions[c]);
    return sum;
  };
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    glm::dvec3 direction = randomDirection(random);
    const int a = i % 3, b = (i + 1) % 3;
    direction[a] = i % 2 == 0 ? direction[b] : (i % 4 == 1 ? -direction[b] : 0.0);
    glm::dvec3 nudge(0.0);
    nudge[a] = 1e-9 * glm::length(direction);
    EXPECT_NEAR(lookUp(direction - nudge), lookUp(direction + nudge), 1e-6);
  }
}

TEST(Directions, NearestRoundsOnTheFaceOfTheCubeHalvesTowardsZero) {
  EXPECT_EQ(nearestDirection({2.0, 0.99, -0.99}), directionIndex(1, 0, 0));
  EXPECT_EQ(nearestDirection({2.0, 1.01, -0.99}), directionIndex(1, 1, 0));
  EXPECT_EQ(nearestDirection({-2.0, 1.01, -1.01}), directionIndex(-1, 1, -1));
  EXPECT_EQ(nearestDirection({2.0, 1.0, -1.0}), directionIndex(1, 0, 0));
}

/// Nearest is one of the bilinear corners, the heaviest.
TEST(Directions, NearestIsTheHeaviestBilinearCorner) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 direction = randomDirection(random);
    const DirectionBlend blend = bilinearDirections(direction);
    const auto heaviest =
        std::max_element(blend.weights.begin(), blend.weights.end()) - blend.weights.begin();
    EXPECT_EQ(nearestDirection(direction), blend.directions[std::size_t(heaviest)]);
  }
}

}  // namespace
}  // namespace freevoxels
