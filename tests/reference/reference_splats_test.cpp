// The splat sums against closed forms: Subr et al. 2007, Section 4.1, Eq. 8 to 10, the kernel's integral, and
// Beer-Lambert.

#include "engine/reference/reference_splats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "engine/scene/footprint.h"
#include "engine/volume/subject.h"
#include "tests/image_measures.h"
#include "tests/reference/reference_scene.h"

namespace freevoxels {
namespace {

using namespace test;

double footprint(double r) {
  const double inside = std::max(0.0, 1.0 - r * r / (kFootprintRadius * kFootprintRadius));
  return kFootprintPeak * std::pow(inside, 4.0);
}

/// A single pixel, far smaller than a voxel, whose centre looks along -z through (x, y).
SplatSums sumsAt(const Scene& scene, double x, double y, bool gradient = true) {
  FrameSettings settings = frameOf({1, 1}, Composite::Additive);
  settings.splats().gradient = gradient;
  return scene.sums(lookingDown(x, y, 1e-3), settings).at(0);
}

/// p and q side by side in front, s and t behind them (Figure 4): opacities differ, one colour each.
struct TwoLayers {
  const double a =
      127.0 / 255.0;  ///< opacities of p and q, such that the table's bytes hold 1 - a and 1 - b exactly
  const double b = 51.0 / 255.0;
  Scene scene;

  static double sigma(double opacity) { return -std::log1p(-opacity); }
  TwoLayers()
      : scene(makeVolume({2, 1, 2}, glm::dmat4(1.0),
                         [](int x, int, int) { return sigma(x == 0 ? 127.0 / 255.0 : 51.0 / 255.0); }),
              physical(1.0, {1.0f, 0.5f, 0.25f}), AttenuationCode::Linear8) {}
};

TEST(ReferenceSplats, TwoLayersOfTwoVoxelsAddUpAsEquation10) {
  const TwoLayers layers;
  for (const double x : {0.0, 0.2, 0.5, 0.9}) {
    const double wp = footprint(x), wq = footprint(1.0 - x);
    const double p = wp * layers.a, q = wq * layers.b;  // of voxels with A = 1
    const double s = (1.0 - layers.a) * wp * layers.a, t = (1.0 - layers.b) * wq * layers.b;
    const SplatSums sums = sumsAt(layers.scene, x, 0.0, false);
    EXPECT_NEAR(sums.energy, p + q + s + t, 1e-6);  // the scalars are floats
    EXPECT_NEAR(sums.color.r, p + q + s + t, 1e-6);
    EXPECT_NEAR(sums.color.g, 0.5 * (p + q + s + t), 1e-6);
    EXPECT_NEAR(sums.depth, 2.0 * (wp * TwoLayers::sigma(layers.a) + wq * TwoLayers::sigma(layers.b)), 1e-6);
    // Front layer at z = 1, back layer at z = 0, the eye at z = 20.
    EXPECT_NEAR(sums.distance, 19.0 * (p + q) + 20.0 * (s + t), 1e-5);
  }
}

/// Bytes made up so that the depth above the middle voxel is a ramp along x: across the whole footprint it is
/// followed, and never below 0.
TEST(ReferenceSplats, TransmittanceFollowsARampOfDepthAcrossTheFootprint) {
  Scene scene(makeVolume({3, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }), physical(0.5));
  const auto depthOf = [](int byte) { return decodeOpticalDepth(AttenuationCode::Depth8, byte); };
  scene.table[std::size_t(directionIndex(DirectionSet::Directions26, {0, 0, 1}))] = {0, 60, 90};
  const double slope = (depthOf(90) - depthOf(0)) / 2.0;
  scene.voxels = {1};
  for (const double x : {-1.2, -0.7, 0.0, 0.4, 1.1}) {
    const double depth = std::max(depthOf(60) + slope * x, 0.0);
    const double layer = -std::expm1(-0.5) * footprint(x);
    EXPECT_NEAR(sumsAt(scene, 1.0 + x, 0.0).energy, layer * std::exp(-depth), 1e-6) << x;
    EXPECT_NEAR(sumsAt(scene, 1.0 + x, 0.0, false).energy, layer * std::exp(-depthOf(60)), 1e-6) << x;
  }
}

TEST(ReferenceSplats, NormalisedWeighsAVoxelOverItsKernelsDepth) {
  const std::array<double, 3> sigma{2.5, 0.8, 1.7};
  Scene scene(makeVolume({1, 1, 3}, glm::dmat4(1.0), [&](int, int, int z) { return sigma[std::size_t(z)]; }),
              physical(1.0));
  scene.voxels = {1};
  const int towardsEye = directionIndex(DirectionSet::Directions26, {0, 0, 1});
  const double inFront = decodeOpticalDepth(AttenuationCode::Depth8, scene.table[std::size_t(towardsEye)][1]);
  constexpr int kSteps = 4000;
  double seen = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = 2.0 * (i + 0.5) / kSteps - 1.0;  // away from the eye
    const double before = std::min(z + 0.5, 0.0) * std::min(sigma[2], inFront);
    const double within = std::clamp(z + 0.5, 0.0, 1.0) * sigma[1];
    const double behind = std::max(z - 0.5, 0.0) * sigma[0];
    seen += (1.0 - std::abs(z)) * std::exp(-(inFront + before + within + behind)) * 2.0 / kSteps;
  }
  const double energy = scene.sums(lookingDown(0.0, 0.0, 1e-3), frameOf({1, 1})).at(0).energy;
  EXPECT_NEAR(energy, sigma[1] * seen * footprint(0.0), 1e-6);
}

TEST(ReferenceSplats, ASingleVoxelInFrontOfAnotherAttenuatesItByOneMinusAlpha) {
  const Scene scene(makeVolume({1, 1, 2}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }),
                    physical(std::log(2.0)));
  const double byte = std::round(255.0 * std::sqrt(std::log(2.0) / 16.0)) / 255.0;
  const double energy = 0.5 * footprint(0.3) * (1.0 + std::exp(-16.0 * byte * byte));
  EXPECT_NEAR(sumsAt(scene, 0.3, 0.0).energy, energy, 1e-6);
}

