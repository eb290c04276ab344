// The oracle against closed forms, against a march in tiny steps, and the splats against the oracle.

#include "engine/reference/oracle.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "engine/reference/ray_march.h"
#include "engine/volume/subject.h"
#include "engine/volume/voxel_classifier.h"
#include "tests/image_measures.h"
#include "tests/reference/reference_scene.h"

namespace freevoxels {
namespace {

using namespace test;

constexpr double kStep = 0.2;

MarchedRay rayOf(const Volume& volume, glm::dvec3 origin, glm::dvec3 direction) {
  return {origin, direction, glm::length(glm::dmat3(volume.indexToWorld) * direction)};
}

Volume block(glm::ivec3 dimensions, const glm::dmat4& transform = glm::dmat4(1.0)) {
  return makeVolume(dimensions, transform, [](int, int, int) { return 1.0; });
}

/// The scalar s has the colour (s, 0.5, 1 - s) and an extinction that grows with it, 0.05 at 0.
Classification colored(double opacity = 0.9) {
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, 0.05f}, {1.0f, float(opacity)}},
                       .color = {{0.0f, {0.0f, 0.5f, 1.0f}}, {1.0f, {1.0f, 0.5f, 0.0f}}},
                       .unitDistance = 1.0};
  return classification;
}

/// Random scalars, a third of the voxels inactive.
Volume noise(glm::ivec3 dimensions, const glm::dmat4& transform) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> uniform;
  return makeVolume(dimensions, transform, [&](int, int, int) {
    const float value = uniform(random);
    return uniform(random) < 0.33f ? kInactiveVoxel : value;
  });
}

/// Midpoint rule with an own trilinear interpolation, of classified voxels or of scalars.
RaySum tinySteps(const Volume& volume, const Classification& classification, const MarchedRay& ray,
                 double end, int steps) {
  const VoxelClassifier classifier(classification, volume);
  const bool post = classification.isPost(volume);
  RaySum sum;
  double depth = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps * end;
    const glm::dvec3 at = ray.origin + t * ray.direction;
    glm::dvec3 emitted(0.0);
    double extinction = 0.0, scalar = 0.0, coverage = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 voxel =
          glm::ivec3(glm::floor(at)) + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 away = glm::abs(at - glm::dvec3(voxel));
      if (glm::any(glm::lessThan(voxel, glm::ivec3(0)))) continue;
      if (glm::any(glm::greaterThanEqual(voxel, volume.dimensions))) continue;
      const double weight = (1.0 - away.x) * (1.0 - away.y) * (1.0 - away.z);
      const double value = volume.scalars.at(voxel);
      if (post) {
        if (value == kInactiveVoxel) continue;
        scalar += weight * value;
        coverage += weight;
        continue;
      }
      const ClassifiedVoxel material = classifier.at(voxel);
      extinction += weight * material.extinction;
      emitted += weight * material.extinction * material.color;
    }
    if (coverage > 0.0) {
      const ClassifiedVoxel point = classify(classification, float(scalar / coverage));
      extinction = coverage * point.extinction;
      emitted = extinction * point.color;
    }
    if (extinction == 0.0) continue;
    const double thickness = extinction * ray.worldLength * end / steps;
    const double energy = std::exp(-depth) * -std::expm1(-thickness);
    sum.color += energy / extinction * emitted;
    sum.opacity += energy;
    sum.distance += energy * t;
    depth += thickness;
  }
  return sum;
}

TEST(RayMarch, AHomogeneousBlockIsBeerLambertWithItsSkirt) {
  const double sigma = 0.125;
  const Volume volume = block({20, 9, 30});
  const ReferenceField field(volume, physical(sigma, glm::vec3(0.5f, 0.25f, 1.0f)));
  // Half a voxel of skirt at both ends makes the block its whole length; at the sides it is a ramp.
  struct Side {
    double at, density;
  };
  for (const Side x : {Side{5.3, 1.0}, {7.0, 1.0}, {0.0, 1.0}, {-0.25, 0.75}, {19.9, 0.1}, {20.5, 0.0}})
    for (const Side y : {Side{4.0, 1.0}, {-0.5, 0.5}, {-1.0, 0.0}})
      for (const double z : {1.0, -1.0}) {
        const MarchedRay ray = rayOf(volume, {x.at, y.at, 15.0 - 50.0 * z}, {0.0, 0.0, z});
        const RaySum sum = marchRay(field, ray, kStep);
        const double expected = -std::expm1(-sigma * x.density * y.density * 30.0);
        EXPECT_NEAR(sum.opacity, expected, 1e-12) << x.at << " " << y.at;
        EXPECT_NEAR(sum.color.r, 0.5 * expected, 1e-12);
        EXPECT_NEAR(sum.color.b, expected, 1e-12);
      }
}

