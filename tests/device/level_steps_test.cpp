// The small levels at the top of the octree, which GPUs compute in one dispatch: against a dispatch for each.

#include <algorithm>
#include <array>
#include <vector>

#include "engine/octree/level_steps.h"
#include "engine/octree/medium_levels.h"
#include "engine/octree/occupancy.h"
#include "engine/octree/volume_builder.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

class LevelStepsTest : public DeviceTest {
 protected:
  /// With emission, and with colours of its own.
  static BuiltVolume buildFire() {
    Volume fire = makeProcedural("fire", 48);
    cropToActive(fire);
    Classification classification = coloured(fire, 0.4f);
    classification.emission = Emission{.strength = 8.0};
    std::vector<StageTime> times;
    return buildVolume(device(), fire, classification, times);
  }

  static std::vector<std::byte> bytesOf(const Buffer& buffer, std::size_t begin, std::size_t end) {
    std::vector<std::byte> bytes(end - begin);
    download(device(), buffer, bytes, begin);
    return bytes;
  }

  static std::vector<shader::OccupancyWord> wordsOf(const Buffer& occupancy) {
    std::vector<shader::OccupancyWord> words(occupancy.bytes() / sizeof(shader::OccupancyWord));
    download(device(), occupancy, std::as_writable_bytes(std::span(words)));
    return words;
  }

  /// Overwrites a buffer from byte `first` on.
  static void clearFrom(const Buffer& buffer, std::size_t first) {
    std::vector<std::byte> bytes = bytesOf(buffer, 0, buffer.bytes());
    std::fill(bytes.begin() + std::ptrdiff_t(first), bytes.end(), std::byte(0));
    upload(device(), buffer, bytes);
  }

  template <typename Record>
  static void run(const Record& record) {
    Commands commands(device());
    record(commands);
    commands.submitAndWait();
  }
};

TEST_F(LevelStepsTest, SmallLevelsAreOneRangeOnGpus) {
  const HierarchyLayout hierarchy({300, 200, 100});
  const auto single = levelRanges(hierarchy, LevelDispatches::Single), joined = levelRanges(hierarchy, LevelDispatches::Joined);
  EXPECT_EQ(int(single.size()), hierarchy.top());
  ASSERT_LT(joined.size(), single.size());
  for (std::size_t i = 0; i < joined.size(); ++i) {
    EXPECT_EQ(joined[i].first, int(i) + 1);
    EXPECT_EQ(joined[i].end, i + 1 < joined.size() ? int(i) + 2 : hierarchy.top() + 1);
    EXPECT_EQ(hierarchy.words(joined[i].first) <= kSmallLevelWords, i + 1 == joined.size());
  }
  EXPECT_EQ(levelRanges(HierarchyLayout({4, 4, 4}), LevelDispatches::Joined).front().end, 2);
}

TEST_F(LevelStepsTest, OneDispatchMarksTheBlocksThatSingleOnesMark) {
  const BuiltVolume built = buildFire();
  const int first = levelRanges(built.volume.hierarchy, LevelDispatches::Joined).back().first;
  ASSERT_LT(first, built.volume.hierarchy.top());
  const auto expected = wordsOf(built.volume.occupancy);
  clearFrom(built.volume.occupancy,
            built.volume.hierarchy.first[std::size_t(first)] / shader::kBlocksPerWord * sizeof(shader::OccupancyWord));
  ASSERT_NE(wordsOf(built.volume.occupancy).back().mask, expected.back().mask);
  const OccupancyPass occupancy(device(), true, LevelDispatches::Joined);
  run([&](Commands& commands) { occupancy.recordBlocks(commands, built.volume, built.lists.steps); });
  const auto words = wordsOf(built.volume.occupancy);
  for (std::size_t i = 0; i < words.size(); ++i) ASSERT_EQ(words[i].mask, expected[i].mask) << i;
}

TEST_F(LevelStepsTest, OneDispatchStoresTheBitsOfTheMediumThatSingleOnesStore) {
  const BuiltVolume built = buildFire();
  const DeviceVolume& volume = built.volume;
  ASSERT_TRUE(volume.hasEmission() && volume.hasColors);
  const int first = levelRanges(volume.hierarchy, LevelDispatches::Joined).back().first;
  ASSERT_LT(first, volume.hierarchy.top());
  const std::uint64_t rank = volume.firstRank(first), last = volume.storedBlocks(), colored = volume.firstRank(1);
  struct Store {
    const Buffer& buffer;
    std::size_t begin, end;  // bytes of the levels of the joined dispatch
  };
  const std::array<Store, 3> stores{{{volume.extinction, rank * sizeof(float), last * sizeof(float)},
                                     {volume.emission, rank * sizeof(std::uint32_t), last * sizeof(std::uint32_t)},
                                     {volume.blockColors, (rank - colored) * sizeof(glm::uvec2), (last - colored) * sizeof(glm::uvec2)}}};
  std::vector<std::vector<std::byte>> expected;
  for (const auto& [buffer, begin, end] : stores) {
    expected.push_back(bytesOf(buffer, begin, end));
    clearFrom(buffer, begin);
    ASSERT_NE(bytesOf(buffer, begin, end), expected.back());
  }
  const MediumLevels medium(device(), volume, LevelDispatches::Joined);
  run([&](Commands& commands) { medium.record(commands, volume, built.lists.steps); });
  for (std::size_t i = 0; i < stores.size(); ++i)
    EXPECT_TRUE(bytesOf(stores[i].buffer, stores[i].begin, stores[i].end) == expected[i]) << i;
}

}  // namespace
}  // namespace freevoxels
