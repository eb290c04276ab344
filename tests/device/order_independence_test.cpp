// What the whole method rests on: every voxel may be drawn alone, in any order, in any group.

#include <algorithm>
#include <random>

#include "engine/core/error.h"
#include "engine/validation/stepped_renderer.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

class OrderIndependenceTest : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    const Volume volume = randomVolume({24, 20, 22}, cubeTransform({24, 20, 22}), 0.6, 25.0);
    steps_ = prepareSteps(device(), volume, {.densityScale = 1.0}, {});
    camera_ = framingCamera(volume, 35.0, 25.0, 1.0, {});
  }

  /// Draws just these voxels, in this order.
  std::vector<SplatSums> draw(const std::vector<std::uint32_t>& voxels) const {
    return drawVoxels(device(), steps_, voxels, camera_, {.size = {80, 80}, .method = SplatSettings{}});
  }

  /// Largest difference in C, E and T relative to the largest value of each.
  static double difference(const std::vector<SplatSums>& a, const std::vector<SplatSums>& b) {
    double most = 0.0, color = 0.0, depth = 0.0, mostDepth = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const glm::dvec4 ofA(a[i].color, a[i].energy), ofB(b[i].color, b[i].energy);
      for (int c = 0; c < 4; ++c) {
        most = std::max(most, ofA[c]);
        color = std::max(color, std::abs(ofA[c] - ofB[c]));
      }
      mostDepth = std::max(mostDepth, a[i].depth);
      depth = std::max(depth, std::abs(a[i].depth - b[i].depth));
    }
    FV_CHECK_LT(0.0, most);
    return std::max(color / most, depth / mostDepth);
  }

  SteppedVolume steps_;
  Camera camera_;
};

TEST_F(OrderIndependenceTest, PermutingTheDrawOrderChangesOnlyRounding) {
  const std::vector<SplatSums> ordered = draw(steps_.voxels);
  std::vector<std::uint32_t> permuted = steps_.voxels;
  std::shuffle(permuted.begin(), permuted.end(), std::mt19937(3));
  EXPECT_LE(difference(ordered, draw(permuted)), 2e-6);
  std::ranges::reverse(permuted = steps_.voxels);
  EXPECT_LE(difference(ordered, draw(permuted)), 2e-6);
}

TEST_F(OrderIndependenceTest, RandomGroupsDrawnAloneAddUpToTheWhole) {
  const std::vector<SplatSums> whole = draw(steps_.voxels);
  for (unsigned groups : {2u, 5u}) {
    std::vector<std::vector<std::uint32_t>> parts(groups);
    std::mt19937 generator(groups);
    for (std::uint32_t voxel : steps_.voxels) parts[generator() % groups].push_back(voxel);
    std::vector<SplatSums> total(whole.size());
    for (const auto& part : parts) {
      const std::vector<SplatSums> sums = draw(part);
      for (std::size_t i = 0; i < total.size(); ++i) total[i] += sums[i];
    }
    EXPECT_LE(difference(whole, total), 1e-5);
  }
}

TEST_F(OrderIndependenceTest, ADroppedVoxelIsNoticed) {
  std::vector<std::uint32_t> fewer = steps_.voxels;
  fewer.erase(fewer.begin() + std::ptrdiff_t(fewer.size() / 2));
  EXPECT_GE(difference(draw(steps_.voxels), draw(fewer)), 1e-5);
}

}  // namespace
}  // namespace freevoxels
