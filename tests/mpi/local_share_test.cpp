#include "apps/mpi/local_share.h"

#include <gtest/gtest.h>

namespace freevoxels {
namespace {

TEST(LocalShare, RanksDivideTheProcessorsOfTheirNode) {
  EXPECT_EQ(threadsOfRank(64, 64, 1), 64);
  EXPECT_EQ(threadsOfRank(64, 64, 4), 16);
  EXPECT_EQ(threadsOfRank(64, 64, 5), 12) << "rounded down: no thread waits for another";
  EXPECT_EQ(threadsOfRank(2, 2, 7), 1) << "more ranks than processors";
}

TEST(LocalShare, ABoundRankTakesNoMoreThanItMayUse) {
  EXPECT_EQ(threadsOfRank(64, 8, 4), 8) << "bound to half of its part";
  EXPECT_EQ(threadsOfRank(64, 16, 4), 16) << "bound to its part";
  EXPECT_EQ(threadsOfRank(16, 0, 4), 1) << "an unknown binding";
}

TEST(LocalShare, RanksTakeTheGpusOfTheirNodeInTurn) {
  const std::vector<std::string> gpus{"a", "b"};
  for (const auto& [rank, gpu] : {std::pair(0, "a"), {1, "b"}, {2, "a"}, {7, "b"}}) EXPECT_EQ(gpuOfRank(gpus, rank), gpu);
  EXPECT_EQ(gpuOfRank({}, 3), "") << "then lavapipe draws";
}

}  // namespace
}  // namespace freevoxels
