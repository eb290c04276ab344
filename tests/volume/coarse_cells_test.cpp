// Which cells the gather meets anything in, and how many groups of slices it may skip.
#include "engine/volume/coarse_cells.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/volume/procedural.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {
namespace {

Cells withOne(glm::ivec3 dimensions, glm::ivec3 cell) {
  Cells cells(dimensions);
  cells.values[cells.index(cell)] = 1;
  return cells;
}

TEST(GatherCells, DensityMarksTheCellOfItsVoxelAlone) {
  const glm::ivec3 voxel(8, 3, 15);
  const Volume volume = makeVolume(glm::ivec3(18, 9, 21), glm::dmat4(1.0),
                                   [&](int x, int y, int z) { return glm::ivec3(x, y, z) == voxel ? 1.0f : 0.0f; });
  const Cells cells = metCells(volume, {.densityScale = 1.0}, 4);
  EXPECT_EQ(cells.dimensions, glm::ivec3(5, 3, 6));
  EXPECT_EQ(cells.values, withOne(cells.dimensions, {2, 0, 3}).values);
}

/// The box does not begin where its bricks do, and has voxels without data.
TEST(GatherCells, InterpolatedScalarsThatHaveExtinctionAreInMarkedCells) {
  const glm::ivec3 size(21, 14, 18), corner(3, 5, 2);
  Volume volume = makeVolume(size, glm::dmat4(1.0), [](int, int, int) { return 0.0f; });
  volume.scalars = ScalarBricks(size, corner);
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> value(0.0f, 0.5f);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (z < 15) volume.scalars.set({x, y, z}, x < 11 ? 0.1f : 0.2f + value(generator));
  summariseValues(volume);
  const TransferFunction peak{.opacity = {{0.55f, 0.0f}, {0.6f, 0.8f}, {0.65f, 0.0f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = 1.0};
  const TransferIntegral integral(peak, volume.minimum, volume.maximum);
  const Cells cells = metCells(volume, {.transferFunction = peak, .order = ClassificationOrder::Post}, 4);
  int marked = 0, met = 0;
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < cells.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < cells.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < cells.dimensions.x; ++cell.x) {
        float low = 1.0f, high = 0.0f;
        const glm::ivec3 first = 4 * cell, last = glm::min(first + 4, size - 1);
        for (glm::ivec3 v = first; v.z <= last.z; ++v.z)
          for (v.y = first.y; v.y <= last.y; ++v.y)
            for (v.x = first.x; v.x <= last.x; ++v.x)
              if (const float scalar = volume.scalars.at(v); scalar != kInactiveVoxel)
                low = std::min(low, scalar), high = std::max(high, scalar);
        const bool holds = low <= high && integral.isOccupied(low, high);
        EXPECT_EQ(cells.at(cell) != 0, holds) << cell.x << ' ' << cell.y << ' ' << cell.z;
        marked += cells.at(cell);
        ++met;
      }
  EXPECT_GT(marked, 10);
  EXPECT_LT(marked, met - 10);
}

/// A voxel whose own scalar has no extinction may have some half the way to its neighbour, also to that in the cell before.
TEST(GatherCells, VoxelsThatAreClassifiedWithTheirNeighboursAreInMarkedCells) {
  const TransferFunction ramp{.opacity = {{0.2f, 0.0f}, {1.0f, 0.8f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = 1.0};
  const Classification classification{.transferFunction = ramp, .order = ClassificationOrder::Pre};
  const glm::ivec3 size(17, 14, 19);
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 1; end < 13; ++end)
      for (const bool fromBelow : {false, true}) {
        const Volume volume = makeVolume(size, glm::dmat4(1.0), [&](int x, int y, int z) {
          return (glm::ivec3(x, y, z)[axis] < end) == fromBelow ? 1.0f : 0.0f;
        });
        const VoxelClassifier classifier(classification, volume);
        const Cells met = spread(metCells(volume, classification, 4), 0, 1);
        glm::ivec3 voxel;
        for (voxel.z = 0; voxel.z < size.z; ++voxel.z)
          for (voxel.y = 0; voxel.y < size.y; ++voxel.y)
            for (voxel.x = 0; voxel.x < size.x; ++voxel.x)
              if (classifier.at(voxel).extinction > 0.0) {
                // Positions between the voxel and the one before it are interpolated with it, too.
                for (const glm::ivec3 place : {voxel, glm::max(voxel - 1, 0)})
                  EXPECT_EQ(int(met.at(place / 4)), 1) << place[axis] << " on axis " << axis << ", end " << end;
              }
      }
}

TEST(GatherCells, CoarserCellsHaveWhatAnyOfEightHas) {
  EXPECT_EQ(coarserCells(withOne({5, 3, 2}, {4, 1, 1})).values, withOne({3, 2, 1}, {2, 0, 0}).values);
}

TEST(GatherCells, SkippedGroupsReachNoMetCellFromTheCellOrTheNext) {
  const Cells skips = groupsToSkip(withOne({40, 1, 1}, {20, 0, 0}));
  for (int x = 0; x < 40; ++x) {
    const int apart = std::abs(x - 20);
    EXPECT_EQ(int(skips.at({x, 0, 0})), apart == 0 ? 0 : std::clamp(apart - 1, 1, 8)) << x;
  }
}

}  // namespace
}  // namespace freevoxels