/// Cosines that are not quite 0, as orthographic cameras along an axis have them, on the planes between cells
/// and bricks.
TEST(RayMarch, RaysInThePlanesBetweenCellsMissNothing) {
  const Volume volume = block({20, 20, 30});
  const ReferenceField field(volume, physical(0.125));
  for (const double x : {6.0, 7.0, 7.0 - 1e-15, 7.0 + 1e-15, 15.0})
    for (const double tilt : {0.0, 6e-17, -6e-17, 1e-15, -1e-15})
      for (const double z : {1.0, -1.0}) {
        const MarchedRay ray = rayOf(volume, {x, 7.0, 15.0 - 50.0 * z}, {tilt, -tilt, z});
        EXPECT_NEAR(marchRay(field, ray, kStep).opacity, -std::expm1(-3.75), 1e-12) << x << " " << tilt;
      }
}

/// A slab of n layers, seen through the faces, is n times the length of a layer thick in any direction.
TEST(RayMarch, ObliqueRaysThroughAnySlabAreBeerLambert) {
  glm::dmat4 anisotropic(1.0);
  anisotropic[2][2] = 0.3;
  for (const glm::dmat4& transform : {glm::dmat4(1.0), anisotropic, sheared()}) {
    const Volume volume = block({60, 60, 5}, transform);
    const ReferenceField field(volume, physical(0.7));
    for (const glm::dvec3 direction :
         {glm::dvec3(0.0, 0.0, 1.0), {0.3, -0.2, -1.0}, {2.0, 1.7, 1.0}, {-1.0, 1.0, 1.0}}) {
      const MarchedRay ray = rayOf(volume, glm::dvec3(30.0, 30.0, 2.0) - 9.0 * direction, direction);
      const double length = 5.0 * ray.worldLength / std::abs(direction.z);
      EXPECT_NEAR(marchRay(field, ray, kStep).opacity, -std::expm1(-0.7 * length), 1e-7);
    }
  }
}

/// From the front: through the skirt (depth s²/2) and three voxels of the first colour, then one where the
/// second takes over linearly, then what is left.
TEST(RayMarch, TwoSlabsMixInTheOrderOfTheRay) {
  const Volume volume =
      makeVolume({5, 5, 8}, glm::dmat4(1.0), [](int, int, int z) { return z < 4 ? 0.0 : 1.0; });
  for (const double opacity : {0.1, 0.5, 0.99}) {
    Classification classification = colored();
    for (auto& point : classification.transferFunction->opacity) point.opacity = float(opacity);
    const ReferenceField field(volume, classification);
    const double sigma = classify(classification, 1.0f).extinction;
    const double total = -std::expm1(-8.0 * sigma), before = std::exp(-3.5 * sigma);
    const double front = 1.0 - before + before * (1.0 + std::expm1(-sigma) / sigma);
    for (const double z : {1.0, -1.0}) {
      const RaySum sum = marchRay(field, rayOf(volume, {2.2, 1.9, 4.0 - 20.0 * z}, {0.0, 0.0, z}), kStep);
      // A sixteenth of a voxel has one colour.
      EXPECT_NEAR(z < 0.0 ? sum.color.r : sum.color.b, front, 1e-3);
      EXPECT_NEAR(z < 0.0 ? sum.color.b : sum.color.r, total - front, 1e-3);
      EXPECT_NEAR(sum.color.g, 0.5 * total, 2e-7);
    }
  }
}

