// Light that voxels send out: the oracle and the reference for splat sums against closed forms and each
// other.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/reference/oracle.h"
#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

constexpr int kEdge = 8;
constexpr float kKelvin = 1700.0f;  // without any blue

/// The unit cube, black and of one temperature.
Volume hotBox() {
  Volume volume =
      makeVolume(glm::ivec3(kEdge), cubeTransform(glm::ivec3(kEdge)), [](int, int, int) { return 1.0; });
  volume.temperature = TemperatureGrid{
      .name = "t", .values = ScalarBricks::make(volume.dimensions, [](glm::ivec3) { return kKelvin; })};
  summariseValues(*volume.temperature);
  return volume;
}

Classification hot(double depth) {
  return {.densityScale = depth, .albedo = glm::vec3(0.0f), .emission = Emission{.strength = 0.7}};
}

const Camera kCamera{.position = {0, 0, 3}, .orthographic = true, .orthographicHeight = 0.01};

glm::dvec3 sentOut() {
  return emittedLight({.strength = 0.7}, kKelvin);
}

/// j (1 - exp(-sigma L)) / sigma, and j L where there is no extinction.
glm::dvec3 closedForm(double depth) {
  return sentOut() * (depth > 0.0 ? -std::expm1(-depth) / depth : 1.0);
}

TEST(Emission, TheOracleOfASlabIsTheClosedForm) {
  for (const double depth : {0.0, 1e-6, 0.3, 2.0, 40.0, 1e6}) {
    const Image image = renderOracle(hotBox(), hot(depth), kCamera, {.size = {1, 1}}).image;
    for (int c = 0; c < 2; ++c)
      EXPECT_NEAR(double(image.pixels[0][c]) / closedForm(depth)[c], 1.0, depth < 100.0 ? 1e-3 : 0.2)
          << depth;
    EXPECT_NEAR(double(image.pixels[0].a), -std::expm1(-depth), 1e-6);
  }
}

TEST(Emission, TheSplatsOfASlabAreTheClosedForm) {
  const Volume volume = hotBox();
  for (const double depth : {0.0, 1e-6, 0.3, 2.0}) {
    const Classification classification = hot(depth);
    const auto extinction = referenceExtinction(volume, classification);
    const auto table = referenceTable(volume, extinction, {});
    const std::vector<glm::dvec3> emission(volume.voxelCount(), sentOut());
    const auto voxels = referenceVisibleVoxels(extinction, emission);
    ASSERT_EQ(voxels.size(), volume.voxelCount());
    for (const Composite composite : {Composite::Normalised, Composite::Additive}) {
      const FrameSettings settings{.size = {1, 1}, .method = SplatSettings{.composite = composite}};
      const auto sums = referenceSplatSums(
          volume, classification,
          {.extinction = extinction, .table = table, .tableSettings = {}, .emission = emission}, kCamera,
          settings, voxels);
      const glm::vec4 pixel = referenceResolve(sums, settings).pixels[0];
      for (int c = 0; c < 2; ++c) EXPECT_NEAR(double(pixel[c]) / closedForm(depth)[c], 1.0, 0.01) << depth;
    }
  }
}

/// A flame in front of black smoke is as bright as alone, one behind it as much darker as the smoke is deep.
TEST(Emission, SmokeHidesOnlyTheFlameBehindIt) {
  Volume volume =
      makeVolume({5, 5, 24}, glm::dmat4(1.0), [](int, int, int z) { return z >= 8 && z < 16 ? 1.0 : 0.0; });
  const auto seenFrom = [&](double side, bool isFront) {
    volume.temperature = TemperatureGrid{
        .name = "t", .values = ScalarBricks::make(volume.dimensions, [&](glm::ivec3 v) {
                       return (isFront ? v.z >= 18 && v.z < 22 : v.z >= 2 && v.z < 6) ? kKelvin
                                                                                      : kInactiveVoxel;
                     })};
    summariseValues(*volume.temperature);
    const Camera camera{.position = {2.0, 2.0, 12.0 + 40.0 * side},
                        .lookAt = {2.0, 2.0, 12.0},
                        .up = {0, 1, 0},
                        .orthographic = true,
                        .orthographicHeight = 0.1};
    return double(renderOracle(volume, hot(0.25), camera, {.size = {1, 1}}).image.pixels[0].r);
  };
  EXPECT_NEAR(seenFrom(1.0, true) / (4.0 * sentOut().r), 1.0, 1e-3);
  EXPECT_NEAR(seenFrom(1.0, false) / (4.0 * sentOut().r * std::exp(-2.0)), 1.0, 1e-3);
  EXPECT_NEAR(seenFrom(-1.0, true) / (4.0 * sentOut().r * std::exp(-2.0)), 1.0, 1e-3);
}

}  // namespace
}  // namespace freevoxels
