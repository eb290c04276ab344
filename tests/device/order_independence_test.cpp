// What the whole method rests on: every voxel may be drawn alone, in any order, in any group.

#include <algorithm>
#include <random>

#include "engine/core/error.h"
#include "engine/splatting/splat_pass.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

/// The sums of one pixel: C, E and T.
struct Sums {
  glm::dvec4 colorEnergy{0.0};
  double opticalDepth = 0.0;
};

class OrderIndependenceTest : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    const Volume volume = randomVolume({24, 20, 22}, cubeTransform({24, 20, 22}), 0.6, 25.0);
    const Classification classification{.densityScale = 1.0};
    volume_ = uploadVolume(device(), volume, classification);
    table_ = makeTable(device(), volume_.layout, {});
    visible_ = makeVisibleVoxels(device(), volume_);
    camera_ = framingCamera(volume, 35.0, 25.0, 1.0, {});
    Commands commands(device());
    const ClassifyPass classify(device());
    const AttenuationSweep sweep(device(), table_.settings);
    const CompactionPass compaction(device());
    classify.record(commands, volume_, classification);
    sweep.record(commands, volume_, table_);
    compaction.record(commands, volume_, visible_);
    commands.submitAndWait();
    voxels_.resize(downloadVisibleCount(device(), visible_));
    download(device(), visible_.indices, std::as_writable_bytes(std::span(voxels_)));
  }

  /// Draws just these voxels, in this order.
  std::vector<Sums> draw(const std::vector<std::uint32_t>& voxels) {
    const auto count = std::uint32_t(voxels.size());
    const shader::ChunkArguments chunk{.groupsX = (count + shader::kSplatThreads - 1) / shader::kSplatThreads,
                                       .groupsY = 1,
                                       .groupsZ = 1,
                                       .splatCount = count,
                                       .vertexCount = count,
                                       .instanceCount = 1,
                                       .quadVertexCount = 4,
                                       .quadInstanceCount = count};
    upload(device(), visible_.indices, std::as_bytes(std::span(voxels)));
    upload(device(), visible_.chunks, std::as_bytes(std::span(&chunk, 1)));
    const FrameSettings settings{.size = {80, 80}};
    const SplatTargets targets = makeTargets(device(), settings);
    SplatPass splats(device(), false);
    const std::size_t pixels = std::size_t(settings.size.x) * std::size_t(settings.size.y);
    const Buffer color(device(), pixels * sizeof(glm::vec4), MemoryUse::Readback, "C, E");
    const Buffer depth(device(), pixels * sizeof(float), MemoryUse::Readback, "T");
    Commands commands(device());
    splats.record(commands, {volume_, table_, visible_},
                  makeFrameConstants(device(), volume_, table_.settings, camera_, settings), targets);
    commands.copy(targets.colorEnergy, color);
    commands.copy(targets.opticalDepth, depth);
    commands.submitAndWait();
    std::vector<Sums> sums(pixels);
    const auto* colors = reinterpret_cast<const glm::vec4*>(color.mapped());
    const auto* depths = reinterpret_cast<const float*>(depth.mapped());
    for (std::size_t i = 0; i < pixels; ++i) sums[i] = {glm::dvec4(colors[i]), double(depths[i])};
    return sums;
  }

  /// Largest difference in C, E and T relative to the largest value of each.
  static double difference(const std::vector<Sums>& a, const std::vector<Sums>& b) {
    double most = 0.0, color = 0.0, depth = 0.0, mostDepth = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (int c = 0; c < 4; ++c) {
        most = std::max(most, a[i].colorEnergy[c]);
        color = std::max(color, std::abs(a[i].colorEnergy[c] - b[i].colorEnergy[c]));
      }
      mostDepth = std::max(mostDepth, a[i].opticalDepth);
      depth = std::max(depth, std::abs(a[i].opticalDepth - b[i].opticalDepth));
    }
    FV_CHECK_LT(0.0, most);
    return std::max(color / most, depth / mostDepth);
  }

  DeviceVolume volume_;
  AttenuationTable table_;
  VisibleVoxels visible_;
  Camera camera_;
  std::vector<std::uint32_t> voxels_;
};

TEST_F(OrderIndependenceTest, PermutingTheDrawOrderChangesOnlyRounding) {
  const std::vector<Sums> ordered = draw(voxels_);
  std::vector<std::uint32_t> permuted = voxels_;
  std::shuffle(permuted.begin(), permuted.end(), std::mt19937(3));
  EXPECT_LE(difference(ordered, draw(permuted)), 2e-6);
  std::ranges::reverse(permuted = voxels_);
  EXPECT_LE(difference(ordered, draw(permuted)), 2e-6);
}

TEST_F(OrderIndependenceTest, RandomGroupsDrawnAloneAddUpToTheWhole) {
  const std::vector<Sums> whole = draw(voxels_);
  for (unsigned groups : {2u, 5u}) {
    std::vector<std::vector<std::uint32_t>> parts(groups);
    std::mt19937 generator(groups);
    for (std::uint32_t voxel : voxels_) parts[generator() % groups].push_back(voxel);
    std::vector<Sums> total(whole.size());
    for (const auto& part : parts) {
      const std::vector<Sums> sums = draw(part);
      for (std::size_t i = 0; i < total.size(); ++i) {
        total[i].colorEnergy += sums[i].colorEnergy;
        total[i].opticalDepth += sums[i].opticalDepth;
      }
    }
    EXPECT_LE(difference(whole, total), 1e-5);
  }
}

TEST_F(OrderIndependenceTest, ADroppedVoxelIsNoticed) {
  std::vector<std::uint32_t> fewer = voxels_;
  fewer.erase(fewer.begin() + std::ptrdiff_t(fewer.size() / 2));
  EXPECT_GE(difference(draw(voxels_), draw(fewer)), 1e-5);
}

}  // namespace
}  // namespace freevoxels
