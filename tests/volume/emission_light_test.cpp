#include "engine/volume/emission_light.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "engine/volume/procedural.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {
namespace {

constexpr int kEdge = 48;
constexpr double kVoxel = 0.1;  // world units

/// Thin fog all over, of optical depth 0.02 a voxel, and in the middle a hot cube of `hot` voxels along an edge.
Volume lamp(int hot) {
  Volume volume = makeVolume(glm::ivec3(kEdge), glm::scale(glm::dmat4(1.0), glm::dvec3(kVoxel)), [](int, int, int) { return 1.0f; });
  const int first = (kEdge - hot) / 2;
  TemperatureGrid& heat = volume.temperature.emplace();
  heat.values = ScalarBricks(glm::ivec3(kEdge));
  for (int z = first; z < first + hot; ++z)
    for (int y = first; y < first + hot; ++y)
      for (int x = first; x < first + hot; ++x) heat.values.set({x, y, z}, 2000.0f);
  heat.minimum = heat.maximum = 2000.0f;
  heat.activeVoxels = std::uint64_t(hot) * hot * hot;
  return volume;
}

Classification fog() {
  Classification classification{.densityScale = 0.02 / kVoxel, .albedo = glm::vec3(0.5f)};
  classification.emission = Emission{.strength = 10.0};
  return classification;
}

TEST(EmissionLight, OfASmallLampFallsWithTheSquareOfTheDistanceThroughTheFog) {
  const Volume volume = lamp(2);
  const Classification classification = fog();
  const EmissionLight light(volume, classification);
  const double emitted = emittedLight(*classification.emission, 2000.0f).g, middle = 0.5 * (kEdge - 1);
  for (const double voxels : {6.0, 10.0, 20.0}) {
    const double distance = voxels * kVoxel;
    const double power = emitted * 8.0 * kVoxel * kVoxel * kVoxel;
    const double expected =
        power * std::exp(-0.02 * voxels) / (4.0 * std::numbers::pi * distance * distance);
    EXPECT_NEAR(light.at(kVoxel * glm::dvec3(middle + voxels, middle, middle)).g, expected, 0.05 * expected) << voxels;
    EXPECT_NEAR(light.at(kVoxel * (middle + voxels * std::sqrt(1.0 / 3.0))  * glm::dvec3(1.0)).g, expected, 0.05 * expected) << voxels;
  }
}

/// The sum over all voxels of the lamp; it is many sources.
TEST(EmissionLight, OfALargeLampIsTheSumOverItsVoxels) {
  const Volume volume = lamp(16);
  const Classification classification = fog();
  const EmissionLight light(volume, classification);
  const double emitted = emittedLight(*classification.emission, 2000.0f).g;
  for (const glm::dvec3 place : {glm::dvec3(40, 23, 23), glm::dvec3(38, 36, 20), glm::dvec3(10, 8, 23)}) {
    double expected = 0.0;
    for (int z = 16; z < 32; ++z)
      for (int y = 16; y < 32; ++y)
        for (int x = 16; x < 32; ++x) {
          const double voxels = glm::length(glm::dvec3(x, y, z) - place);
          expected += emitted * kVoxel * std::exp(-0.02 * voxels) / (4.0 * std::numbers::pi * voxels * voxels);
        }
    EXPECT_NEAR(light.at(kVoxel * place).g, expected, 0.05 * expected);
  }
}

TEST(EmissionLight, IsScatteredByTheAlbedo) {
  const Volume volume = lamp(2);
  Classification classification = fog();
  classification.emissionLight = std::make_shared<const EmissionLight>(volume, classification);
  const glm::ivec3 voxel(40, 24, 24);
  const ClassifiedVoxel found = VoxelClassifier(classification, volume).at(voxel);
  const glm::dvec3 expected = 0.2 * 0.5 * classification.emissionLight->at(kVoxel * glm::dvec3(voxel));
  EXPECT_NEAR(found.emission.r, expected.r, 1e-9);
  EXPECT_GT(expected.r, expected.b) << "a flame is red";
}

TEST(EmissionLight, OfNothingHotIsDark) {
  Volume volume = lamp(2);
  const Classification cold{.densityScale = 1.0};
  EXPECT_EQ(EmissionLight(volume, cold).brightest(), 0.0);
  EXPECT_EQ(EmissionLight(volume, cold).at(glm::dvec3(1.0)), glm::dvec3(0.0));
}

}  // namespace
}  // namespace freevoxels
