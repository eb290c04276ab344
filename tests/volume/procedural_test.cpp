#include "engine/volume/procedural.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/volume/procedural_fields.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

float valueAt(const Volume& volume, glm::dvec3 world) {
  const glm::dvec3 index = glm::inverse(volume.indexToWorld) * glm::dvec4(world, 1.0);
  const glm::ivec3 voxel = glm::ivec3(glm::round(index));
  const float value = volume.scalar(voxel.x, voxel.y, voxel.z);
  return value == kInactiveVoxel ? 0.0f : value;
}

/// ∫ density dV.
double mass(const Volume& volume) {
  double sum = 0.0;
  for (const float value : denseScalars(volume))
    if (value != kInactiveVoxel) sum += value;
  return sum * std::pow(volume.voxelSize(), 3);
}

TEST(Volume, CroppingKeepsEveryActiveVoxelInItsPlace) {
  Volume volume = makeVolume({9, 8, 7}, glm::dmat4(0.5), [](int x, int y, int z) {
    return x >= 2 && x <= 5 && y >= 1 && y <= 3 && z == 4 && (x + y) % 2 ? double(100 * x + 10 * y + z)
                                                                         : double(kInactiveVoxel);
  });
  volume.indexToWorld[3] = {3.0, 4.0, 5.0, 1.0};
  const Volume before = volume;
  cropToActive(volume);
  EXPECT_EQ(volume.dimensions, glm::ivec3(4, 3, 1));
  EXPECT_EQ(volume.indexOrigin, glm::ivec3(2, 1, 4));
  EXPECT_EQ(volume.activeVoxels, before.activeVoxels);
  EXPECT_EQ(volume.scalar(1, 1, 0), before.scalar(3, 2, 4));
  EXPECT_EQ(volume.indexToWorld * glm::dvec4(1, 1, 0, 1), before.indexToWorld * glm::dvec4(3, 2, 4, 1));
}

TEST(Volume, SummaryCountsActiveVoxelsOnly) {
  const std::array<float, 6> values{
      kInactiveVoxel, 3.0f, -2.0f, std::nanf(""), std::numeric_limits<float>::infinity(), 0.0f};
  const Volume volume =
      makeVolume({6, 1, 1}, glm::dmat4(1.0), [&](int x, int, int) { return values[std::size_t(x)]; });
  EXPECT_EQ(volume.activeVoxels, 3u);
  EXPECT_EQ(volume.nanVoxels, 2u);
  EXPECT_EQ(volume.negativeVoxels, 1u);
  EXPECT_EQ(volume.minimum, -2.0f);
  EXPECT_EQ(volume.maximum, 3.0f);
  EXPECT_EQ(denseScalars(volume), (std::vector<float>{kInactiveVoxel, 3, -2, kInactiveVoxel, kInactiveVoxel, 0}));
}

/// The value of the voxel that strays, for several sizes of the volume and of what is usual.
TEST(Volume, FewOutliersAreDrawnLikeTheLargestOfTheOthers) {
  for (const glm::ivec3 size : {glm::ivec3(5, 6, 7), glm::ivec3(16), glm::ivec3(40, 33, 51)})
    for (const double usual : {1e-20, 1.0, 3000.0})
      for (const double outlier : {1e30, usual * 2e4, -usual * 1e6}) {
        const Volume volume = makeVolume(size, glm::dmat4(1.0), [&](int x, int y, int z) {
          if (glm::ivec3(x, y, z) == size / 2) return float(outlier);
          return float(usual * double(x + y + z + 1) / double(size.x + size.y + size.z));
        });
        SCOPED_TRACE(testing::Message() << size.x << ' ' << usual << ' ' << outlier);
        const float most = float(usual * double(size.x + size.y + size.z - 2) / double(size.x + size.y + size.z));
        EXPECT_EQ(volume.outlierVoxels, 1u);
        EXPECT_EQ(volume.farthestOutlier, float(outlier));
        EXPECT_EQ(volume.maximum, most);
        EXPECT_EQ(volume.scalar(size.x / 2, size.y / 2, size.z / 2), outlier < 0.0 ? -most : most);
        EXPECT_EQ(volume.activeVoxels, std::uint64_t(size.x) * std::uint64_t(size.y) * std::uint64_t(size.z));
      }
}

TEST(Volume, ValuesOfManyMagnitudesAreNotWild) {
  const Volume spread = makeVolume({30, 30, 30}, glm::dmat4(1.0), [](int x, int y, int z) { return std::exp2f(float(x + y + z) - 40.0f); });
  EXPECT_EQ(spread.outlierVoxels, 0u) << "each magnitude has values";
  const Volume core = makeVolume({30, 30, 30}, glm::dmat4(1.0), [](int x, int y, int z) {
    return std::max({std::abs(x - 15), std::abs(y - 15), std::abs(z - 15)}) < 4 ? 1.0f : 1e-7f;
  });
  EXPECT_EQ(core.outlierVoxels, 0u) << "a small cloud in haze has many voxels";
}

