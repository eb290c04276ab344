#include "engine/attenuation/slabs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace freevoxels {
namespace {

constexpr std::uint64_t kPlenty = std::numeric_limits<std::uint64_t>::max();
constexpr SweepStyle kStyle{.voxelsPerThread = 16, .slabBytes = std::uint64_t(1) << 20};

TEST(Slabs, TwoPassesCoverEveryPlaneOnceAndStepInWholePatterns) {
  for (const int planes : {1, 7, 8, 9, 64, 100, 513})
    for (const int perSlab : {8, 16, 104, 520}) {
      int upwards = 0, downwards = 0;
      for (const Slab& slab : SweepPlan{.planesPerSlab = perSlab}.slabs(planes)) {
        int& done = slab.upwards ? upwards : downwards;
        EXPECT_EQ(slab.first, done);
        EXPECT_EQ(slab.first % kSlabAlignment, 0);
        EXPECT_EQ(slab.lowest(planes), slab.upwards ? done : planes - done - slab.count());
        done = slab.end;
      }
      EXPECT_EQ(upwards, planes);
      EXPECT_EQ(downwards, planes);
    }
}

TEST(Slabs, OneSlabIsAllWhereItFits) {
  const GridLayout small({64, 64, 32});
  const SweepPlan plan = planSweep(small, DirectionSet::Directions98, kStyle, kPlenty);
  EXPECT_EQ(plan.planesPerSlab, 32);
  EXPECT_EQ(plan.keptBytes, 0u);
  EXPECT_EQ(plan.slabs(32).size(), 2u);  // upwards, and downwards through the same
}

TEST(Slabs, NoMoreBytesThanThereAreIfThatIsPossible) {
  const GridLayout large({500, 300, 400});
  const SweepStyle style{
      .voxelsPerThread = 4, .slabBytes = std::uint64_t(64) << 20, .mostSlabBytes = std::uint64_t(96) << 20};
  for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98}) {
    const SweepPlan least = planSweep(large, set, style, 0);
    EXPECT_EQ(least.planesPerSlab, kSlabAlignment);
    EXPECT_GT(least.keptBytes, 0u);
    for (const std::uint64_t bytes : {least.bytes() + (1u << 23), least.bytes() + (1u << 25), kPlenty}) {
      const SweepPlan plan = planSweep(large, set, style, bytes);
      EXPECT_LE(plan.bytes(), bytes);
      EXPECT_LE(plan.slabBytes, style.mostSlabBytes);
      EXPECT_GT(plan.planesPerSlab, kSlabAlignment);
      EXPECT_EQ(plan.planesPerSlab % kSlabAlignment, 0);
    }
  }
}

/// Nine of the 26 directions march one way along z and nine the other; six of each nine have steps in x.
TEST(Slabs, KeptDepthsAreThoseOfAllLinesThatMarchOneWay) {
  const GridLayout layout({64, 10, 400});
  const SweepStyle style{.voxelsPerThread = 4, .slabBytes = 4096, .mostSlabBytes = 1 << 20};
  const std::uint64_t threads = 64 / 4 * 10;
  EXPECT_EQ(planSweep(layout, DirectionSet::Directions26, style, kPlenty).keptBytes,
            threads * (3 * 4 + 6 * 7) * sizeof(float));
}

}  // namespace
}  // namespace freevoxels