/// With weights that add up to 1 and equal opacities, Eq. 10 is Eq. 8, where alpha blending (Eq. 9) leaks.
TEST(ReferenceSplats, FullLayersComposeAsEquation8AndNotAsEquation9) {
  const double alpha = 153.0 / 255.0;
  const Scene scene(makeVolume({7, 7, 2}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }),
                    physical(-std::log1p(-alpha)), AttenuationCode::Linear8);
  for (const glm::dvec2 at : {glm::dvec2(3.0, 3.0), glm::dvec2(3.5, 3.0), glm::dvec2(3.3, 2.6)}) {
    double blended = 1.0;  // transmittance of one layer in Eq. 9: every splat attenuates by itself
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 7; ++x) blended *= 1.0 - alpha * footprint(glm::length(glm::dvec2(x, y) - at));
    const double equation8 = alpha + (1.0 - alpha) * alpha;
    const double equation9 = (1.0 - blended) + blended * (1.0 - blended);
    const double energy = sumsAt(scene, at.x, at.y).energy;
    EXPECT_NEAR(energy, equation8, 0.003 * equation8);  // the lattice sum's ripple
    EXPECT_GT(std::abs(energy - equation9), 0.02);
  }
}

TEST(ReferenceSplats, LatticeSumOfTheFootprintIsConstantToThreeTenthsOfAPercent) {
  const double sigma = 0.25;
  const Scene scene(makeVolume({9, 9, 16}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }),
                    physical(sigma));
  double lowest = 1e9, highest = 0.0;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= i; ++j) {
      const double ratio = sumsAt(scene, 4.0 + 0.05 * i, 4.0 + 0.05 * j).depth / (16.0 * sigma);
      lowest = std::min(lowest, ratio);
      highest = std::max(highest, ratio);
    }
  EXPECT_GT(lowest, 0.997);
  EXPECT_LT(highest, 1.003);
  EXPECT_GT(highest - lowest, 1e-4) << "the kernel is no longer the one that is documented";
}

/// sigma times the voxel's world volume, from the depths of all pixels, orthographic.
double integral(const Camera& camera, const Volume& voxel, glm::ivec2 size, double sigma) {
  const Scene scene(voxel, physical(sigma));
  double sum = 0.0;
  for (const SplatSums& s : scene.sums(camera, frameOf(size))) sum += s.depth;
  const double pixel = camera.orthographicHeight / size.y;
  return sum * pixel * pixel;
}

/// The mean over 4 x 4 positions of the pixel grid: what is left of the sampling error of a single one is
/// negligible.
double meanIntegral(const Camera& camera, const Volume& voxel, int size, double sigma) {
  const glm::dmat3 axes = glm::transpose(glm::dmat3(worldToCamera(camera)));
  const double step = camera.orthographicHeight / size / 4.0;
  double sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    const glm::dvec3 shift = axes[0] * (i % 4 * step) + axes[1] * (i / 4 * step);
    Camera shifted = camera;
    shifted.position += shift;
    shifted.lookAt += shift;
    sum += integral(shifted, voxel, {size, size}, sigma) / 16.0;
  }
  return sum;
}

