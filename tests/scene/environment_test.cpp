// Environments on the directions of a table: constants, single pixels, turned, and all of the light.

#include "engine/scene/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/image/image.h"
#include "engine/scene/lighting.h"
#include "engine/validation/sky_environment.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

constexpr DirectionSet kSets[] = {DirectionSet::Directions26, DirectionSet::Directions98};

glm::dmat4 stretched() {
  glm::dmat4 transform(1.0);
  transform[2][2] = 3.0;
  transform[1][0] = 0.4;
  return transform;
}

Environment dark(int height) {
  return {.size = {2 * height, height},
          .radiance = std::vector<glm::vec3>(std::size_t(2 * height * height), glm::vec3(0.0f))};
}

std::vector<glm::dvec3> lightOf(const Environment& environment, DirectionSet set,
                                const glm::dmat4& transform = glm::dmat4(1.0)) {
  std::vector<glm::dvec3> light = directionRadiances(environment, set, transform);
  const std::vector<double> shares = directionShares(set, transform);
  for (std::size_t d = 0; d < light.size(); ++d) light[d] *= shares[d];
  return light;
}

/// The direction that has most of the light.
glm::ivec3 brightest(const std::vector<glm::dvec3>& light, DirectionSet set) {
  std::size_t most = 0;
  for (std::size_t d = 0; d < light.size(); ++d)
    if (light[d].g > light[most].g) most = d;
  return directionCell(set, int(most));
}

glm::dvec3 sum(const std::vector<glm::dvec3>& light) {
  return std::accumulate(light.begin(), light.end(), glm::dvec3(0.0));
}

TEST(Environment, AConstantOneIsAmbientLight) {
  const glm::dvec3 radiance(0.25, 1.5, 3.0);
  for (const int height : {1, 7, 600}) {
    Environment constant = dark(height);
    for (glm::vec3& pixel : constant.radiance) pixel = glm::vec3(0.5 * radiance);
    constant.intensity = 2.0;
    for (const DirectionSet set : kSets)
      for (const glm::dmat4& transform : {glm::dmat4(1.0), stretched()}) {
        const auto around = lightOf(constant, set, transform);
        const std::vector<double> shares = directionShares(set, transform);
        for (std::size_t d = 0; d < around.size(); ++d)
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(around[d][c], shares[d] * radiance[c], 1e-12);
      }
  }
}

/// Where OpenEXR's lat-long maps have the axes.
TEST(Environment, PixelsAreWhereOpenExrHasThem) {
  constexpr int kRows = 64;
  const auto where = [](int column, int row, DirectionSet set) {
    Environment environment = dark(kRows);
    environment.radiance[std::size_t(column + 2 * kRows * row)] = glm::vec3(1.0f);
    return brightest(lightOf(environment, set), set) / int(set);
  };
  for (const DirectionSet set : kSets) {
    EXPECT_EQ(where(5, 0, set), glm::ivec3(0, 1, 0));
    EXPECT_EQ(where(90, kRows - 1, set), glm::ivec3(0, -1, 0));
    EXPECT_EQ(where(kRows, kRows / 2, set), glm::ivec3(0, 0, 1));
    EXPECT_EQ(where(kRows / 2, kRows / 2, set), glm::ivec3(1, 0, 0));
    EXPECT_EQ(where(3 * kRows / 2, kRows / 2, set), glm::ivec3(-1, 0, 0));
    EXPECT_EQ(where(0, kRows / 2, set), glm::ivec3(0, 0, -1));
    EXPECT_EQ(where(kRows / 4, kRows / 2, set), glm::ivec3(1, 0, -1));
    EXPECT_EQ(where(3 * kRows / 4, 19, set), glm::ivec3(1, 1, 1));  // asin(1/sqrt 3) above the horizon
  }
}

