// Phase function and directions' shares: they integrate to one.

#include "engine/scene/lighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace freevoxels {
namespace {

TEST(Lighting, PhaseFunctionIntegratesToOne) {
  for (const double g : {-0.9, -0.3, 0.0, 0.5, 0.85, kMaxPhaseG}) {
    // Over the angle, in steps that are finest forwards and backwards.
    constexpr int kSteps = 200000;
    double sum = 0.0, mean = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = std::numbers::pi * (i + 0.5) / kSteps;
      const double part = 2.0 * std::numbers::pi * std::sin(angle) * std::numbers::pi / kSteps *
                          phaseFunction(g, std::cos(angle));
      sum += part;
      mean += part * std::cos(angle);
    }
    EXPECT_NEAR(sum, 1.0, 1e-5) << g;
    EXPECT_NEAR(mean, g, 1e-4);  // what g means
  }
  EXPECT_DOUBLE_EQ(phaseFunction(0.0, 0.3), 1.0 / (4.0 * std::numbers::pi));
}

TEST(Lighting, SurfacesAreTwoSidedAndScatterAsMuchAsTheyGet) {
  const glm::dvec3 normal(0.0, 0.0, 1.0), toEye = glm::normalize(glm::dvec3(0.2, -0.1, 1.0));
  constexpr int kCount = 40000;
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount, across = std::sqrt(1.0 - z * z);
    const glm::dvec3 way(across * std::cos(2.399963 * i), across * std::sin(2.399963 * i), z);
    sum += surfaceScattering(normal, way, toEye) * 4.0 * std::numbers::pi / kCount;
    EXPECT_DOUBLE_EQ(surfaceScattering(normal, way, toEye), surfaceScattering(-normal, way, toEye));
  }
  EXPECT_NEAR(sum, 1.0, 0.03);
  EXPECT_EQ(surfaceShare(0.0), 0.0);
  EXPECT_EQ(surfaceShare(0.5), 1.0);
}

TEST(Lighting, SharesOfDirectionsAddUpToOneAndFollowTheVoxelsShape) {
  glm::dmat4 stretched(1.0);
  stretched[2][2] = 3.0;
  for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98})
    for (const glm::dmat4& transform : {glm::dmat4(1.0), stretched}) {
      const std::vector<double> shares = directionShares(set, transform);
      EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-12);
      // Directions spread evenly over the sphere, by a spiral from pole to pole.
      constexpr int kCount = 40000;
      std::vector<double> found(shares.size(), 0.0);
      for (int i = 0; i < kCount; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / kCount, across = std::sqrt(1.0 - z * z);
        const glm::dvec3 way(across * std::cos(2.399963 * i), across * std::sin(2.399963 * i), z);
        const DirectionBlend blend = bilinearDirections(set, glm::inverse(glm::dmat3(transform)) * way);
        for (std::size_t k = 0; k < 4; ++k)
          found[std::size_t(blend.directions[k])] += blend.weights[k] / kCount;
      }
      for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_NEAR(found[i], shares[i], 1e-4);
    }
}

}  // namespace
}  // namespace freevoxels