TEST(RayMarch, InactiveVoxelsAreNotThereWhateverTheTransferFunction) {
  const Volume volume =
      makeVolume({5, 5, 8}, glm::dmat4(1.0), [](int, int, int z) { return z < 4 ? 1.0f : kInactiveVoxel; });
  const Classification classification = colored(0.3);  // visible at every scalar
  const double sigma = classify(classification, 1.0f).extinction;
  const RaySum sum = marchRay(ReferenceField(volume, classification),
                              rayOf(volume, {2.0, 2.0, 20.0}, {0.0, 0.0, -1.0}), kStep);
  EXPECT_NEAR(sum.opacity, -std::expm1(-4.0 * sigma), 1e-7);
  EXPECT_NEAR(sum.color.r, sum.opacity, 1e-12);
}

TEST(RayMarch, FromWithinOnlyWhatIsAheadIsSeenAndItsMeanDistanceIsOneOverExtinction) {
  const Volume volume = block({5, 5, 80});
  const ReferenceField field(volume, physical(0.5));
  const RaySum sum = marchRay(field, rayOf(volume, {2.0, 2.0, 40.0}, {0.0, 0.0, 1.0}), kStep);
  EXPECT_NEAR(sum.distance / sum.opacity, 2.0, 1e-5);
  const RaySum near = marchRay(field, rayOf(volume, {2.0, 2.0, 75.0}, {0.0, 0.0, 1.0}), kStep);
  EXPECT_NEAR(near.opacity, -std::expm1(-0.5 * 4.5), 1e-12);
  EXPECT_EQ(marchRay(field, rayOf(volume, {2.0, 2.0, 80.0}, {0.0, 0.0, 1.0}), kStep).opacity, 0.0);
}

TEST(RayMarch, AnyExtinctionIsFiniteAndOpaque) {
  const Volume volume = noise({9, 9, 9}, glm::dmat4(1.0));
  for (const double scale : {1e-30, 1e3, 1e9, 1e30}) {
    const RaySum sum = marchRay(
        ReferenceField(volume, physical(scale, {0.5f, 1.0f, 0.0f})),
        rayOf(volume, glm::dvec3(4.1, 4.3, 4.2) - 20.0 * glm::dvec3(1.0, 0.8, 0.9), {1.0, 0.8, 0.9}), kStep);
    EXPECT_NEAR(sum.opacity, scale < 1.0 ? 0.0 : 1.0, 1e-7);
    EXPECT_NEAR(sum.color.r, 0.5 * sum.opacity, 1e-12);
    EXPECT_NEAR(sum.color.g, sum.opacity, 1e-12);
  }
}

TEST(RayMarch, AgreesWithTinySteps) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const ClassificationOrder order : {ClassificationOrder::Pre, ClassificationOrder::Post}) {
    const Volume volume = noise({12, 9, 17}, sheared());
    Classification classification = colored(order == ClassificationOrder::Pre ? 0.9 : 0.6);
    classification.order = order;
    const double tolerance = order == ClassificationOrder::Pre ? 3e-6 : 2e-4;  // a sixteenth of a voxel has one colour
    const ReferenceField field(volume, classification);
    for (int i = 0; i < 16; ++i) {
      const glm::dvec3 target = glm::dvec3(volume.dimensions) * (0.5 + 0.4 * uniform(random));
      const glm::dvec3 direction =
          glm::normalize(glm::dvec3(uniform(random), uniform(random), uniform(random)));
      const double back = i % 4 == 0 ? 2.0 : 30.0;  // some begin inside
      const MarchedRay ray = rayOf(volume, target - back * direction, direction);
      const RaySum sum = marchRay(field, ray, kStep);
      const RaySum expected = tinySteps(volume, classification, ray, back + 30.0, 40000);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(sum.color[c], expected.color[c], tolerance) << "ray " << i;
      ASSERT_NEAR(sum.opacity, expected.opacity, tolerance) << "ray " << i;
      ASSERT_NEAR(sum.distance, expected.distance, 30.0 * tolerance) << "ray " << i;
    }
  }
}

TEST(RayMarch, HalvingTheStepChangesNothingThatMatters) {
  const Volume volume = noise({12, 9, 17}, glm::dmat4(1.0));
  double largest = 0.0;
  for (const double opacity : {0.1, 0.9, 0.9997}) {
    const ReferenceField field(volume, colored(opacity));
    for (int i = 0; i < 100; ++i) {
      const glm::dvec3 direction = glm::normalize(glm::dvec3(1.0, 0.02 * i - 1.0, 0.3));
      const MarchedRay ray = rayOf(volume, glm::dvec3(6.1, 4.2, 0.15 * i) - 30.0 * direction, direction);
      const RaySum whole = marchRay(field, ray, kStep), half = marchRay(field, ray, kStep / 2.0);
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(whole.color[c] - half.color[c]));
      EXPECT_NEAR(whole.opacity, half.opacity, 1e-6);
    }
  }
  std::printf("halving the step changes %.1e\n", largest);
  EXPECT_LT(largest, 1e-5);
}