TEST(Environment, ABrightPixelEndsInTheDirectionsAroundItWithAllOfItsLight) {
  constexpr int kRows = 32, kRow = 11, kColumn = 21;
  Environment environment = dark(kRows);
  environment.radiance[kColumn + 2 * kRows * kRow] = glm::vec3(1.0f, 10.0f, 100.0f);
  const double polar = std::numbers::pi * (kRow + 0.5) / kRows,
               azimuth = std::numbers::pi * (1.0 - (kColumn + 0.5) / kRows);
  const glm::dvec3 direction(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                             std::sin(polar) * std::cos(azimuth));
  const double solidAngle =
      std::numbers::pi / kRows *
      (std::cos(std::numbers::pi * kRow / kRows) - std::cos(std::numbers::pi * (kRow + 1) / kRows));
  for (const DirectionSet set : kSets)
    for (const glm::dmat4& transform : {glm::dmat4(1.0), stretched()}) {
      const auto light = lightOf(environment, set, transform);
      const glm::dvec3 inIndexSpace = glm::inverse(glm::dmat3(transform)) * direction;
      const DirectionBlend around = bilinearDirections(set, inIndexSpace);
      EXPECT_EQ(brightest(light, set), directionCell(set, nearestDirection(set, inIndexSpace)));
      double inFour = 0.0;
      for (std::size_t k = 0; k < 4; ++k) inFour += light[std::size_t(around.directions[k])].g;
      EXPECT_GT(inFour, 0.99 * sum(light).g);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum(light)[c] / (std::pow(10.0, c) * solidAngle / (4.0 * std::numbers::pi)), 1.0, 1e-3);
    }
}

TEST(Environment, RotationTurnsItAboutTheYAxis) {
  Environment sky = makeSky(64);
  for (const DirectionSet set : kSets) {
    sky.rotation = 0.0;
    const auto before = lightOf(sky, set);
    sky.rotation = 90.0;
    const auto after = lightOf(sky, set);
    for (std::size_t d = 0; d < before.size(); ++d) {
      const glm::ivec3 from = directionCell(set, int(d)), to(from.z, from.y, -from.x);  // +z goes to +x
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(after[std::size_t(directionIndex(set, to))][c], before[d][c], 1e-9);
    }
    sky.rotation = 360.0 - kSkySunAzimuth;  // the sun to azimuth 0
    const glm::ivec3 sun = brightest(lightOf(sky, set), set);
    EXPECT_EQ(sun.x, 0);
    EXPECT_GT(sun.z, 0);
  }
}

TEST(Environment, NoLightIsLost) {
  const Environment sky = makeSky(128);
  glm::dvec3 mean(0.0);
  double whole = 0.0;
  for (int row = 0; row < environmentRows(sky); ++row)
    for (const EnvironmentPart& part : environmentRow(sky, row)) {
      mean += part.solidAngle / (4.0 * std::numbers::pi) * part.radiance;
      whole += part.solidAngle;
    }
  EXPECT_NEAR(whole, 4.0 * std::numbers::pi, 1e-9);
  for (const DirectionSet set : kSets)
    for (const glm::dmat4& transform : {glm::dmat4(1.0), stretched()})
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum(lightOf(sky, set, transform))[c] / mean[c], 1.0, 1e-4);
}

TEST(Environment, FilesComeBackAndBadOnesAreRefused) {
  const test::TemporaryFolder folder;
  const auto write = [&](glm::ivec2 size, glm::vec4 first) {
    Image image{.size = size, .pixels = {}, .depth = {}};
    image.pixels.resize(std::size_t(size.x * size.y), glm::vec4(0.5f, 1.0f, 2.0f, 1.0f));
    image.pixels[1] = first;
    writeExr(folder / "sky.exr", image, {.fullFloat = true, .metadata = {}, .matrices = {}});
  };
  const auto read = [&] { readEnvironment(folder / "sky.exr"); };
  write({4, 2}, {7.0f, 0.0f, 3.0f, 1.0f});
  const Environment environment = readEnvironment(folder / "sky.exr");
  EXPECT_EQ(environment.size, glm::ivec2(4, 2));
  EXPECT_EQ(environment.radiance[1], glm::vec3(7.0f, 0.0f, 3.0f));
  EXPECT_EQ(environment.radiance[7], glm::vec3(0.5f, 1.0f, 2.0f));
  write({4, 4}, {1.0f, 1.0f, 1.0f, 1.0f});
  test::expectRefusal(read, ErrorKind::Input, {"sky.exr", "4x4", "twice as wide as high"});
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
    write({4, 2}, {1.0f, bad, 1.0f, 1.0f});
    test::expectRefusal(read, ErrorKind::Input, {"sky.exr", "column 1 of row 0"});
  }
  write({4, 2}, {1.0f, -6e-8f, -1.0f, 1.0f});
  const Environment clamped = readEnvironment(folder / "sky.exr");
  EXPECT_EQ(clamped.radiance[1], glm::vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(clamped.negativeValues, 2u);
}

}  // namespace
}  // namespace freevoxels