TEST(ReferenceSplats, OneVoxelsFootprintIntegratesToItsVolume) {
  const double sigma = 0.7;
  glm::dmat4 sheet(1.0);
  sheet[0][0] = 6.0;
  sheet[1][1] = 0.2;
  for (const glm::dmat4& transform : {glm::dmat4(1.0), sheared(), sheet}) {
    const Volume voxel = makeVolume({1, 1, 1}, transform, [](int, int, int) { return 1.0; });
    const double expected = sigma * std::abs(glm::determinant(glm::dmat3(transform)));
    for (const double azimuth : {0.0, 40.0, -120.0}) {
      Camera base;
      base.orthographic = true;
      Camera camera = framingCamera(voxel, azimuth, 33.0, 1.0, base);
      camera.orthographicHeight *= 3.0;  // the kernel is larger than the voxel
      EXPECT_NEAR(integral(camera, voxel, {300, 300}, sigma), expected, 1e-4 * expected);
      // From a few pixels to a hundredth of one, where it is widened to the pixel, in one direction or in
      // both.
      for (const double scale : {3.0, 9.0, 27.0, 300.0}) {
        Camera far = camera;
        far.orthographicHeight *= scale;
        EXPECT_NEAR(meanIntegral(far, voxel, 24, sigma), expected, 5e-4 * expected)
            << azimuth << " " << scale;
        EXPECT_NEAR(integral(far, voxel, {24, 24}, sigma), expected, 0.04 * expected)
            << azimuth << " " << scale;
      }
    }
  }
}

TEST(ReferenceSplats, ASubPixelVoxelIsAsBrightWhereverInThePixelItFalls) {
  const Volume voxel = makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; });
  for (double x = 0.0; x < 50.0; x += 7.3) {
    const Camera camera = lookingDown(x, 0.4 * x, 400.0);  // pixels of 50 voxels
    EXPECT_NEAR(integral(camera, voxel, {8, 8}, 1.0), 1.0, 0.004);
  }
}

/// Perspective: a pixel sees an area of pixel² at distance 1, grown by the distance; the sum approaches the
/// volume.
TEST(ReferenceSplats, PerspectiveKeepsTheVolumeOfADistantVoxel) {
  const Scene scene(makeVolume({1, 1, 1}, sheared(), [](int, int, int) { return 1.0; }), physical(0.7));
  Camera camera;
  camera.verticalFov = 3.0;
  camera = framingCamera(scene.volume, 25.0, 40.0, 1.0, camera);
  camera.verticalFov = 10.0;
  const double distance = glm::length(camera.position - camera.lookAt);
  for (const int size : {200, 12}) {
    double sum = 0.0;
    for (const SplatSums& s : scene.sums(camera, frameOf({size, size}))) sum += s.depth;
    const double pixel = 2.0 * std::tan(5.0 * std::numbers::pi / 180.0) * distance / size;
    const double expected = 0.7 * std::abs(glm::determinant(glm::dmat3(sheared())));
    EXPECT_NEAR(sum * pixel * pixel, expected, 0.01 * expected);
  }
}

/// At every pixel, the kernel as a function of the distance of the pixel's own ray to the voxel: no affine
/// approximation.
TEST(ReferenceSplats, PerspectiveFootprintIsExactOnEveryRay) {
  const Scene scene(makeVolume({1, 1, 1}, sheared(), [](int, int, int) { return 1.0; }), physical(1.0));
  Camera camera;  // close by, the voxel near the corner of the image
  camera.position = {2.5, 0.0, 4.0};
  camera.lookAt = {3.2, -0.3, 0.6};
  camera.verticalFov = 80.0;
  const glm::ivec2 size(64, 48);
  const std::vector<SplatSums> sums = scene.sums(camera, frameOf(size));
  const PixelRays rays = pixelRays(camera, size, sheared());
  double largest = 0.0;
  int covered = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec3 ray = rays.direction + (x + 0.5) * rays.directionX + (y + 0.5) * rays.directionY;
      const double r = glm::length(glm::cross(rays.origin, ray)) / glm::length(ray);  // of the voxel at 0
      const double expected = footprint(r) * glm::length(glm::dmat3(sheared()) * ray) / glm::length(ray);
      const double found = sums[std::size_t(y * size.x + x)].depth;
      EXPECT_NEAR(found, expected, 1e-9);
      largest = std::max(largest, found);
      covered += found > 0.0;
    }
  EXPECT_GT(largest, 0.1);
  EXPECT_GT(covered, 100);
  EXPECT_LT(covered, size.x * size.y);
}

