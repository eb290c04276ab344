// Sweeping slab by slab: the same table, in the memory that is set.

#include <limits>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/error.h"
#include "engine/octree/volume_builder.h"
#include "engine/reference/reference_table.h"
#include "engine/renderer.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

class SlabSweepTest : public DeviceTest {
 protected:
  static std::vector<std::vector<std::uint8_t>> tableOf(const BuiltVolume& built,
                                                        const TableSettings& settings,
                                                        AttenuationSweep& sweep) {
    const AttenuationTable table = makeTable(device(), built.volume, settings);
    Commands commands(device());
    commands.beginPass("clear");
    for (const Buffer& plane : table.planes) commands.clear(plane);  // which may have the memory of an earlier table
    sweep.record(commands, built.volume, table);
    commands.submitAndWait();
    return downloadTable(device(), built.volume, table);
  }
};

/// In slabs of eight planes, whatever the pattern of the steps, with planes that are left over at one end; as
/// a CPU and as a GPU sweeps.
TEST_F(SlabSweepTest, SlabsComeToTheSameTableBitForBit) {
  for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98}) {
    const TableSettings settings{.directions = set};
    AttenuationSweep whole(device(), settings);
    AttenuationSweep ofCpu(device(), settings, {.voxelsPerThread = 16, .slabBytes = 0, .mostSlabBytes = 0});
    AttenuationSweep ofGpu(device(), settings, {.voxelsPerThread = 4, .tiledRows = true, .slabBytes = 0, .mostSlabBytes = 0});
    for (const glm::ivec3 size : {glm::ivec3(37, 23, 43), glm::ivec3(5, 1, 64), glm::ivec3(20, 33, 17)}) {
      std::vector<StageTime> times;
      const BuiltVolume built = buildVolume(device(), randomVolume(size, shearedTransform(size), 0.6, 8.0),
                                            {.densityScale = 1.0}, times);
      const auto table = tableOf(built, settings, whole);
      EXPECT_EQ(tableOf(built, settings, ofCpu), table) << size.x << ", " << directionCount(set);
      EXPECT_EQ(tableOf(built, settings, ofGpu), table) << size.x << ", " << directionCount(set);
    }
  }
}

/// As a GPU sweeps, which takes the whole volume in one slab where it may.
TEST_F(SlabSweepTest, ALimitOfMemoryMakesThinnerSlabsOfTheSameTable) {
  const glm::ivec3 size(64, 60, 200);
  const Volume volume = randomVolume(size, cubeTransform(size), 0.3, 8.0);  // the sweeps take the most, not the upload
  const auto tableAndPeak = [&](std::uint64_t limit) {
    const Device limited(instance(), "", {.memory = limit});
    std::vector<StageTime> times;
    const BuiltVolume built = buildVolume(limited, volume, {.densityScale = 1.0}, times);
    const AttenuationTable table = makeTable(limited, built.volume, {});
    {
      AttenuationSweep sweep(limited, {}, sweepStyleOf(false));
      Commands commands(limited);
      sweep.record(commands, built.volume, table);
      commands.submitAndWait();
    }
    const auto codes = downloadTable(limited, built.volume, table);
    return std::pair(codes, limited.peakBytes());
  };
  const auto [table, peak] = tableAndPeak(std::numeric_limits<std::uint64_t>::max());
  const auto [limitedTable, limitedPeak] = tableAndPeak(peak - 500'000);
  EXPECT_LE(limitedPeak, peak - 500'000);
  EXPECT_EQ(limitedTable, table);
}

TEST_F(SlabSweepTest, NothingIsAllocatedBeyondALimit) {
  constexpr std::uint64_t kLimit = 1 << 20;
  const Device limited(instance(), "", {.memory = kLimit});
  EXPECT_EQ(limited.availableBytes(), kLimit);
  {
    const Buffer half(limited, kLimit / 2, MemoryUse::Device, "half");
    EXPECT_EQ(limited.availableBytes(), kLimit / 2);
    try {
      const Buffer more(limited, kLimit, MemoryUse::Device, "more");
      FAIL() << "more than the limit";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::OutOfMemory);
      EXPECT_NE(std::string(error.what()).find("memory-limit"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(limited.availableBytes(), kLimit);
  EXPECT_EQ(limited.peakBytes(), kLimit / 2);
}

}  // namespace
}  // namespace freevoxels
