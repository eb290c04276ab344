// The table on the device against the double-precision reference and against Beer-Lambert.

#include <cmath>
#include <map>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/volume_builder.h"
#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "engine/renderer_stages.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

using Table = std::vector<std::vector<std::uint8_t>>;

struct WorstByte {
  int difference = 0;
  int direction = -1;
  std::size_t voxel = 0;
};

/// Compares occupied voxels only, which alone are stored.
WorstByte worstByte(const Table& a, const Table& b, const std::vector<double>& extinction) {
  WorstByte worst;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t d = 0; d < a.size(); ++d)
    for (std::size_t i = 0; i < a[d].size(); ++i) {
      if (extinction[i] <= 0.0) continue;
      const int difference = std::abs(int(a[d][i]) - int(b[d][i]));
      if (difference > worst.difference) worst = {difference, int(d), i};
    }
  return worst;
}

/// Whether a line along the direction that has its first point outside of the voxels' centres there left the
/// box through a side: not through a face that it comes one voxel nearer in every layer.
bool leavesSideways(glm::dvec3 outside, glm::dvec3 direction, glm::ivec3 size) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(direction[axis]) == 1.0 && (outside[axis] < 0.0 || outside[axis] > size[axis] - 1.0))
      return false;
  return true;
}

class AttenuationTableTest : public DeviceTest {
 protected:
  /// As Renderer makes it, with the pipelines kept for the next volume.
  Table tableOnDevice(const Volume& volume, const Classification& classification,
                      const TableSettings& settings) {
    const auto [sweep, isNew] = sweeps_.try_emplace({settings.code, settings.directions}, device(), settings);
    std::vector<StageTime> times;
    const BuiltVolume built = buildVolume(device(), volume, classification, times);
    const AttenuationTable table = makeTable(device(), built.volume, settings);
    Commands commands(device());
    sweep->second.record(commands, built.volume, table);
    commands.submitAndWait();
    return downloadTable(device(), built.volume, table);
  }

  void expectWithinOneCode(const Volume& volume, const TableSettings& settings) {
    const Classification classification{.densityScale = 1.0};
    const Table table = tableOnDevice(volume, classification, settings);
    const std::vector<double> extinction = referenceExtinction(volume, classification);
    const WorstByte worst = worstByte(table, referenceTable(volume, extinction, settings), extinction);
    const glm::dvec3 d =
        worst.direction < 0 ? glm::dvec3(0) : directionAt(settings.directions, worst.direction);
    EXPECT_LE(worst.difference, 1) << volume.dimensions.x << "x" << volume.dimensions.y << "x"
                                   << volume.dimensions.z << ", direction " << d.x << "," << d.y << "," << d.z
                                   << ", voxel " << worst.voxel;
  }

  void expectAllSettingsWithinOneCode(const Volume& volume) {
    for (AttenuationCode code : {AttenuationCode::Depth8, AttenuationCode::Linear8})
      for (bool corrected : {true, false})
        for (DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98})
          expectWithinOneCode(volume, {code, corrected, set});
  }

 private:
  std::map<std::pair<AttenuationCode, DirectionSet>, AttenuationSweep> sweeps_;
};

TEST_F(AttenuationTableTest, OddSizedRandomVolumesMatchTheReference) {
  for (glm::ivec3 size : {glm::ivec3(1, 1, 1), glm::ivec3(1, 19, 1), glm::ivec3(23, 1, 1),
                          glm::ivec3(1, 1, 13), glm::ivec3(2, 3, 5), glm::ivec3(17, 2, 31),
                          glm::ivec3(37, 23, 19), glm::ivec3(16, 16, 16), glm::ivec3(33, 5, 2)})
    expectAllSettingsWithinOneCode(randomVolume(size, cubeTransform(size), 1.0, 20.0));
}

TEST_F(AttenuationTableTest, ShearedAnisotropicVoxelsMatchTheReference) {
  for (glm::ivec3 size : {glm::ivec3(29, 31, 7), glm::ivec3(5, 41, 13)})
    expectAllSettingsWithinOneCode(randomVolume(size, shearedTransform(size), 0.7, 15.0));
}

