// Files whose checksums are right and whose numbers contradict each other: none of these numbers is used.

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "engine/storage/baked_box.h"
#include "engine/storage/baked_volume.h"
#include "tests/refusal.h"
#include "tests/storage/baked_fixture.h"
#include "tests/storage/fvx_editor.h"

namespace freevoxels {
namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::FvxFile;
using fvx::RegionEntry;
using fvx::Section;
using fvx::SectionKind;
using test::FvxEditor;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Ends inside of bricks and chunks along every axis, with one level, with two and with three.
constexpr glm::ivec3 kSizes[]{{1, 1, 1}, {9, 31, 8}, {38, 26, 31}, {33, 65, 9}, {70, 41, 37}, {7, 34, 67}};

constexpr BakeSettings kSettings[]{{}, {.compress = true}, {.keepScalars = true}, {.keepScalars = true, .compress = true}};

class FvxNumbers : public testing::Test {
 protected:
  void bake(const Volume& volume, const BakeSettings& settings = {}, const Classification& classification = {.densityScale = 0.7}) {
    bakeVolume(file_, volume, classification, settings);
    bytes_ = test::readBytes(file_);
  }
  /// Everything that is read of a file anywhere.
  void readAll() const {
    const auto file = std::make_shared<const FvxFile>(file_);
    for (int level = 0; level < file->levels(); ++level) {
      readBaked(file, level);
      readBakedBox(*file, level, {.first = glm::ivec3(0), .end = file->dimensions(level)});
      for (const RegionEntry& region : file->regions(level)) readBakedRegion(*file, region);
    }
    file->checkAll();
  }
  /// Refused before anything but the description and the indices is read.
  void expectRefused(FvxEditor& edited, const std::string& what = "a.fvx") const {
    edited.save(file_);
    test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx", what});
  }
  template <typename Change>
  void expectChunkRefused(const Change& change, const std::string& what, Channel channel = Channel::Scalars, int level = 0) const {
    FvxEditor edited(bytes_);
    for (std::size_t i = 0; i < edited.chunks(level, channel).size(); ++i) {
      FvxEditor one(bytes_);
      change(one.chunks(level, channel)[i]);
      SCOPED_TRACE(i);
      expectRefused(one, what);
    }
  }
  /// Sound when it is opened; refused by whatever reads values.
  void expectValuesRefused(FvxEditor& edited, int level, const std::string& what) const {
    edited.save(file_);
    const auto file = std::make_shared<const FvxFile>(file_);
    test::expectRefusal([&] { readBaked(file, level); }, ErrorKind::Input, {"a.fvx", what});
    test::expectRefusal([&] { readBakedBox(*file, level, {.first = glm::ivec3(0), .end = file->dimensions(level)}); }, ErrorKind::Input, {"a.fvx", what});
    test::expectRefusal([&] { file->checkAll(); }, ErrorKind::Input, {"a.fvx", what});
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.fvx";
  std::string bytes_;
};

/// Everywhere.
Volume denseVolume(glm::ivec3 size) {
  return makeVolume(size, glm::dmat4(glm::dmat3(0.25)), [](int x, int y, int z) { return 0.1 + 0.01 * ((x + 2 * y + 3 * z) % 50); });
}

glm::ivec3 firstVoxelOf(const ChunkEntry& chunk, int brick) {
  return chunk.cell * fvx::kChunkEdge + ScalarBricks::kEdge * glm::ivec3(brick % 4, brick / 4 % 4, brick / 16);
}

TEST_F(FvxNumbers, SoundFilesOfAllSizesAndKindsAreReadInEveryWay) {
  for (const glm::ivec3 size : kSizes)
    for (const BakeSettings& settings : kSettings) {
      bake(denseVolume(size), settings);
      readAll();
      bake(test::smoothVolume(size), settings);
      readAll();
      TransferFunction function{.opacity = {{0.1f, 0.0f}, {0.9f, 0.5f}}, .color = {{0.0f, glm::vec3(1, 0, 0.25f)}}};
      bake(denseVolume(size), settings, {.transferFunction = function});
      readAll();
    }
  for (const BakeSettings& settings : kSettings) {
    bake(test::volumeOfAllChannels(), settings);
    readAll();
    bake(test::volumeOfAllChannels(), settings, {.emission = Emission{}});
    readAll();
  }
}

TEST_F(FvxNumbers, ABrickThatIsMovedOutOfTheBoxIsRefusedWhereverItGoes) {
  int moved = 0;
  for (const glm::ivec3 size : kSizes)
    for (const BakeSettings& settings : kSettings) {
      bake(denseVolume(size), settings);
      const FvxFile whole(file_);
      for (int level = 0; level < whole.levels(); ++level)
        for (std::size_t i = 0; i < whole.chunks(Channel::Scalars, level).size(); ++i) {
          const ChunkEntry chunk = whole.chunks(Channel::Scalars, level)[i];
          for (int brick = 0; brick < fvx::kChunkBricks; brick += 5) {
            if (glm::all(glm::lessThan(firstVoxelOf(chunk, brick), whole.dimensions(level)))) continue;
            FvxEditor edited(bytes_);
            std::uint64_t& mask = edited.chunks(level)[i].brickMask;
            mask = (mask & (mask - 1)) | std::uint64_t(1) << brick;  // as many as before
            expectRefused(edited, "a brick of it is beyond the volume's box");
            ++moved;
          }
        }
    }
  EXPECT_GT(moved, 500);
}

TEST_F(FvxNumbers, AMaskOfNoBricksOrOfAnotherNumberOfThemIsRefused) {
  bake(test::smoothVolume());
  for (int level = 0; level < 3; ++level) {
    expectChunkRefused([](ChunkEntry& chunk) { chunk.brickMask = 0; }, "it has no bricks", Channel::Scalars, level);
    expectChunkRefused([](ChunkEntry& chunk) { chunk.brickMask &= chunk.brickMask - 1; }, "", Channel::Scalars, level);
    expectChunkRefused([](ChunkEntry& chunk) { chunk.bytes += 1; }, "", Channel::Scalars, level);
  }
}

TEST_F(FvxNumbers, ChunksOutOfOrderTwiceOrBeyondTheBoxAreRefused) {
  for (const glm::ivec3 size : {glm::ivec3(70, 41, 37), glm::ivec3(33, 65, 9)}) {
    bake(denseVolume(size));
    const std::size_t count = FvxEditor(bytes_).chunks().size();
    ASSERT_GT(count, 2u);
    for (std::size_t i = 0; i + 1 < count; ++i) {
      FvxEditor swapped(bytes_), twice(bytes_), beyond(bytes_), before(bytes_);
      std::swap(swapped.chunks()[i], swapped.chunks()[i + 1]);
      expectRefused(swapped, "not in the order");
      twice.chunks()[i + 1] = twice.chunks()[i];
      expectRefused(twice, "there are two of it");
      beyond.chunks()[i].cell.y = 3;
      expectRefused(beyond, "beyond the volume's box");
      before.chunks()[i].cell.z = -1;
      expectRefused(before, "beyond the volume's box");
    }
  }
}

TEST_F(FvxNumbers, PlacesSizesAndCodecsOfChunksAreRefusedUnlessTheyAreInTheirSection) {
  for (const bool compress : {false, true}) {
    bake(test::smoothVolume(), {.compress = compress});
    for (const std::uint64_t offset : {std::uint64_t(0), std::uint64_t(4096), std::uint64_t(1) << 40, ~std::uint64_t(63)})
      expectChunkRefused([&](ChunkEntry& chunk) { chunk.offset = offset; }, "not stored where it should be");
    expectChunkRefused([](ChunkEntry& chunk) { chunk.offset += 1; }, "not stored where it should be");
    for (const std::uint64_t bytes : {std::uint64_t(1) << 40, ~std::uint64_t(0)})
      expectChunkRefused([&](ChunkEntry& chunk) { chunk.storedBytes = bytes; }, "not stored where it should be");
    expectChunkRefused([](ChunkEntry& chunk) { chunk.codec = fvx::Codec(2); }, "not stored where it should be");
  }
}

TEST_F(FvxNumbers, RangesAndCountsOfChunksAreRefusedUnlessTheyCanBe) {
  bake(test::smoothVolume(), {.keepScalars = true});
  for (const float value : {kNaN, kInf, -kInf}) {
    expectChunkRefused([&](ChunkEntry& chunk) { chunk.minimum = value; }, "range");
    expectChunkRefused([&](ChunkEntry& chunk) { chunk.maximum = value; }, "range");
    expectChunkRefused([&](ChunkEntry& chunk) { chunk.leastExtinction = value; }, "range");
    expectChunkRefused([&](ChunkEntry& chunk) { chunk.mostExtinction = value; }, "range", Channel::Scalars, 1);
  }
  expectChunkRefused([](ChunkEntry& chunk) { chunk.minimum = chunk.maximum + 1.0f; }, "range");
  expectChunkRefused([](ChunkEntry& chunk) { chunk.leastExtinction = -1.0f; }, "range");
  expectChunkRefused([](ChunkEntry& chunk) { chunk.maximum = 1000.0f; }, "exceed the range");
  expectChunkRefused([](ChunkEntry& chunk) { chunk.minimum = -1000.0f; }, "exceed the range", Channel::Scalars, 2);
  expectChunkRefused([](ChunkEntry& chunk) { chunk.activeVoxels = std::uint32_t(chunk.bricks()) * 512 + 1; }, "counts more voxels");
  expectChunkRefused([](ChunkEntry& chunk) { chunk.activeVoxels = ~std::uint32_t(0); }, "counts more voxels");
}

TEST_F(FvxNumbers, ACountOrARangeThatIsNotThatOfTheValuesIsFoundByACheckOfTheWholeFile) {
  for (const bool compress : {false, true}) {
    bake(test::smoothVolume(), {.keepScalars = true, .compress = compress});
    const auto expectFound = [&](const auto& change) {
      for (const int level : {0, 1}) {
        FvxEditor edited(bytes_);
        change(edited.chunks(level)[0]);
        edited.save(file_);
        test::expectRefusal([&] { FvxFile(file_).checkAll(); }, ErrorKind::Input, {"a.fvx", "other values than its entry"});
      }
    };
    expectFound([](ChunkEntry& chunk) { chunk.activeVoxels -= 1; });
    expectFound([](ChunkEntry& chunk) { chunk.minimum = std::nextafter(chunk.minimum, chunk.maximum); });
    expectFound([](ChunkEntry& chunk) { chunk.maximum = std::nextafter(chunk.maximum, chunk.minimum); });
  }
}

TEST_F(FvxNumbers, ValuesThatAreNaNOrInfiniteAreRefusedWhereverTheyAre) {
  bake(denseVolume({38, 26, 31}), {.keepScalars = true});
  for (const int level : {0, 1})
    for (const float value : {kNaN, -kNaN, kInf, -kInf})
      for (const bool last : {false, true}) {
        FvxEditor edited(bytes_);
        const std::span<float> values = edited.storedValues<float>(edited.chunks(level).back());
        (last ? values.back() : values.front()) = value;
        expectValuesRefused(edited, level, "NaN or infinite");
      }
  bake(denseVolume({38, 26, 31}));
  for (const int half : {0x7c00, 0xfc00, 0x7c01, 0x7fff, 0xfe00}) {
    FvxEditor edited(bytes_);
    edited.storedValues<std::uint16_t>(edited.chunks().front())[100] = std::uint16_t(half);
    expectValuesRefused(edited, 0, "NaN or infinite");
  }
}

TEST_F(FvxNumbers, ValuesBeyondTheBoxAreRefused) {
  for (const bool keepScalars : {false, true})
    for (const glm::ivec3 size : {glm::ivec3(38, 26, 31), glm::ivec3(33, 65, 9), glm::ivec3(1, 1, 1)}) {
      bake(denseVolume(size), {.keepScalars = keepScalars});
      for (int level = 0; level < FvxFile(file_).levels(); ++level) {
        FvxEditor edited(bytes_);
        const ChunkEntry last = edited.chunks(level).back();
        // The last voxel of the last brick is beyond a box that ends inside of it.
        if (keepScalars)
          edited.storedValues<float>(last).back() = 0.5f;
        else
          edited.storedValues<std::uint16_t>(last).back() = 0x3800;
        expectValuesRefused(edited, level, "beyond the volume's box");
      }
    }
}

TEST_F(FvxNumbers, ValuesBeyondTheRangeOfTheirChunkAreRefused) {
  for (const bool keepScalars : {false, true})
    for (const glm::ivec3 size : {glm::ivec3(38, 26, 31), glm::ivec3(33, 65, 9), glm::ivec3(1, 1, 1)}) {
      bake(denseVolume(size), {.keepScalars = keepScalars});
      for (int level = 0; level < FvxFile(file_).levels(); ++level)
        for (const bool below : {false, true}) {
          FvxEditor edited(bytes_);
          const ChunkEntry chunk = edited.chunks(level).back();
          if (keepScalars)
            edited.storedValues<float>(chunk).front() = below ? -1e20f : std::nextafter(chunk.maximum, 1.0f);
          else
            edited.storedValues<std::uint16_t>(chunk).front() = below ? 0xfbff : 0x7bff;  // the largest halves
          expectValuesRefused(edited, level, "other values than its entry");
        }
    }
}

/// Codes that mean other values than those that were written.
TEST_F(FvxNumbers, ScalesAndOffsetsThatDoNotFitTheRangesAreRefused) {
  const TransferFunction function{.opacity = {{0.1f, 0.0f}, {0.9f, 0.5f}}, .color = {{0.0f, glm::vec3(1, 0, 0.25f)}}};
  for (const bool isFunction : {false, true})
    for (const auto& [key, value] : {std::pair<const char*, double>{"/channels/0/scale", 1e10}, {"/channels/0/scale", 1.0}, {"/channels/0/offset", -1e6}}) {
      if (isFunction)
        bake(denseVolume({38, 26, 31}), {}, {.transferFunction = function});
      else
        bake(denseVolume({38, 26, 31}));
      FvxEditor edited(bytes_);
      nlohmann::json description = nlohmann::json::parse(edited.text(SectionKind::Description));
      const nlohmann::json::json_pointer place(key);
      if (!description.contains(place) || (!isFunction && std::string_view(key) == "/channels/0/offset")) continue;  // halves have none
      description[place] = value;
      edited.setText(SectionKind::Description, description.dump());
      SCOPED_TRACE(fmt::format("{} {}{}", key, value, isFunction ? " of a function's scalars" : ""));
      expectValuesRefused(edited, 0, "other values than its entry");
    }
}

TEST_F(FvxNumbers, AlbedosBeyondTheBoxWhichEarlierVersionsStoredAreLeftOut) {
  Volume volume = test::volumeOfAllChannels();
  bake(volume, {.keepScalars = true});
  FvxEditor edited(bytes_);
  const ChunkEntry& chunk = edited.chunks(0, Channel::Albedo).back();
  const std::span<float> values = edited.storedValues<float>(chunk);
  ASSERT_EQ(values.back(), kInactiveVoxel);
  values.back() = 0.5f;
  edited.save(file_);
  const auto file = std::make_shared<const FvxFile>(file_);
  file->checkAll();
  const Volume baked = readBaked(file);
  for (std::size_t c = 0; c < 3; ++c) test::expectSameVoxels(baked.albedo->values[c], volume.albedo->values[c]);
  const auto lastBrick = baked.albedo->values[2].bricks().back();
  EXPECT_EQ(lastBrick.back(), kInactiveVoxel);
}

TEST_F(FvxNumbers, AlbedosThatReachBeyondTheBoxAreNotStored) {
  Volume volume = test::volumeOfAllChannels();
  for (ScalarBricks& values : volume.albedo->values)
    for (ScalarBricks::Brick& brick : values.bricks()) brick.fill(0.25f);
  bake(volume, {.keepScalars = true});
  FvxEditor edited(bytes_);
  for (const ChunkEntry& chunk : edited.chunks(0, Channel::Albedo))
    for (int brick = 0, number = 0; brick < fvx::kChunkBricks; ++brick) {
      if ((chunk.brickMask >> brick & 1u) == 0) continue;
      const glm::ivec3 inside = glm::min(volume.dimensions - firstVoxelOf(chunk, brick), ScalarBricks::kEdge);
      const float last = edited.storedValues<float>(chunk)[std::size_t(number++) * 3 * 512 + 511];
      EXPECT_EQ(last, inside == glm::ivec3(ScalarBricks::kEdge) ? 0.25f : kInactiveVoxel);
    }
}

TEST_F(FvxNumbers, AChunkThatIsTheMeanOfNothingIsRefused) {
  bake(denseVolume({70, 41, 37}));
  for (const int level : {0, 1}) {
    FvxEditor edited(bytes_);
    Section& index = *edited.section(SectionKind::ChunkIndex, Channel::Scalars, level);
    index.bytes = sizeof(ChunkEntry);  // of the first chunk alone
    if (Section* const regions = edited.section(SectionKind::RegionIndex)) regions->kind = SectionKind(99);
    if (Section* const regions = edited.section(SectionKind::Regions)) regions->kind = SectionKind(98);
    if (level == 1) {
      // The only chunk of level 2 is the mean of the first one of level 1: chunks of level 0 may lack theirs, as where it underflows.
      edited.save(file_);
      readAll();
      continue;
    }
    expectRefused(edited, "is the mean of nothing");
  }
}

TEST_F(FvxNumbers, RegionsThatAreNotThoseOfTheChunksAreRefused) {
  bake(denseVolume({130, 70, 37}));
  const std::size_t count = FvxEditor(bytes_).regions().size();
  ASSERT_GT(count, 4u);
  const auto expectRegionRefused = [&](const auto& change) {
    for (std::size_t i = 0; i < count; ++i) {
      FvxEditor edited(bytes_);
      change(edited, i);
      SCOPED_TRACE(i);
      expectRefused(edited, "region");
    }
  };
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].level = 9; });
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].cell.x += 1; });
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].cell.z = -1; });
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].parts = ~std::uint64_t(0); });
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].parts ^= 1; });
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].offset = std::uint64_t(1) << 50; });
  expectRegionRefused([](FvxEditor& edited, std::size_t i) { edited.regions()[i].bytes += 2; });
  FvxEditor fewer(bytes_), twice(bytes_);
  fewer.section(SectionKind::RegionIndex)->bytes -= sizeof(RegionEntry);
  expectRefused(fewer, "region");
  // One more than there are, in the unused rest of the section's page.
  twice.section(SectionKind::RegionIndex)->bytes += sizeof(RegionEntry);
  twice.regions().back() = twice.regions()[count - 1];
  expectRefused(twice, "region");
}