TEST(Volume, SummaryOfNothingIsZero) {
  const Volume volume = makeVolume({2, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return kInactiveVoxel; });
  EXPECT_EQ(volume.activeVoxels, 0u);
  EXPECT_EQ(volume.minimum, 0.0f);
  EXPECT_EQ(volume.maximum, 0.0f);
}

TEST(Volume, VoxelSizeIsTheEdgeOfTheCubeOfAVoxelsVolume) {
  Volume volume;
  volume.indexToWorld[0] = {0.0, 2.0, 0.0, 0.0};
  volume.indexToWorld[1] = {-1.0, 1.0, 0.0, 0.0};
  volume.indexToWorld[2] = {5.0, 0.0, -4.0, 0.0};
  EXPECT_DOUBLE_EQ(volume.voxelSize(), 2.0);
}

TEST(Procedural, EveryKindFillsTheUnitCubeWithFiniteDensities) {
  for (const ProceduralKind& kind : proceduralKinds())
    for (const int resolution : {1, 7, 48}) {
      SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(resolution));
      const Volume volume = makeProcedural(kind.name, resolution);
      EXPECT_EQ(volume.dimensions, glm::ivec3(resolution));
      EXPECT_EQ(volume.nanVoxels, 0u);
      EXPECT_GE(volume.minimum, 0.0f);
      EXPECT_LE(volume.maximum, 1.0f);
      EXPECT_NEAR(volume.voxelSize(), 1.0 / resolution, 1e-12);
      const glm::dvec4 firstCorner = volume.indexToWorld * glm::dvec4(-0.5, -0.5, -0.5, 1.0);
      const glm::dvec4 lastCorner = volume.indexToWorld * glm::dvec4(glm::dvec3(resolution - 0.5), 1.0);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(firstCorner[axis], -0.5, 1e-12);
        EXPECT_NEAR(lastCorner[axis], 0.5, 1e-12);
      }
      EXPECT_TRUE(resolution == 1 || volume.activeVoxels > 0);
      for (const float value : denseScalars(volume)) ASSERT_NE(value, 0.0f) << "empty voxels are inactive";
    }
}

TEST(Procedural, KindsAreTheDocumentedOnes) {
  std::vector<std::string> names;
  for (const ProceduralKind& kind : proceduralKinds()) names.emplace_back(kind.name);
  EXPECT_EQ(names, (std::vector<std::string>{"cube", "cloud", "plume", "fire", "marschner-lobb", "shells",
                                             "rods", "head"}));
}

TEST(Procedural, TheSameCommandMakesTheSameVolume) {
  for (const ProceduralKind& kind : proceduralKinds())
    EXPECT_EQ(denseScalars(makeProcedural(kind.name, 33)), denseScalars(makeProcedural(kind.name, 33)))
        << kind.name;
}

/// Boxes that are nearly empty are filled only where something may be.
TEST(Procedural, ThePlumeLosesNothingToTheBricksThatAreLeftOut) {
  const int n = 72;
  const Volume plume = makeProcedural("plume", n);
  EXPECT_LT(plume.activeVoxels, std::uint64_t(n * n * n) / 15);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const float density = plumeDensity((glm::vec3(x, y, z) + 0.5f) / float(n) - 0.5f);
        EXPECT_NEAR(std::max(plume.scalar(x, y, z), 0.0f), density, 1e-3) << x << "," << y << "," << z;
      }
}

TEST(Procedural, TheCubeIsUniform) {
  const Volume cube = makeProcedural("cube", 9);
  EXPECT_EQ(cube.activeVoxels, 729u);
  EXPECT_EQ(cube.minimum, 1.0f);
  EXPECT_EQ(cube.maximum, 1.0f);
}

TEST(Procedural, MarschnerLobbFollowsItsFormula) {
  const Volume volume = makeProcedural("marschner-lobb", 40);
  EXPECT_EQ(volume.activeVoxels, 64000u);
  for (const glm::ivec3 voxel : {glm::ivec3(0, 0, 0), glm::ivec3(19, 23, 7), glm::ivec3(39, 20, 39)}) {
    const glm::dvec3 p = (glm::dvec3(voxel) + 0.5) / 20.0 - 1.0;
    const double radius = std::hypot(p.x, p.y);
    const double pi = std::numbers::pi;
    const double ripple = std::cos(2.0 * pi * 6.0 * std::cos(pi * radius / 2.0));
    const double expected = (1.0 - std::sin(pi * p.z / 2.0) + 0.25 * (1.0 + ripple)) / 2.5;
    EXPECT_NEAR(volume.scalar(voxel.x, voxel.y, voxel.z), expected, 1e-5);
  }
}