/// Through the voxel's middle: the integral of (1 - rho²/R²)^(7/2) over what is in front of the eye.
TEST(ReferenceSplats, AKernelThatTheEyePlaneCutsCountsFromTheEyeOn) {
  const Scene scene(makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }), physical(1.0));
  const auto depthFrom = [&](double z) {
    Camera camera;
    camera.position = {0.0, 0.0, z};
    camera.lookAt = {0.0, 0.0, -100.0};
    return scene.sums(camera, frameOf({1, 1})).at(0).depth;
  };
  const auto expected = [](double z) {
    constexpr int kSteps = 20000;
    double ahead = 0.0, all = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps * 2.0 - 1.0, kernel = std::pow(1.0 - t * t, 3.5);
      all += kernel;
      if (t * kFootprintRadius < z) ahead += kernel;
    }
    return footprint(0.0) * ahead / all;
  };
  for (const double z : {1.39, 1.0, 0.5, 0.2, 0.0, -0.3, -0.9})
    EXPECT_NEAR(depthFrom(z), expected(z), 1e-4) << z;
  EXPECT_NEAR(depthFrom(kFootprintRadius - 1e-6), depthFrom(kFootprintRadius + 1e-6), 1e-9);
  EXPECT_EQ(depthFrom(-kFootprintRadius - 1e-6), 0.0);
}

/// Its whole kernel at once, by about the same part.
TEST(ReferenceSplats, AnOrthographicEyePlaneFadesKernels) {
  const Scene scene(makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }), physical(1.0));
  const auto depthFrom = [&](double z) {
    Camera camera = lookingDown(0.0, 0.0, 1e-3);
    camera.position.z = z;
    camera.lookAt.z = -100.0;
    return scene.sums(camera, frameOf({1, 1})).at(0).depth / footprint(0.0);
  };
  EXPECT_NEAR(depthFrom(2.0), 1.0, 1e-6);
  EXPECT_NEAR(depthFrom(0.0), 0.5, 1e-6);
  EXPECT_NEAR(depthFrom(0.4) + depthFrom(-0.4), 1.0, 1e-6);
  EXPECT_EQ(depthFrom(-1.5), 0.0);
}

/// A cloud-like volume of 12 x 9 x 10 sheared voxels, a third of them empty.
Scene randomScene() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  return Scene(makeVolume({12, 9, 10}, sheared(),
                          [&](int, int, int) { return std::max(0.0, uniform(random) - 0.33); }),
               physical(1.5, {0.9f, 0.6f, 0.3f}));
}

TEST(ReferenceSplats, OrderOfTheVoxelsDoesNotMatter) {
  const Scene scene = randomScene();
  const Camera camera = framingCamera(scene.volume, 35, 25, 1.5, Camera{});
  for (const Composite composite : {Composite::Normalised, Composite::Additive}) {
    const FrameSettings settings = frameOf({60, 40}, composite);
    std::vector<std::uint32_t> shuffled = scene.voxels;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(9));
    const Image image = referenceResolve(scene.sums(camera, settings), settings);
    EXPECT_GT(image.pixels[20 * 60 + 30].a, 0.3f);
    EXPECT_LT(largestPixelDifference(image, referenceResolve(scene.sums(camera, settings, shuffled), settings)),
              1e-6);
  }
}

TEST(ReferenceSplats, GroupsOfVoxelsDrawnAloneAddUpToTheImage) {
  const Scene scene = randomScene();
  const Camera camera = framingCamera(scene.volume, -60, 10, 1.0, Camera{});
  FrameSettings settings = frameOf({48, 48});
  settings.depth = true;
  std::mt19937 random(11);
  for (const unsigned groups : {2u, 5u}) {
    std::vector<std::vector<std::uint32_t>> lists(groups);
    for (const std::uint32_t voxel : scene.voxels) lists[random() % groups].push_back(voxel);
    std::vector<SplatSums> total(48 * 48);
    for (const auto& list : lists) {
      const std::vector<SplatSums> part = scene.sums(camera, settings, list);
      for (std::size_t i = 0; i < total.size(); ++i) {
        total[i].color += part[i].color;
        total[i].energy += part[i].energy;
        total[i].depth += part[i].depth;
        total[i].distance += part[i].distance;
      }
    }
    const Image whole = referenceResolve(scene.sums(camera, settings), settings);
    const Image added = referenceResolve(total, settings);
    EXPECT_LT(largestPixelDifference(whole, added), 1e-6);
    for (std::size_t i = 0; i < whole.depth.size(); ++i) EXPECT_FLOAT_EQ(whole.depth[i], added.depth[i]);
  }
}