TEST_F(FvxNumbers, AHaloWithValuesThatAreNaNIsRefused) {
  bake(denseVolume({130, 70, 37}), {.keepScalars = true});
  FvxEditor edited(bytes_);
  for (RegionEntry& region : edited.regions()) {
    if ((region.parts & fvx::kHaloPart) == 0) continue;
    region.parts = fvx::kHaloPart;
    const glm::ivec3 size(130, 70, 37);
    if (region.level != 0) continue;
    region.codec = fvx::Codec::None;
    region.bytes = region.storedBytes = fvx::haloVoxels(region.cell, size) * sizeof(float);
    const std::span<float> halo = edited.storedValues<float>(region);
    std::ranges::fill(halo, 0.5f);
    halo[7] = kNaN;
    break;
  }
  for (RegionEntry& region : edited.regions())
    if (region.codec != fvx::Codec::None) region.parts = 0, region.bytes = region.storedBytes = 0, region.codec = fvx::Codec::None;
  edited.save(file_);
  const FvxFile file(file_);
  int refused = 0;
  for (const RegionEntry& region : file.regions(0)) {
    if (region.bytes == 0) continue;
    test::expectRefusal([&] { readBakedRegion(file, region); }, ErrorKind::Input, {"a.fvx", "NaN or infinite"});
    ++refused;
  }
  EXPECT_EQ(refused, 1);
}

