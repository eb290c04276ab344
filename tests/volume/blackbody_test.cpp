// Blackbody colours against published tables, and what temperatures become.

#include "engine/volume/blackbody.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "engine/volume/classification.h"
#include "engine/volume/packed_light.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

constexpr glm::dvec3 kLuminance(0.2126729, 0.7151522, 0.0721750);

/// Wyszecki and Stiles 1982, "Color Science", Table 1(3.11) and CIE 015: the Planckian locus.
TEST(Blackbody, ChromaticitiesAreThoseOfThePlanckianLocus) {
  struct Entry {
    double kelvin, x, y;
  };
  for (const Entry& entry : std::array<Entry, 5>{{{1000.0, 0.6528, 0.3444},
                                                  {2000.0, 0.5267, 0.4133},
                                                  {3000.0, 0.4369, 0.4041},
                                                  {6500.0, 0.3135, 0.3237},
                                                  {10000.0, 0.2807, 0.2884}}}) {
    const glm::dvec3 xyz = blackbodyXyz(entry.kelvin);
    const double sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.x / sum, entry.x, 5e-4) << entry.kelvin;
    EXPECT_NEAR(xyz.y / sum, entry.y, 5e-4) << entry.kelvin;
  }
}

/// Around 2000 K luminance goes as Wien's law has it at an effective wavelength of about 580 nm.
TEST(Blackbody, LuminancesAreRelativeToTheReference) {
  EXPECT_DOUBLE_EQ(blackbodyXyz(kReferenceTemperature).y, 1.0);
  const double slope =
      std::log(blackbodyXyz(2100.0).y / blackbodyXyz(1900.0).y) / (1.0 / 1900.0 - 1.0 / 2100.0);
  EXPECT_NEAR(1.438776877e7 / slope, 580.0, 10.0);
}

TEST(Blackbody, ColoursHaveTheLuminanceAndNoNegativeParts) {
  for (double kelvin = kColdestLight; kelvin < 39000.0; kelvin *= 1.013) {
    const glm::dvec3 color = blackbodyColor(kelvin);
    EXPECT_NEAR(glm::dot(color, kLuminance) / blackbodyXyz(kelvin).y, 1.0, 2e-4) << kelvin;
    EXPECT_GE(std::min({color.r, color.g, color.b}), 0.0);
  }
  // Daylight at 6500 K is nearly white; embers are almost purely red.
  const glm::dvec3 white = blackbodyColor(6500.0) / blackbodyXyz(6500.0).y;
  EXPECT_NEAR(white.r, 1.0, 0.06);
  EXPECT_NEAR(white.g, 1.0, 0.06);
  EXPECT_NEAR(white.b, 1.0, 0.06);
  EXPECT_EQ(blackbodyColor(1000.0).b, 0.0);
  EXPECT_EQ(blackbodyColor(kColdestLight - 1.0), glm::dvec3(0.0));
  EXPECT_EQ(blackbodyColor(1e9), blackbodyColor(kHottestLight));
}

TEST(Emission, TemperaturesAreKelvinByScaleAndOffset) {
  const Emission emission{.strength = 3.0, .temperatureScale = 100.0, .temperatureOffset = 273.0};
  EXPECT_EQ(emittedLight(emission, 12.0f), 3.0 * blackbodyColor(1473.0));
  EXPECT_EQ(emittedLight(emission, kInactiveVoxel), glm::dvec3(0.0));
  EXPECT_EQ(emittedLight(emission, -50.0f), glm::dvec3(0.0));
}

TEST(Emission, OnlyTemperaturesThatAreNoKelvinAreScaled) {
  TemperatureGrid grid;
  grid.maximum = 0.8f;
  EXPECT_EQ(automaticTemperatureOffset(grid), 1000.0);
  EXPECT_NEAR(automaticTemperatureScale(grid, 1000.0) * 0.8, 1000.0, 1e-3);
  EXPECT_NEAR(automaticTemperatureScale(grid, 300.0) * 0.8 + 300.0, 2000.0, 1e-3);
  grid.maximum = 1500.0f;
  EXPECT_EQ(automaticTemperatureOffset(grid), 0.0);
  EXPECT_EQ(automaticTemperatureScale(grid, 0.0), 1.0);
}

/// A cube of one temperature has the radiance, whatever cold voxels are around it, however fine and deep it
/// is.
TEST(Emission, TheAutomaticStrengthMakesACubeAsBrightAsItShouldBe) {
  for (const int edge : {6, 12})
    for (const double sigma : {0.0, 3.0}) {
      Volume volume =
          makeVolume(glm::ivec3(2 * edge), glm::dmat4(1.0 / edge), [](int, int, int) { return 1.0; });
      volume.temperature = TemperatureGrid{
          .name = "t", .values = ScalarBricks::make(volume.dimensions, [&](glm::ivec3 v) {
                         return glm::all(glm::lessThan(v, glm::ivec3(edge))) ? 1800.0f : 700.0f;
                       })};
      summariseValues(*volume.temperature);
      Emission emission;
      emission.strength = automaticEmissionStrength(volume, {.densityScale = sigma}, emission);
      const double leaving = sigma > 0.0 ? -std::expm1(-sigma) / sigma : 1.0;
      EXPECT_NEAR(glm::dot(emittedLight(emission, 1800.0f), kLuminance) * leaving, kAutomaticRadiance, 1e-3);
    }
}

TEST(Emission, PackedLightKeepsNineBits) {
  for (double light = kBrightest; light > kFaintest; light *= 0.83) {
    const glm::dvec3 given(light, 0.4 * light, 0.01 * light);
    EXPECT_LE(glm::length(unpackColor(packLight(given)) - given), light / 290.0);
  }
  EXPECT_EQ(packLight(glm::dvec3(0.9 * kFaintest)), 0u);
  EXPECT_EQ(unpackColor(packColor(glm::dvec3(1.0, 0.5, 0.25))), glm::dvec3(1.0, 0.5, 0.25));
}

TEST(PackedLight, BitsAreThoseOfTheSharedExponentFormat) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> part(0.0f, 1.0f), power(-26.0f, 15.0f);
  for (int i = 0; i < 100000; ++i) {
    const float scale = i == 0 ? 0.0f : std::exp2(power(generator));
    const glm::vec3 color = scale * glm::vec3(part(generator), part(generator), i % 7 == 0 ? 1.0f : part(generator));
    ASSERT_EQ(packColor(color), glm::packF3x9_E1x5(color)) << color.r << ' ' << color.g << ' ' << color.b;
  }
}

}  // namespace
}  // namespace freevoxels
