// What is kept of a volume: of the blocks that hold anything, and of no others.

#include "engine/octree/occupancy.h"

#include <algorithm>
#include <cmath>

#include "engine/attenuation/attenuation_table.h"
#include "engine/octree/volume_builder.h"
#include "engine/reference/reference_table.h"
#include "engine/renderer.h"
#include "engine/volume/occupied_count.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

constexpr double kFull = 1.0, kSparse = 0.01;

class OccupancyTest : public DeviceTest {
 protected:
  static BuiltVolume build(const Volume& volume) {
    std::vector<StageTime> times;
    return buildVolume(device(), volume, {.densityScale = 1.0}, times);
  }
};

/// Rows that end within a word, levels of odd dimensions, words of several rows.
TEST_F(OccupancyTest, HasTheBlocksThatHoldAVoxelWithExtinction) {
  for (const glm::ivec3 size :
       {glm::ivec3(1, 1, 1), glm::ivec3(37, 41, 19), glm::ivec3(3, 100, 9), glm::ivec3(64, 5, 33)})
    for (const double filled : {kSparse, 0.3, kFull}) {
      const Volume volume = randomVolume(size, cubeTransform(size), filled, 1.0);
      const BuiltVolume built = build(volume);
      const HierarchyLayout& hierarchy = built.volume.hierarchy;
      std::vector<bool> holding;
      for (const double extinction : referenceExtinction(volume, {.densityScale = 1.0}))
        holding.push_back(extinction > 0.0);
      EXPECT_EQ(built.volume.stored, countOccupiedBlocks(hierarchy.levels.front().dimensions, holding));

      std::vector<std::uint32_t> parents;
      for (int level = hierarchy.top(); level >= 0; --level) {
        const std::vector<std::uint32_t> blocks = downloadStored(device(), built.volume, level);
        EXPECT_EQ(blocks.size(), built.volume.stored[std::size_t(level)]);
        EXPECT_TRUE(std::ranges::is_sorted(blocks));
        const glm::ivec3 n = hierarchy.levels[std::size_t(level)].dimensions;
        for (const std::uint32_t block : blocks) {
          if (level == hierarchy.top()) continue;
          const glm::uvec3 cell(block % std::uint32_t(n.x), block / std::uint32_t(n.x) % std::uint32_t(n.y),
                                block / std::uint32_t(n.x * n.y));
          const glm::uvec3 above(hierarchy.levels[std::size_t(level) + 1].dimensions), parent = cell / 2u;
          EXPECT_TRUE(
              std::ranges::binary_search(parents, parent.x + above.x * (parent.y + above.y * parent.z)));
        }
        parents = blocks;
      }
    }
}

TEST_F(OccupancyTest, NothingIsKeptOfWhatIsEmpty) {
  const glm::ivec3 size(70, 60, 50);
  const auto stored = [&](double filled) {
    const Volume volume = randomVolume(size, cubeTransform(size), filled, 1.0);
    return Renderer(device(), volume, {.densityScale = 1.0}, {}).memory();
  };
  const VolumeMemory sparse = stored(kSparse), full = stored(kFull);
  EXPECT_LT(sparse.table, full.table / 10);  // a voxel in a hundred, and nearly every second block of 4³
  EXPECT_EQ(sparse.occupancy, full.occupancy);
  EXPECT_LT(sparse.peak(), full.peak());
  const BuiltVolume built = build(randomVolume(size, cubeTransform(size), kSparse, 1.0));
  const AttenuationTable table = makeTable(device(), built.volume, {});
  std::uint64_t bytes = 0;
  for (const Buffer& plane : table.planes) bytes += plane.bytes();
  EXPECT_EQ(bytes, 26 * ((sparse.table / 26 + 3) / 4 * 4));
  EXPECT_EQ(built.volume.extinction.bytes(), sparse.extinction);
}

/// The mean of a block may be less than the least that a float is apart from 0.
TEST_F(OccupancyTest, BlocksOfAlmostNothingDrawNoNaN) {
  const glm::ivec3 size(33, 33, 33);
  const Volume volume = makeVolume(size, cubeTransform(size), [&](int x, int y, int z) {
    if (x == 16 && y == 16 && z == 16) return 1.0f;
    return x % 8 == 0 && y % 8 == 0 && z % 8 == 0 ? 2e-38f : 0.0f;
  });
  Renderer renderer(device(), volume, {.densityScale = 1.0}, {});
  for (const float lod : {0.0f, 2.0f, 40.0f}) {
    const Image image =
        renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}), {.size = {16, 16}, .method = SplatSettings{}, .lod = lod});
    for (const glm::vec4& pixel : image.pixels)
      for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(pixel[c]));
  }
}

/// A transfer function may leave nothing of a volume that is full of values.
TEST_F(OccupancyTest, AVolumeThatHoldsNothingIsAnEmptyImage) {
  const glm::ivec3 size(20, 9, 11);
  const Volume volume = randomVolume(size, cubeTransform(size), kFull, 1.0);
  const Classification classification{
      .transferFunction = TransferFunction{
          .opacity = {{0.0f, 0.0f}, {1.0f, 0.0f}}, .color = {{0.0f, glm::vec3(1.0f)}}, .unitDistance = 1.0}};
  Renderer renderer(device(), volume, classification, {});
  for (const AttenuationLookup lookup : {AttenuationLookup::Bilinear, AttenuationLookup::Nearest})
    for (const float lod : {0.0f, 8.0f})
      for (const Composite composite : {Composite::Normalised, Composite::Sorted}) {
        const Image image =
            renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}),
                            {.size = {24, 24}, .method = SplatSettings{.composite = composite, .attenuation = lookup}, .lod = lod});
        for (const glm::vec4& pixel : image.pixels) EXPECT_EQ(pixel, glm::vec4(0.0f));
      }
  EXPECT_EQ(renderer.occupiedVoxelCount(), 0u);
}

}  // namespace
}  // namespace freevoxels
