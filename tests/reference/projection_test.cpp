// Projections of values and isosurfaces: closed forms of the reference, and of the functions that they are drawn by.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/description/scene_description.h"
#include "engine/image/srgb.h"
#include "engine/reference/oracle.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/volume/scan.h"
#include "engine/volume/transfer_curves.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

using test::expectRefusal;

constexpr glm::ivec3 kSize{5, 4, 7};

double valueAt(glm::ivec3 voxel) {
  return 0.1 * voxel.x + 0.03 * voxel.y + std::abs(std::sin(2.0 * voxel.z + voxel.x));
}

Volume waves() {
  return makeVolume(kSize, cubeTransform(kSize), [](int x, int y, int z) { return valueAt({x, y, z}); });
}

/// Opacity 0 at 0 and 1 at 2, red at 0 and blue at 2.
TransferFunction ramp() {
  return {.opacity = {{0.0f, 0.0f}, {2.0f, 1.0f}}, .color = {{0.0f, {1, 0, 0}}, {2.0f, {0, 0, 1}}}, .unitDistance = 0.37};
}

/// The image of one pixel, which looks along -z at a column of voxels.
Image columnOf(const Volume& volume, const Classification& classification, glm::ivec2 column, IntensityProjection projection) {
  const glm::dvec3 at(volume.indexToWorld * glm::dvec4(column, 0.0, 1.0));
  const Camera camera{.position = {at.x, at.y, 3.0}, .lookAt = {at.x, at.y, 0.0}, .orthographic = true, .orthographicHeight = 1e-6};
  return renderOracle(volume, classification, camera, {.size = {1, 1}, .depth = true, .projection = projection}).image;
}

TEST(Projection, OfAColumnOfVoxelsIsTheirLargestValueOrTheirMean) {
  const Volume volume = waves();
  const Classification classification{.transferFunction = ramp()};
  for (const glm::ivec2 column : {glm::ivec2(0, 0), {2, 3}, {4, 1}}) {
    double largest = 0.0, sum = 0.0;
    int at = 0;
    for (int z = 0; z < kSize.z; ++z) {
      const double value = valueAt({column, z});
      if (value > largest) at = z;
      largest = std::max(largest, value);
      sum += value;
    }
    const Image maximum = columnOf(volume, classification, column, IntensityProjection::Maximum);
    const Image average = columnOf(volume, classification, column, IntensityProjection::Average);
    EXPECT_NEAR(maximum.pixels[0].a, largest / 2.0, 0.03 * largest) << "sixteen steps a voxel come close to its middle";
    EXPECT_NEAR(average.pixels[0].a, sum / kSize.z / 2.0, 2e-3);
    EXPECT_NEAR(average.pixels[0].b, std::pow(average.pixels[0].a, 2.0f), 1e-5) << "opacity and colour are those of one value";
    EXPECT_NEAR(maximum.depth[0], 3.0 - (volume.indexToWorld * glm::dvec4(column, at, 1)).z, 0.5 * volume.voxelSize());
  }
}

TEST(Projection, WithoutAFunctionShowsValuesEvenlyGradedOverBlack) {
  Volume fog = waves();
  fog.isFog = true;
  const TransferFunction function = intensityFunction(fog, IntensityProjection::Maximum);
  const Classification classification{.transferFunction = function};
  for (const double part : {0.1, 0.37, 0.5, 0.9}) {
    const double opacity = -std::expm1(-classify(classification, float(part * fog.maximum)).extinction * function.unitDistance);
    EXPECT_NEAR(srgbFromLinear(float(opacity)), part, 0.004) << "of the largest value";
  }
  const Volume scan = makeVolume({20, 20, 20}, cubeTransform({20, 20, 20}), [](int x, int y, int z) {
    const double radius = glm::length(glm::dvec3(x, y, z) - 9.5);
    return (radius < 4.0 ? 1200.0 : radius < 8.0 ? 40.0 : -1000.0) + 0.5 * ((3 * x + 5 * y + 7 * z) % 11);
  });
  const TransferFunction ofScan = intensityFunction(scan, IntensityProjection::Maximum);
  EXPECT_GT(ofScan.opacity.front().scalar, -1000.0f) << "the air around is transparent";
  EXPECT_LT(ofScan.opacity.front().scalar, 40.0f);
  EXPECT_NEAR(ofScan.opacity.back().scalar, 1205.0f, 10.0f);
  const TransferFunction ofMeans = intensityFunction(scan, IntensityProjection::Average);
  EXPECT_EQ(ofMeans.opacity.front().scalar, scan.minimum);
  EXPECT_NEAR(ofMeans.opacity.back().scalar, 190.0f, 60.0f) << "of the ball of 8 voxels, an eighth of which is at 1200";
}