/// Every pixel, against 1 - exp(-sigma * n * length of a layer along its rays).
TEST(Oracle, ASlabIsBeerLambertInPerspectiveAndOrthographic) {
  const Volume volume = block({90, 90, 4}, sheared());
  const double sigma = 0.3;
  const glm::ivec2 size(12, 8);
  const glm::dmat3 linear(volume.indexToWorld);
  for (const bool orthographic : {false, true}) {
    Camera camera = framingCamera(volume, 20.0, 10.0, 1.5, {});
    camera.orthographic = orthographic;
    camera.orthographicHeight = 8.0;
    camera.verticalFov = 12.0;
    camera.position = camera.lookAt + 40.0 * glm::normalize(camera.position - camera.lookAt);
    const Oracle oracle = renderOracle(volume, physical(sigma), camera, {.size = size});
    EXPECT_TRUE(oracle.converged);
    const PixelRays rays = pixelRays(camera, size, volume.indexToWorld);
    double lowest = 1.0, highest = 0.0;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        double expected = 0.0;
        for (int sample = 0; sample < 64; ++sample) {
          const double px = x + (sample % 8 + 0.5) / 8.0, py = y + (sample / 8 + 0.5) / 8.0;
          const glm::dvec3 d = rays.direction + px * rays.directionX + py * rays.directionY;
          expected += -std::expm1(-sigma * 4.0 * glm::length(linear * d) / std::abs(d.z)) / 64.0;
        }
        const glm::vec4 pixel = oracle.image.pixels[std::size_t(y * size.x + x)];
        EXPECT_NEAR(pixel.a, expected, 1e-5);
        EXPECT_NEAR(pixel.g, expected, 1e-5);
        lowest = std::min(lowest, expected);
        highest = std::max(highest, expected);
      }
    EXPECT_EQ(highest - lowest > 1e-3, !orthographic) << "perspective is what makes the pixels differ";
  }
}

