// Real files, where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "engine/core/error.h"
#include "engine/volume/vdb.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMemoryLimit = 1u << 28;
const fs::path kData = FREEVOXELS_DATA_DIR;

struct RealFile {
  const char* name;
  glm::ivec3 dimensions;
  std::uint64_t activeVoxels;
};

TEST(RealVdb, FilesHaveTheirPublishedFigures) {
  const std::vector<RealFile> files{{"wdas_cloud_sixteenth.vdb", {126, 86, 154}, 415'642},
                                    {"smoke1.vdb", {111, 222, 112}, 1'049'275},
                                    {"dragon_with_xform.vdb", {141, 99, 63}, 156'161},
                                    {"usd_densityAndHeat.vdb", {23, 23, 42}, 0},
                                    {"usd_smoke_000003.vdb", {51, 49, 96}, 90'197},
                                    {"blender_fluid_0050.vdb", {25, 19, 29}, 0},
                                    {"scivis_grid0.vdb", {81, 81, 81}, 0}};
  if (!fs::exists(kData)) GTEST_SKIP() << "no real volumes in " << kData;
  for (const RealFile& expected : files) {
    if (!fs::exists(kData / expected.name)) continue;
    SCOPED_TRACE(expected.name);
    const Volume volume = readVdb(kData / expected.name, "", kMemoryLimit);
    EXPECT_EQ(volume.dimensions, expected.dimensions);
    EXPECT_TRUE(expected.activeVoxels == 0 || volume.activeVoxels == expected.activeVoxels)
        << volume.activeVoxels;
  }
}

TEST(RealVdb, TheRotatedDragonStaysRotated) {
  const fs::path file = kData / "dragon_with_xform.vdb";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const Volume volume = readVdb(file, "", kMemoryLimit);
  int offDiagonal = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) offDiagonal += i != j && std::abs(volume.indexToWorld[i][j]) > 1e-3;
  EXPECT_GT(offDiagonal, 0);
}

TEST(RealVdb, TheLevelSetSphereHasItsVolume) {
  const fs::path file = kData / "sphere_ls.vdb";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file;
  const Volume volume = readVdb(file, "", kMemoryLimit);
  double sum = 0.0;
  for (const float value : denseScalars(volume))
    if (value != kInactiveVoxel) sum += value;
  // 125 voxels with a narrow band of 3 outside: the radius is 60 voxels up to the rounding of the box.
  EXPECT_NEAR(std::cbrt(sum * 3.0 / (4.0 * std::numbers::pi)), 60.0, 0.5);
}

TEST(RealVdb, EveryFileIsReadOrRefusedInOneSentence) {
  if (!fs::exists(kData)) GTEST_SKIP() << "no real volumes in " << kData;
  for (const auto& entry : fs::recursive_directory_iterator(kData)) {
    SCOPED_TRACE(entry.path().string());
    try {
      EXPECT_GT(readVdb(entry.path(), "", kMemoryLimit).activeVoxels, 0u);
      EXPECT_EQ(entry.path().extension(), ".vdb");
    } catch (const Error& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_EQ(sentence.find('\n'), std::string::npos);
      EXPECT_NE(sentence.find(entry.path().string()), std::string::npos) << sentence;
    }
  }
}

}  // namespace
}  // namespace freevoxels
