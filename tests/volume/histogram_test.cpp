#include "engine/volume/histogram.h"

#include <gtest/gtest.h>

#include <numeric>

#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

/// Values 0 to 9, value v in v + 1 columns of 2 x 3 voxels.
Volume staircase() {
  return makeVolume({55, 2, 3}, glm::dmat4(1.0), [](int x, int, int) {
    int value = 0;
    while ((value + 1) * (value + 2) / 2 <= x) ++value;
    return value;
  });
}

TEST(Histogram, CountsEachValueInItsBinAndTheMaximumInTheLast) {
  const Histogram histogram = histogramOf(staircase(), 9);  // from 0 to 9: bins are 1 wide
  EXPECT_EQ(histogram.minimum, 0.0f);
  EXPECT_EQ(histogram.maximum, 9.0f);
  const std::vector<std::uint64_t> expected{6, 12, 18, 24, 30, 36, 42, 48, 54 + 60};
  EXPECT_EQ(histogram.counts, expected);
}

TEST(Histogram, TheBinOfARankHasTheValueWithSoManyUpToIt) {
  const Histogram histogram = histogramOf(staircase(), 9);
  EXPECT_EQ(histogram.count(), 330u);
  for (const auto& [rank, bin] : {std::pair(0.0, 0u), {6.0, 0u}, {6.5, 1u}, {18.0, 1u}, {19.0, 2u}, {330.0, 8u}, {1e9, 8u}})
    EXPECT_EQ(histogram.binOfRank(rank), bin) << rank;
}

TEST(Histogram, LeavesOutWhatIsInactive) {
  const Volume volume = makeVolume({40, 1, 1}, glm::dmat4(1.0),
                                   [](int x, int, int) { return x % 4 == 0 ? float(x) : kInactiveVoxel; });
  const Histogram histogram = histogramOf(volume, 4);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t(0)), 10u);
}

TEST(Histogram, OfAUniformOrEmptyVolumeIsThere) {
  const Volume uniform = makeVolume({4, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return 0.5f; });
  EXPECT_EQ(histogramOf(uniform, 3).counts, (std::vector<std::uint64_t>{64, 0, 0}));
  const Volume empty = makeVolume({4, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return kInactiveVoxel; });
  EXPECT_EQ(histogramOf(empty, 2).counts, (std::vector<std::uint64_t>{0, 0}));
}

TEST(Histogram, OfAnIntervalIsItsFullestBin) {
  const Histogram histogram = histogramOf(staircase(), 9);
  EXPECT_EQ(histogram.countBetween(2.2, 4.7), 30u);
  EXPECT_EQ(histogram.countBetween(4.2, 4.3), 30u);
  EXPECT_EQ(histogram.countBetween(-10.0, 0.5), 6u);
  EXPECT_EQ(histogram.countBetween(8.5, 100.0), 114u);
  EXPECT_EQ(histogram.countBetween(-3.0, -1.0), 0u);
  EXPECT_EQ(histogram.countBetween(9.1, 11.0), 0u);
}

}  // namespace
}  // namespace freevoxels