TEST(Oracle, DepthIsTheMeanDistanceAlongTheViewingAxis) {
  const Volume volume = block({30, 30, 40});
  const Oracle oracle =
      renderOracle(volume, physical(2.0), lookingDown(14.5, 14.5, 60.0), {.size = {24, 24}, .depth = true});
  ASSERT_EQ(oracle.image.depth.size(), oracle.image.pixels.size());
  // The eye is inside, at z = 20: an endless medium ahead.
  EXPECT_NEAR(oracle.image.depth[12 * 24 + 12], 0.5, 1e-5);
  EXPECT_EQ(oracle.image.depth[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(oracle.image.pixels[0], glm::vec4(0.0f));

  Camera camera;  // the distance along the axis, not along the ray
  camera.position = {15.0, 15.0, 139.0};
  camera.lookAt = {15.0, 15.0, 0.0};
  camera.verticalFov = 12.0;
  const Image wide = renderOracle(volume, physical(1e6), camera, {.size = {9, 9}, .depth = true}).image;
  EXPECT_NEAR(wide.depth[4 * 9 + 4], 99.0, 0.05);  // the skirt's outer end is at z = 40
  EXPECT_NEAR(wide.depth[2 * 9 + 2], 99.0, 0.05);
}

TEST(Oracle, EmptyVolumeIsTransparentAndInfinitelyFar) {
  const Volume volume = makeVolume({4, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return 0.0; });
  const Oracle oracle =
      renderOracle(volume, physical(1.0), lookingDown(0, 0, 4), {.size = {8, 8}, .depth = true});
  EXPECT_TRUE(oracle.converged);
  EXPECT_EQ(oracle.largestChange, 0.0);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(oracle.image.pixels[i], glm::vec4(0.0f));
    EXPECT_EQ(oracle.image.depth[i], std::numeric_limits<float>::infinity());
  }
}

/// However few pixels it covers: an orthographic image's alpha integrates to the volume of thin matter.
TEST(Oracle, VoxelsSmallerThanAPixelAreNotLost) {
  const Volume volume = block({1, 1, 1});
  const double sigma = 1e-3;
  for (const double pixel : {0.7, 3.0, 10.0}) {
    const Oracle oracle = renderOracle(volume, physical(sigma), lookingDown(0.2, 0.1, 9.0 * pixel),
                                       {.size = {9, 9}, .tolerance = 1e-7});
    double sum = 0.0;
    for (const glm::vec4 p : oracle.image.pixels) sum += p.a * pixel * pixel;
    EXPECT_NEAR(sum, sigma, 0.01 * sigma) << pixel;
  }
}

TEST(Oracle, ConvergesToItsToleranceOrSaysThatItDidNot) {
  const Volume volume = noise({12, 9, 17}, sheared());
  const Camera camera = framingCamera(volume, 35, 25, 1.5, Camera{});
  const auto render = [&](double tolerance, int samples) {
    return renderOracle(volume, colored(), camera, {.size = {24, 16}, .tolerance = tolerance, .maximumSamples = samples});
  };
  const Oracle standard = render(1e-3, 32), best = render(0.0, 64), coarse = render(1e-3, 4);
  EXPECT_TRUE(standard.converged);
  EXPECT_LT(standard.largestChange, 1e-3);
  EXPECT_LT(largestPixelDifference(standard.image, best.image), 1e-3);
  EXPECT_EQ(best.samples, 64);
  EXPECT_FALSE(best.converged);
  EXPECT_EQ(coarse.samples, 4);
  EXPECT_FALSE(coarse.converged);
  EXPECT_GE(coarse.largestChange, 1e-3);
  EXPECT_EQ(coarse.rays, 384u * (4 + 16));
}

TEST(Oracle, IsTheSameOnAnyNumberOfCores) {
  const Volume volume = noise({12, 9, 17}, sheared());
  const Camera camera = framingCamera(volume, -60, 10, 1.0, Camera{});
  const OracleSettings settings{.size = {40, 40}, .depth = true};
  std::vector<double> fractions;
  const Oracle many = renderOracle(volume, colored(), camera, settings,
                                   [&](std::string_view, double fraction) { fractions.push_back(fraction); });
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Oracle few = renderOracle(volume, colored(), camera, settings);
  EXPECT_EQ(many.image.pixels, few.image.pixels);
  EXPECT_EQ(many.image.depth, few.image.depth);
  EXPECT_GT(many.image.pixels[20 * 40 + 20].a, 0.5f);
  EXPECT_FALSE(fractions.empty());
  for (const double fraction : fractions) EXPECT_TRUE(fraction >= 0.0 && fraction <= 1.0);
}

/// Two independent ways to the same image.
TEST(Oracle, SplatsOfASmoothVolumeComeClose) {
  Volume volume = makeProcedural("cloud", 48);
  cropToActive(volume);
  const Classification classification = physical(automaticDensityScale(volume, 2.0), glm::vec3(0.9f));
  const Scene scene(volume, classification);
  FrameSettings frame = frameOf({120, 120});
  frame.depth = true;
  for (const double azimuth : {0.0, 35.0, 200.0}) {
    const Camera camera = framingCamera(volume, azimuth, 25, 1.0, Camera{});
    const Oracle oracle = renderOracle(volume, classification, camera, {.size = frame.size, .depth = true});
    const Image splats = referenceResolve(scene.sums(camera, frame), frame);
    const double decibels = psnr(oracle.image, splats);
    std::printf("cloud 48³, azimuth %g: splats are %.1f dB from the oracle\n", azimuth, decibels);
    EXPECT_GT(decibels, 35.0);
    double error = 0.0, weight = 0.0;
    for (std::size_t i = 0; i < splats.pixels.size(); ++i) {
      const float alpha = std::min(oracle.image.pixels[i].a, splats.pixels[i].a);
      if (!(alpha > 0.05f)) continue;
      error += alpha * std::abs(oracle.image.depth[i] - splats.depth[i]);
      weight += alpha;
    }
    EXPECT_LT(error / weight, 0.03) << "of the unit cube";
  }
}

}  // namespace
}  // namespace freevoxels
