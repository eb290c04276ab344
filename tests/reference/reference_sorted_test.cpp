// The sorted image against closed forms: Subr et al. 2007, Section 4.1, Eq. 8 and 9, and what leaks against
// Beer-Lambert.

#include "engine/reference/reference_sorted.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/scene/footprint.h"
#include "engine/volume/voxel_classifier.h"
#include "tests/reference/reference_scene.h"

namespace freevoxels {
namespace {

using namespace test;

double footprint(glm::dvec2 offset) {
  const double inside = std::max(0.0, 1.0 - glm::dot(offset, offset) / (kFootprintRadius * kFootprintRadius));
  return kFootprintPeak * std::pow(inside, 4.0);
}

double sigmaOf(double opacity) {
  return -std::log1p(-opacity);
}

/// A single pixel, far smaller than a voxel, whose centre looks along -z through (x, y).
Image sortedAt(const Scene& scene, glm::dvec2 at) {
  FrameSettings settings = frameOf({1, 1}, Composite::Sorted);
  settings.depth = true;
  return referenceSortedImage(scene.volume, scene.classification, lookingDown(at.x, at.y, 1e-3), settings, scene.voxels);
}

/// p and q in front (z = 1), s and t behind (Figure 4), each with its own colour and opacity.
TEST(ReferenceSorted, TwoLayersOfTwoVoxelsComposeAsEquation9) {
  const std::vector<double> opacity{0.3, 0.7, 0.5, 0.2};  // s, t, p, q: in the order of their indices
  Classification classification;
  classification.transferFunction.emplace();
  auto& points = classification.transferFunction->opacity;
  auto& colors = classification.transferFunction->color;
  for (int i = 0; i < 4; ++i) {
    points.push_back({float(i), float(opacity[std::size_t(i)])});
    colors.push_back({float(i), {0.2f * float(i), 1.0f - 0.3f * float(i), 0.5f}});
  }
  const Scene scene(
      makeVolume({2, 1, 2}, glm::dmat4(1.0), [](int x, int, int z) { return double(x + 2 * z); }),
      classification);
  const VoxelClassifier classifier(scene.classification, scene.volume);
  for (const double x : {0.0, 0.2, 0.5, 0.9}) {
    glm::dvec4 expected(0.0);
    double distance = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const ClassifiedVoxel voxel = classifier.at({int(i) % 2, 0, int(i) / 2});
      const double a = -std::expm1(-voxel.extinction) * footprint({x - double(i % 2), 0.0});
      expected = a * glm::dvec4(voxel.color, 1.0) + (1.0 - a) * expected;
      distance = a * (i < 2 ? 20.0 : 19.0) + (1.0 - a) * distance;  // the eye is at z = 20
    }
    const Image image = sortedAt(scene, {x, 0.0});
    EXPECT_LT(glm::length(glm::dvec4(image.pixels[0]) - expected), 2e-6) << x;
    EXPECT_NEAR(image.depth[0], distance / expected.a, 1e-5) << x;
  }
}

/// The transmittance of a homogeneous block is the product of all its splats' own, and above Beer-Lambert's.
TEST(ReferenceSorted, ABlockLeaksByTheProductOfOverlappingSplats) {
  const double alpha = 0.6;
  for (const int layers : {1, 2, 6}) {
    const Scene scene(makeVolume({7, 7, layers}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }),
                      physical(sigmaOf(alpha)));
    for (const glm::dvec2 at : {glm::dvec2(3.0, 3.0), glm::dvec2(3.5, 3.0), glm::dvec2(3.5, 3.5)}) {
      double product = 1.0;
      for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 7; ++x)
          product *= std::pow(1.0 - alpha * footprint(glm::dvec2(x, y) - at), layers);
      const double beerLambert = std::pow(1.0 - alpha, layers);
      EXPECT_NEAR(1.0 - double(sortedAt(scene, at).pixels[0].a), product, 1e-6);
      EXPECT_GT(product, 1.1 * beerLambert) << layers;
      const FrameSettings settings = frameOf({1, 1});
      const Image normalised =
          referenceResolve(scene.sums(lookingDown(at.x, at.y, 1e-3), settings), settings);
      EXPECT_NEAR(1.0 - double(normalised.pixels[0].a), beerLambert,
                  0.003 * sigmaOf(alpha) * layers * beerLambert);
    }
  }
}

/// Figure 6's grid: between four voxels more leaks than in the middle of one, where one splat has most of the
/// weight.
TEST(ReferenceSorted, TheLeakFollowsTheGrid) {
  const Scene scene(makeVolume({7, 7, 4}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }),
                    physical(sigmaOf(0.6)));
  const double between = 1.0 - double(sortedAt(scene, {3.5, 3.5}).pixels[0].a);
  const double middle = 1.0 - double(sortedAt(scene, {3.0, 3.0}).pixels[0].a);
  EXPECT_GT(between, 1.5 * middle);
}

TEST(ReferenceSorted, FarVoxelsComeFirstAndTiesByIndex) {
  const Scene scene(makeVolume({3, 3, 2}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }), physical(1.0));
  Camera camera = lookingDown(1.0, 1.0, 4.0);
  std::vector<std::uint32_t> ascending(18);
  for (std::uint32_t i = 0; i < 18; ++i) ascending[i] = i;  // z = 0 is farther than z = 1
  EXPECT_EQ(referenceBackToFront(scene.volume, camera, scene.voxels), ascending);
  camera.orthographic = false;
  EXPECT_EQ(referenceBackToFront(scene.volume, camera, scene.voxels),
            (std::vector<std::uint32_t>{0, 2, 6, 8, 1, 3, 5, 7, 4, 9, 11, 15, 17, 10, 12, 14, 16, 13}));
}

TEST(ReferenceSorted, EmptyVolumeIsTransparentAndInfinitelyFar) {
  const Scene scene(makeVolume({4, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return 0.0; }), physical(1.0));
  const Image image = sortedAt(scene, {2.0, 2.0});
  EXPECT_EQ(image.pixels[0], glm::vec4(0.0f));
  EXPECT_EQ(image.depth[0], std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace freevoxels