TEST_F(AttenuationTableTest, SparseVolumesMatchTheReference) {
  const glm::ivec3 size(43, 29, 31);
  expectAllSettingsWithinOneCode(randomVolume(size, cubeTransform(size), 0.02, 60.0));
}

TEST_F(AttenuationTableTest, OpaqueVolumesMatchTheReference) {
  const glm::ivec3 size(31, 17, 23);
  expectAllSettingsWithinOneCode(randomVolume(size, cubeTransform(size), 0.5, 1e4));
}

TEST_F(AttenuationTableTest, TransferFunctionVolumesMatchTheReference) {
  const glm::ivec3 size(21, 22, 23);
  const Volume volume = randomVolume(size, cubeTransform(size), 1.0, 1.0);
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.1f, 0.0f}, {0.4f, 0.0001f}, {0.5f, 0.3f}, {0.9f, 1.0f}},
                       .color = {{0.0f, glm::vec3(1.0f)}},
                       .unitDistance = volume.voxelSize() * 0.7};
  const Table table = RendererStages(Renderer(device(), volume, classification, {})).downloadTable();
  const std::vector<double> extinction = referenceExtinction(volume, classification);
  const Table reference = referenceTable(volume, extinction, TableSettings{});
  EXPECT_LE(worstByte(table, reference, extinction).difference, 1);
}

/// A line that leaves through a side may do so between two voxels, of which one is outside: the closed form
/// is for the others.
TEST_F(AttenuationTableTest, HomogeneousBoxIsBeerLambertInAllDirections) {
  const glm::ivec3 size(25, 19, 14);
  const double sigma = 3.0;
  const Volume volume = makeVolume(size, shearedTransform(size), [&](int, int, int) { return sigma; });
  for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98}) {
    const Table table =
        RendererStages(Renderer(device(), volume, {.densityScale = 1.0}, {.directions = set})).downloadTable();
    int checked = 0;
    for (int d = 0; d < directionCount(set); ++d) {
      const glm::dvec3 direction = directionAt(set, d);
      const double step = glm::length(glm::dmat3(volume.indexToWorld) * direction);
      for (glm::ivec3 voxel : {glm::ivec3(0), size - 1, size / 2, glm::ivec3(3, 17, 5)}) {
        const auto inside = [&](glm::dvec3 p) {
          return glm::all(glm::greaterThanEqual(p, glm::dvec3(0))) &&
                 glm::all(glm::lessThanEqual(p, glm::dvec3(size - 1)));
        };
        int steps = 0;  // layers to the last one inside
        while (inside(glm::dvec3(voxel) + (steps + 1.0) * direction)) ++steps;
        if (leavesSideways(glm::dvec3(voxel) + (steps + 1.0) * direction, direction, size)) continue;
        ++checked;
        const int expected = int(std::lround(255.0 * std::sqrt(std::min(sigma * step * steps, 16.0) / 16.0)));
        EXPECT_NEAR(table[std::size_t(d)][volume.at(voxel.x, voxel.y, voxel.z)], expected, 1)
            << "direction " << d << ", " << steps << " steps";
      }
    }
    EXPECT_GE(checked, 2 * directionCount(set));
  }
}

TEST_F(AttenuationTableTest, VisibleVoxelsAreThoseWithExtinctionInAscendingOrder) {
  for (glm::ivec3 size : {glm::ivec3(1, 1, 1), glm::ivec3(37, 41, 43), glm::ivec3(3, 100, 9)}) {
    const Volume volume = randomVolume(size, cubeTransform(size), 0.3, 1.0);
    const Classification classification{.densityScale = 1.0};
    const Renderer renderer(device(), volume, classification, {});
    EXPECT_EQ(RendererStages(renderer).downloadBlockList(),
              referenceVisibleVoxels(referenceExtinction(volume, classification)));
  }
}

}  // namespace
}  // namespace freevoxels