TEST(Procedural, ShellsHaveTheirMass) {
  // A cos² bump of half width w around r: 4π ∫ cos²(π(x - r)/2w) x² dx = 4π w (r² + w² (1/3 - 2/π²)).
  const double w = 0.04, pi = std::numbers::pi;
  double expected = 0.0;
  for (const auto& [radius, peak] :
       {std::pair(0.10, 1.0), std::pair(0.21, 0.6), std::pair(0.32, 0.35), std::pair(0.43, 0.2)})
    expected += peak * 4.0 * pi * w * (radius * radius + w * w * (1.0 / 3.0 - 2.0 / (pi * pi)));
  EXPECT_NEAR(mass(makeProcedural("shells", 96)) / expected, 1.0, 1e-3);
  const Volume shells = makeProcedural("shells", 96);
  EXPECT_EQ(valueAt(shells, {0.0, 0.0, 0.0}), 0.0f);
  EXPECT_GT(valueAt(shells, {0.0, 0.0, 0.10}), 0.9f);
  EXPECT_NEAR(valueAt(shells, {0.0, 0.43, 0.0}), 0.2f, 0.02f);
}

TEST(Procedural, RodsAreAFewVoxelsThick) {
  const Volume rods = makeProcedural("rods", 128);
  // Across a rod that runs along z, half way between two junctions.
  const int y = 64 + int(std::lround(128.0 / 7.0)), z = 64 + 9;
  double thickness = 0.0;
  for (int x = 60; x < 68; ++x)
    for (int dy = -4; dy < 4; ++dy) {
      const float value = rods.scalar(x, y + dy, z);
      if (value != kInactiveVoxel) thickness += value;
    }
  EXPECT_NEAR(std::sqrt(thickness * 4.0 / std::numbers::pi), 1.8,
              0.2);  // of a round rod with this cross-section
  EXPECT_LT(double(rods.activeVoxels), 0.1 * 128 * 128 * 128);
}

TEST(Procedural, TheHeadHasBoneAroundTheBrainAndEyeSockets) {
  const Volume head = makeProcedural("head", 128);
  EXPECT_NEAR(valueAt(head, {0.05, 0.14, -0.03}), 0.35f, 0.05f) << "brain";
  EXPECT_GT(valueAt(head, {0.0, 0.14 + 0.232 + 0.014, -0.035}), 0.9f) << "vault";
  EXPECT_GT(valueAt(head, {0.0, 0.14, -0.035 - 0.262 - 0.014}), 0.9f) << "back of the skull";
  EXPECT_LT(valueAt(head, {0.082, 0.035, 0.245}), 0.3f) << "eye";
  EXPECT_LT(valueAt(head, {-0.082, 0.035, 0.245}), 0.3f) << "the other eye";
  EXPECT_GT(valueAt(head, {0.0, -0.24, 0.207}), 0.9f) << "chin";
  EXPECT_EQ(valueAt(head, {0.45, 0.45, 0.45}), 0.0f);
}

TEST(Procedural, TheCloudIsSoftAndFreeOfTheBoundary) {
  const Volume cloud = makeProcedural("cloud", 64);
  const double filled = double(cloud.activeVoxels) / double(cloud.voxelCount());
  EXPECT_GT(filled, 0.08);
  EXPECT_LT(filled, 0.4);
  EXPECT_GT(cloud.maximum, 0.8f);
  double largestStep = 0.0;
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 64; ++y) {
      for (const int x : {0, 63}) {
        EXPECT_EQ(cloud.scalar(x, y, z), kInactiveVoxel);
        EXPECT_EQ(cloud.scalar(y, x, z), kInactiveVoxel);
        EXPECT_EQ(cloud.scalar(y, z, x), kInactiveVoxel);
      }
      for (int x = 1; x < 64; ++x)
        largestStep = std::max<double>(largestStep, std::abs(std::max(cloud.scalar(x, y, z), 0.0f) -
                                                             std::max(cloud.scalar(x - 1, y, z), 0.0f)));
    }
  EXPECT_LT(largestStep, 0.9);
}

TEST(Procedural, UnknownNamesAndSizesAreRefused) {
  const auto expectRefused = [](std::string_view name, int resolution) {
    test::expectRefusal([&] { makeProcedural(name, resolution); }, ErrorKind::Usage, {});
  };
  expectRefused("teapot", 8);
  expectRefused("cube", 0);
  expectRefused("cube", -5);
  expectRefused("cube", 2049);
}

}  // namespace
}  // namespace freevoxels
