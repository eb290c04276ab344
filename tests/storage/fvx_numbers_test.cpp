// Files whose checksums are right and whose numbers contradict each other: none of these numbers is used.

#include <limits>

#include "tests/storage/edited_fvx.h"

namespace freevoxels {
namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::FvxFile;
using fvx::Section;
using fvx::SectionKind;
using test::FvxEditor;

class FvxNumbers : public test::EditedFvx {};

TEST_F(FvxNumbers, ABrickThatIsMovedOutOfTheBoxIsRefusedWhereverItGoes) {
  int moved = 0;
  for (const glm::ivec3 size : test::kBakedSizes)
    for (const BakeSettings& settings : test::kBakeSettings) {
      bake(test::denseVolume(size), settings);
      const FvxFile whole(file_);
      for (int level = 0; level < whole.levels(); ++level)
        for (std::size_t i = 0; i < whole.chunks(Channel::Scalars, level).size(); ++i) {
          const ChunkEntry chunk = whole.chunks(Channel::Scalars, level)[i];
          for (int brick = 0; brick < fvx::kChunkBricks; brick += 5) {
            if (glm::all(glm::lessThan(chunk.brickCell(brick) * ScalarBricks::kEdge, whole.dimensions(level)))) continue;
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
    bake(test::denseVolume(size));
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
  for (const float value : {test::kFloatNan, test::kFloatInfinity, -test::kFloatInfinity}) {
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

TEST_F(FvxNumbers, AChunkThatIsTheMeanOfNothingIsRefused) {
  bake(test::denseVolume({70, 41, 37}));
  for (const int level : {0, 1}) {
    FvxEditor edited(bytes_);
    Section& index = *edited.section(SectionKind::ChunkIndex, Channel::Scalars, level);
    index.bytes = sizeof(ChunkEntry);  // of the first chunk alone
    if (level == 1) {
      // The only chunk of level 2 is the mean of the first one of level 1: chunks of level 0 may lack theirs, as where it underflows.
      edited.save(file_);
      readAll();
      continue;
    }
    expectRefused(edited, "is the mean of nothing");
  }
}

TEST_F(FvxNumbers, ContentCellsThatAreNotThoseOfTheBoxAreRefused) {
  for (const glm::ivec3 size : {glm::ivec3(70, 41, 37), glm::ivec3(200, 3, 1)}) {
    bake(test::denseVolume(size));
    const auto expectContentRefused = [&](const auto& change) {
      FvxEditor edited(bytes_);
      change(*reinterpret_cast<fvx::ContentHeader*>(edited.valuesOf<char>(*edited.section(SectionKind::ContentCells)).data()));
      expectRefused(edited, "content cells");
    };
    for (const double edge : {test::kNan, test::kInfinity, 0.0, -1.0, 1e-300, 1e300, 20.0, 0.1})
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

}  // namespace
}  // namespace freevoxels