TEST(ReferenceSplats, EmptyVolumeIsTransparentAndInfinitelyFar) {
  const Scene scene(makeVolume({4, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return 0.0; }), physical(1.0));
  EXPECT_TRUE(scene.voxels.empty());
  FrameSettings settings = frameOf({8, 8});
  settings.depth = true;
  const Image image = referenceResolve(scene.sums(lookingDown(0, 0, 4), settings), settings);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(image.pixels[i], glm::vec4(0.0f));
    EXPECT_EQ(image.depth[i], std::numeric_limits<float>::infinity());
  }
}

TEST(ReferenceResolve, NormalisedKeepsTheColourMixAndTakesAlphaFromTheDepth) {
  FrameSettings settings = frameOf({3, 1});
  settings.depth = true;
  SplatSums ordinary{{0.2, 0.4, 0.0}, 0.8, std::log(4.0), 0.8 * 7.0};
  SplatSums dark{{0.0, 0.0, 0.0}, 0.0, 2.0, 0.0};  // linear8 may store A = 0 for all
  const std::vector<SplatSums> sums = {ordinary, dark, {}};
  const Image image = referenceResolve(sums, settings);
  EXPECT_LT(glm::length(image.pixels[0] - glm::vec4(0.1875f, 0.375f, 0.0f, 0.75f)), 1e-6f);
  EXPECT_FLOAT_EQ(image.pixels[1].a, float(1.0 - std::exp(-2.0)));
  EXPECT_EQ(glm::vec3(image.pixels[1]), glm::vec3(0.0f));
  EXPECT_EQ(image.depth[0], 7.0f);
  EXPECT_EQ(image.depth[1], std::numeric_limits<float>::infinity());

  settings.splats().composite = Composite::Additive;
  settings.depth = false;
  const Image additive = referenceResolve(sums, settings);
  EXPECT_LT(glm::length(additive.pixels[0] - glm::vec4(0.2f, 0.4f, 0.0f, 0.8f)), 1e-6f);
  EXPECT_TRUE(additive.depth.empty());
}

/// Both look-ups are exact where the view is a lattice direction, and differ between.
TEST(ReferenceSplats, LooksTheTableUpInTheDirectionOfTheEye) {
  Scene scene(makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; }), physical(1.0));
  const auto energyTowards = [&](glm::dvec3 toEye, AttenuationLookup lookup) {
    Camera camera = lookingDown(0, 0, 1e-3);
    camera.position = 9.0 * toEye;
    camera.lookAt = glm::dvec3(0.0);
    FrameSettings settings = frameOf({1, 1}, Composite::Additive);
    settings.splats().attenuation = lookup;
    return scene.sums(camera, settings).at(0).energy;
  };
  for (int d = 0; d < directionCount(DirectionSet::Directions26); ++d) {
    for (auto& bytes : scene.table) bytes[0] = 200;
    scene.table[std::size_t(d)][0] = 0;  // clear in this direction only
    const glm::dvec3 direction = directionAt(DirectionSet::Directions26, d);
    if (direction.x == 0.0 && direction.z == 0.0) continue;  // along `up`
    const double layer = glm::length(direction);
    const double clear = -std::expm1(-layer) / layer * footprint(0.0);
    EXPECT_NEAR(energyTowards(direction, AttenuationLookup::Bilinear), clear, 1e-9);
    EXPECT_NEAR(energyTowards(direction, AttenuationLookup::Nearest), clear, 1e-9);
    EXPECT_LT(energyTowards(-direction, AttenuationLookup::Bilinear), 0.01 * clear);
  }
  scene.table[std::size_t(directionIndex(DirectionSet::Directions26, {0, 0, 1}))][0] = 0;
  scene.table[std::size_t(directionIndex(DirectionSet::Directions26, {1, 0, 1}))][0] = 255;
  const glm::dvec3 between(0.25, 0.0, 1.0);
  const double layer = glm::length(between);
  const double opaque = std::exp(-16.0 * layer / std::sqrt(2.0));  // as long as the line that is asked for
  const double emitted = -std::expm1(-layer) / layer * footprint(0.0);
  EXPECT_NEAR(energyTowards(between, AttenuationLookup::Nearest), emitted, 1e-9);
  EXPECT_NEAR(energyTowards(between, AttenuationLookup::Bilinear), (0.75 + 0.25 * opaque) * emitted, 1e-9);
}

}  // namespace
}  // namespace freevoxels