TEST_F(FvxNumbers, ContentCellsThatAreNotThoseOfTheBoxAreRefused) {
  for (const glm::ivec3 size : {glm::ivec3(70, 41, 37), glm::ivec3(200, 3, 1)}) {
    bake(denseVolume(size));
    const auto expectContentRefused = [&](const auto& change) {
      FvxEditor edited(bytes_);
      change(*reinterpret_cast<fvx::ContentHeader*>(edited.valuesOf<char>(*edited.section(SectionKind::ContentCells)).data()));
      expectRefused(edited, "content cells");
    };
    for (const double edge : {double(kNaN), double(kInf), 0.0, -1.0, 1e-300, 1e300, 20.0, 0.1})
      expectContentRefused([&](fvx::ContentHeader& content) { content.edge = edge; });
    for (const int cells : {0, -1, 1 << 30, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
      expectContentRefused([&](fvx::ContentHeader& content) { content.cells.y = cells; });
    expectContentRefused([&](fvx::ContentHeader& content) { content.cells.x = 1, content.cells.z = 64; });
  }
}

TEST_F(FvxNumbers, SectionsThatAreThereTwiceOrInTheSamePlaceAreRefused) {
  bake(test::smoothVolume());
  const auto expectSectionsRefused = [&](const auto& change, const std::string& what) {
    FvxEditor edited(bytes_);
    change(edited.header());
    expectRefused(edited, what);
  };
  expectSectionsRefused([](fvx::Header& header) { header.sections[header.sectionCount++] = header.sections[1]; }, "same place");
  expectSectionsRefused([](fvx::Header& header) { header.sections[2].offset = header.sections[0].offset; }, "same place");
  expectSectionsRefused([](fvx::Header& header) { header.sections[1].offset = 0; }, "same place");
  expectSectionsRefused(
      [](fvx::Header& header) {
        header.sections[header.sectionCount] = header.sections[1];
        header.sections[header.sectionCount].bytes = 0;
        ++header.sectionCount;
      },
      "twice");
}

/// A key of the description, as a JSON pointer, and values that it cannot have.
struct BadValues {
  const char* key;
  std::vector<nlohmann::json> values;
};

TEST_F(FvxNumbers, DescriptionsThatCannotBeAreRefusedInOneSentence) {
  const nlohmann::json number = 1e300, text = "text", none = nullptr, list = nlohmann::json::array(), half = 0.5;
  const std::vector<BadValues> bad{
      {"/dimensions/0", {0, -1, 8193, number, half, text, none, 4294967297LL}},
      {"/dimensions", {list, text, {1, 2}, {1, 2, 3, 4}}},
      {"/index_origin/1", {2147483647, 4294967296LL, number, half, text}},
      {"/index_to_world/0", {0.0, 1e-300, number, text, none}},
      {"/index_to_world/3", {1.0, number, 1e-3}},
      {"/index_to_world/13", {1e30, -1e20, number}},
      {"/index_to_world/15", {0.0, 2.0, -1.0, half}},
      {"/index_to_world", {list, {1, 2, 3}}},
      {"/up/1", {0.0, number, text}},
      {"/active_voxels", {-1, 1 << 30, half, 0, text, none}},
      {"/nan_voxels", {-1, 1 << 30, half}},
      {"/negative_voxels", {-1, 1 << 30}},
      {"/minimum", {number, 1e6, text, none}},
      {"/maximum", {-number.get<double>(), -1e6, text, none}},
      {"/level_set", {1, text, none}},
      {"/source", {1, none, list}},
      {"/channels", {list, 1, text}},
      {"/channels/0/number", {-1, 1, half, text}},
      {"/channels/0/encoding", {"float64", 1, "\x1b[31m"}},
      {"/channels/0/scale", {-1.0, text, none}},
      {"/channels/0/offset", {number, text}},
      {"/classification/density_scale", {-1.0, text, none}},
      {"/classification/albedo/2", {-0.1, 1.5, number, text}},
      {"/classification/fixed", {1, none}},
      {"/classification/emission", {{{"strength", 1.0}}, {{"strength", -1.0}, {"temperature_scale", 1.0}, {"temperature_offset", 0.0}}}},
      {"/classification/transfer_function",
       {list,
        {{"unit_distance", 0.0}, {"opacity", {{0.0, 0.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", list}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{0.0, 1.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{1.0, 0.5}, {0.0, 0.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{1e300, 0.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{0.0, 0.5}}}, {"color", {{0.0, 1.0, 1.0}}}}}},
      {"/temperature/minimum", {number, 1e6}},
      {"/temperature/active_voxels", {-1, 1 << 30, 0}},
      {"/temperature/nan_voxels", {-1, 1 << 30}},
      {"/albedo/clipped_voxels", {-1, half, text}},
      {"/albedo", {none, list}},
  };
  bake(test::volumeOfAllChannels());
  const nlohmann::json sound = nlohmann::json::parse(FvxEditor(bytes_).text(SectionKind::Description));
  for (const BadValues& bads : bad)
    for (const nlohmann::json& value : bads.values) {
      nlohmann::json changed = sound;
      changed[nlohmann::json::json_pointer(bads.key)] = value;
      if (std::string(bads.key) == "/classification/transfer_function") changed["classification"]["order"] = "pre";
      SCOPED_TRACE(fmt::format("{} {}", bads.key, value.dump(-1, ' ', true)));
      FvxEditor edited(bytes_);
      edited.setText(SectionKind::Description, changed.dump());
      expectRefused(edited);
    }
  for (const auto& [key, value] : sound.items()) {
    nlohmann::json changed = sound;
    changed.erase(key);
    FvxEditor edited(bytes_);
    edited.setText(SectionKind::Description, changed.dump());
    SCOPED_TRACE(key);
    expectRefused(edited);
  }
  FvxEditor same(bytes_);
  same.setText(SectionKind::Description, sound.dump(2));
  same.save(file_);
  readAll();
}

TEST_F(FvxNumbers, NamesInADescriptionBecomePrintable) {
  bake(test::volumeOfAllChannels());
  FvxEditor edited(bytes_);
  nlohmann::json json = nlohmann::json::parse(edited.text(SectionKind::Description));
  for (const char* key : {"/source", "/up_reason", "/temperature/name", "/albedo/name"})
    json[nlohmann::json::json_pointer(key)] = "\x1b[31m\x01grid\x02\x03 \u202e" + std::string(1000, 'x');
  edited.setText(SectionKind::Description, json.dump());
  edited.save(file_);
  const Volume volume = FvxFile(file_).description().volume;
  for (const std::string& name : {volume.source, volume.upReason, volume.temperature->name, volume.albedo->name}) {
    EXPECT_TRUE(name.starts_with("\\x1b[31m\\x01grid")) << name;
    EXPECT_LT(name.size(), 300u);
  }
}

TEST_F(FvxNumbers, DescriptionsThatAreNoJsonAndDescriptionsAndProvenancesThatAreTooDeepAreRefused) {
  bake(test::smoothVolume());
  const auto expectRefusedWith = [&](SectionKind kind, const std::string& text) {
    FvxEditor edited(bytes_);
    edited.setText(kind, text);
    expectRefused(edited);
  };
  for (const SectionKind kind : {SectionKind::Description, SectionKind::Provenance})
    for (const std::size_t depth : {std::size_t(65), std::size_t(66), std::size_t(1000), std::size_t(100000)}) {
      const std::string list = std::string(depth, '[') + "0" + std::string(depth, ']');
      for (const std::string& text : {list, "{\"a\":" + list + "}", std::string(depth + 1, '['), "[" + list + ",\x1b"}) expectRefusedWith(kind, text);
    }
  for (const char* text : {"", "{", "[[[", "\xff", "{\"a\": \"\x1b\"}"}) expectRefusedWith(SectionKind::Description, text);
}

TEST_F(FvxNumbers, AProvenanceMayBeAnyText) {
  bake(test::smoothVolume());
  for (const std::string& text : {std::string(), std::string("{"), std::string("\xff\x1b[31m"), std::string("{\"a\": \"\x1b\n\"}"), std::string(64, '[') + std::string(64, ']')}) {
    FvxEditor edited(bytes_);
    edited.setText(SectionKind::Provenance, text);
    edited.save(file_);
    EXPECT_EQ(FvxFile(file_).provenance(), text);
    readAll();
  }
}

/// What other programs do to a file that is open: the reader says so, and lives.
TEST_F(FvxNumbers, AFileThatIsCutOrOverwrittenWhileItIsOpenIsAnErrorAndNoSignal) {
  const std::string sentence = "was overwritten or cut while it was in use";
  for (const BakeSettings& settings : kSettings)
    for (const double part : {0.0, 0.1, 0.5, 0.95}) {
      bake(denseVolume({70, 41, 37}), settings);
      const auto file = std::make_shared<const FvxFile>(file_);
      const Volume before = readBaked(file);
      const float scalar = before.scalar(69, 40, 36);
      std::filesystem::resize_file(file_, std::uint64_t(part * double(bytes_.size())));
      EXPECT_EQ(before.scalar(69, 40, 36), scalar);  // what was read is still there
      test::expectRefusal([&] { file->checkAll(); }, ErrorKind::Input, {"a.fvx", sentence});
      int refused = 0;
      for (int level = 0; level < file->levels(); ++level) try {
          readBaked(file, level);  // of a part of the file that may be there
        } catch (const Error& error) {
          EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
          ++refused;
        }
      EXPECT_GE(refused, part == 0.0 ? file->levels() : part < 0.9 ? 1 : 0);
      for (const char byte : {'x', '\0'}) {
        test::writeBytes(file_, std::string(bytes_.size(), byte));
        test::expectRefusal([&] { readBaked(file); }, ErrorKind::Input, {"a.fvx", sentence});
        for (const RegionEntry& region : file->regions(0))
          test::expectRefusal([&] { readBakedRegion(*file, region); }, ErrorKind::Input, {"a.fvx", sentence});
      }
    }
}

TEST_F(FvxNumbers, AFileWhoseNameIsTakenByAnotherIsReadToItsEnd) {
  bake(denseVolume({70, 41, 37}));
  const auto file = std::make_shared<const FvxFile>(file_);
  const Volume before = readBaked(file);
  bake(test::smoothVolume({9, 9, 9}));
  test::expectSameVoxels(readBaked(file).scalars, before.scalars);
  std::filesystem::remove(file_);
  test::expectSameVoxels(readBaked(file).scalars, before.scalars);
}

}  // namespace
}  // namespace freevoxels