TEST(Projection, KeepsValuesThatItsFunctionHidesForAMean) {
  const Volume volume = waves();
  ClassificationDescription description{.transferFunction = R"({"range": [0.5, 0.6], "opacity": [[0, 0], [1, 1]]})"};
  const Classification maximum = description.resolveProjected(volume, IntensityProjection::Maximum);
  const Classification average = description.resolveProjected(volume, IntensityProjection::Average);
  EXPECT_EQ(classify(maximum, 0.2f).extinction, 0.0);
  EXPECT_GT(classify(average, 0.2f).extinction, 0.0);
  EXPECT_EQ(average.transferFunction->opacity.front().scalar, volume.minimum);
  EXPECT_EQ(average.transferFunction->opacity.back().scalar, volume.maximum);
  EXPECT_NEAR(classify(average, 0.55f).extinction, classify(maximum, 0.55f).extinction, 1e-4);
}

TEST(Projection, MakesTheMostOpaqueValueOpaque) {
  const Volume volume = waves();
  const ClassificationDescription map{.transferFunction = "viridis"};
  const TransferFunction drawn = *map.resolve(volume, false).transferFunction;
  const TransferFunction shown = *map.resolveProjected(volume, IntensityProjection::Maximum).transferFunction;
  EXPECT_LT(drawn.opacity.back().opacity, 0.5f);
  EXPECT_EQ(shown.opacity.back().opacity, 1.0f);
  EXPECT_EQ(shown.color.back().color, drawn.color.back().color);
}

TEST(Projection, RefusesWhatHasNoPartInIt) {
  const Volume volume = waves();
  const auto refused = [&](const ClassificationDescription& given, const char* name) {
    expectRefusal([&] { given.resolveProjected(volume, IntensityProjection::Maximum); }, ErrorKind::Usage, {"mode", name});
  };
  refused({.iso = IsoSurface{0.5}}, "iso");
  refused({.labels = Labels()}, "labels");
  refused({.channels = {ChannelStyle()}}, "channel");
  SceneDescription scene{.input = {.volume = "procedural:cloud"}, .method = {.mode = IntensityProjection::Maximum}};
  scene.check();
  scene.added.push_back({.input = {.volume = "procedural:head"}});
  expectRefusal([&] { scene.check(); }, ErrorKind::Usage, {"mode", "add"});
  FrameSettings frame;
  expectRefusal([&] { MethodDescription{.mode = IntensityProjection::Average, .paper = true}.apply(frame); }, ErrorKind::Usage, {"mode", "paper"});
  expectRefusal([&] { MethodDescription{.mode = IntensityProjection::Average, .lod = 1.0}.apply(frame); }, ErrorKind::Usage, {"mode", "lod"});
}

TEST(IsoSurface, IsOpaqueFromItsValueOn) {
  const Volume volume = waves();
  const TransferFunction function = isoFunction({.value = 0.5, .color = {0.2, 0.4, 0.6}}, volume);
  const Classification classification{.transferFunction = function};
  EXPECT_EQ(classify(classification, std::nextafter(0.5f, 0.0f)).extinction, 0.0);
  const ClassifiedVoxel inside = classify(classification, 0.5f);
  EXPECT_GT(-std::expm1(-0.01 * volume.voxelSize() * inside.extinction), 0.99) << "a hundredth of a voxel";
  EXPECT_EQ(glm::vec3(inside.color), glm::vec3(0.2f, 0.4f, 0.6f));
  const Classification again{.transferFunction = fitted(parseTransferCurves("inline", transferFunctionJson(function)), volume)};
  EXPECT_EQ(classify(again, 0.5f).extinction, inside.extinction) << "as a scene saves it";
  EXPECT_EQ(classify(again, 0.4999f).extinction, 0.0);
}

}  // namespace
}  // namespace freevoxels
