#include "engine/volume/scan_write.h"

#include <limits>

#include "engine/volume/scan_file.h"
#include "engine/volume/volume_of_scalars.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels::test {

namespace {

/// With a place that is parallel to no axis, and a hole. `unit` scales it.
Volume obliqueVolume(double unit = 1.0, double side = 1.0) {
  ScalarBricks scalars = ScalarBricks::make({13, 9, 10}, [](glm::ivec3 v) { return 0.5f + float(v.x + 13 * v.y) - 100.0f * float(v.z); });
  scalars.set({3, 4, 5}, kInactiveVoxel);
  glm::dmat4 place(1.0);
  place[0] = glm::dvec4(0.8, 0.6, 0.0, 0.0) * 2.0;
  place[1] = glm::dvec4(-0.48, 0.64, 0.6, 0.0) * 3.0;
  place[2] = glm::dvec4(0.36, -0.48, 0.8, 0.0) * 2.5 * side;
  place *= unit;
  place[3] = {10.0 * unit, -20.0 * unit, 30.0 * unit, 1.0};
  return volumeOfScalars(std::move(scalars), place, NoData());
}

}  // namespace

TEST(ScanWrite, WhatIsWrittenIsReadInItsPlace) {
  const TemporaryFolder folder;
  constexpr double kMicrometre = 1e-4;  // so small that readers of NIfTI take the directions for sheared
  for (const double unit : {1.0, kMicrometre})
    for (const double side : {1.0, -1.0})
      for (const char* name : {"a.nrrd", "a.nii", "a.nii.gz"}) {
        SCOPED_TRACE(fmt::format("{} {} {}", name, unit, side));
        const Volume volume = obliqueVolume(unit, side);
        const auto file = folder / name;
        std::string(name).ends_with(".nrrd") ? writeNrrd(file, volume) : writeNifti(file, volume);
        const Volume again = readScan(file, {.noData = NoData(), .maximumVoxels = 1 << 20});
        ASSERT_EQ(again.dimensions, volume.dimensions);
        EXPECT_EQ(denseScalars(again), denseScalars(volume));
        for (int column = 0; column < 4; ++column)
          for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(again.indexToWorld[column][row], volume.indexToWorld[column][row], 2e-5 * unit) << column << " " << row;
      }
}

TEST(ScanWrite, DensitiesAreZeroWhereThereIsNoData) {
  const TemporaryFolder folder;
  Volume volume = obliqueVolume();
  volume.isFog = true;
  writeNrrd(folder / "a.nrrd", volume);
  EXPECT_EQ(readScan(folder / "a.nrrd", {.noData = NoData(), .maximumVoxels = 1 << 20}).scalar(3, 4, 5), 0.0f);
}

TEST(ScanWrite, WhatCannotBeWrittenIsRefusedAndLeavesNothing) {
  const TemporaryFolder folder;
  const Volume volume = obliqueVolume();
  EXPECT_EQ(errorOf([&] { writeNrrd(folder / "none" / "a.nrrd", volume); }).kind(), ErrorKind::Output);
  const Volume longest{.dimensions = {40000, 1, 1}, .scalars = ScalarBricks(glm::ivec3(40000, 1, 1))};
  expectRefusal([&] { writeNifti(folder / "a.nii.gz", longest); }, ErrorKind::Input, {"a.nii.gz", "32767"});
  EXPECT_EQ(folder.fileCount(), 0u);
}

}  // namespace freevoxels::test
