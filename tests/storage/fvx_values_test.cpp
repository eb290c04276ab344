// Values of files whose checksums are right: sound ones are read in every way, others in none.

#include <cmath>

#include "tests/storage/edited_fvx.h"

namespace freevoxels {
namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::FvxFile;
using fvx::SectionKind;
using test::FvxEditor;

class FvxValues : public test::EditedFvx {};

TEST_F(FvxValues, SoundFilesOfAllSizesAndKindsAreReadInEveryWay) {
  for (const glm::ivec3 size : test::kBakedSizes)
    for (const BakeSettings& settings : test::kBakeSettings) {
      bake(test::denseVolume(size), settings);
      readAll();
      bake(test::smoothVolume(size), settings);
      readAll();
      TransferFunction function{.opacity = {{0.1f, 0.0f}, {0.9f, 0.5f}}, .color = {{0.0f, glm::vec3(1, 0, 0.25f)}}};
      bake(test::denseVolume(size), settings, {.transferFunction = function});
      readAll();
    }
  for (const BakeSettings& settings : test::kBakeSettings) {
    bake(test::volumeOfAllChannels(), settings);
    readAll();
    bake(test::volumeOfAllChannels(), settings, {.emission = Emission{}});
    readAll();
  }
}

fvx::ChunkValues chunkOfScalars(const Volume& volume, glm::ivec3 cell) {
  fvx::ChunkValues chunk{.cell = cell};
  std::vector<float>& values = chunk.channels[std::size_t(Channel::Scalars)];
  values.assign(fvx::kChunkVoxels, kInactiveVoxel);
  const glm::ivec3 first = cell * fvx::kChunkEdge, end = glm::min(volume.dimensions - first, fvx::kChunkEdge);
  for (glm::ivec3 v(0); v.z < end.z; ++v.z)
    for (v.y = 0; v.y < end.y; ++v.y)
      for (v.x = 0; v.x < end.x; ++v.x) values[fvx::ChunkValues::index(v)] = volume.scalars.at(first + v);
  return chunk;
}

/// They are stored as the nearest value in it; the ranges of chunks are those of the values before.
TEST_F(FvxValues, FilesWithValuesBeyondTheRangeOfTheirEncodingAreReadInEveryWay) {
  const auto functionFrom = [](float first) {
    return Classification{.transferFunction = TransferFunction{.opacity = {{first, 0.0f}, {first + 0.01f, 0.5f}}, .color = {{first, glm::vec3(1)}}}};
  };
  for (const glm::ivec3 size : test::kBakedSizes) {
    const Volume volume = test::denseVolume(size);
    for (const bool compress : {false, true}) {
      for (const double densityScale : {0.0, 1e-30, 1e5, 1e12, 1e40, 1e47}) {
        SCOPED_TRACE(densityScale);
        bake(volume, {.compress = compress}, {.densityScale = densityScale});
        readAll();
      }
      for (const float first : {-1.0f, 0.1f, 0.3f, 1.0f}) {  // values are from 0.1 to 0.59
        SCOPED_TRACE(first);
        bake(volume, {.compress = compress}, functionFrom(first));
        readAll();
      }
      // The range of a sample, as of procedural volumes.
      bakeStreamed(file_,
                   {.outline = {.source = "sampled", .dimensions = size},
                    .content = contentCells(volume, functionFrom(0.3f)),
                    .range = {0.3f, 0.31f},
                    .chunk = [&](glm::ivec3 cell) { return chunkOfScalars(volume, cell); }},
                   functionFrom(0.3f), {.compress = compress});
      readAll();
    }
  }
}

TEST_F(FvxValues, ACountOrARangeThatIsNotThatOfTheValuesIsFoundByACheckOfTheWholeFile) {
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

TEST_F(FvxValues, ValuesThatAreNaNOrInfiniteAreRefusedWhereverTheyAre) {
  bake(test::denseVolume({38, 26, 31}), {.keepScalars = true});
  for (const int level : {0, 1})
    for (const float value : {test::kFloatNan, -test::kFloatNan, test::kFloatInfinity, -test::kFloatInfinity})
      for (const bool last : {false, true}) {
        FvxEditor edited(bytes_);
        const std::span<float> values = edited.storedValues<float>(edited.chunks(level).back());
        (last ? values.back() : values.front()) = value;
        expectValuesRefused(edited, level, "NaN or infinite");
      }
  bake(test::denseVolume({38, 26, 31}));
  for (const int half : {0x7c00, 0xfc00, 0x7c01, 0x7fff, 0xfe00}) {
    FvxEditor edited(bytes_);
    edited.storedValues<std::uint16_t>(edited.chunks().front())[100] = std::uint16_t(half);
    expectValuesRefused(edited, 0, "NaN or infinite");
  }
}

TEST_F(FvxValues, ValuesBeyondTheBoxAreRefused) {
  for (const bool keepScalars : {false, true})
    for (const glm::ivec3 size : {glm::ivec3(38, 26, 31), glm::ivec3(33, 65, 9), glm::ivec3(1, 1, 1)}) {
      bake(test::denseVolume(size), {.keepScalars = keepScalars});
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

TEST_F(FvxValues, ValuesBeyondTheRangeOfTheirChunkAreRefused) {
  for (const bool keepScalars : {false, true})
    for (const glm::ivec3 size : {glm::ivec3(38, 26, 31), glm::ivec3(33, 65, 9), glm::ivec3(1, 1, 1)}) {
      bake(test::denseVolume(size), {.keepScalars = keepScalars});
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
TEST_F(FvxValues, ScalesAndOffsetsThatDoNotFitTheRangesAreRefused) {
  using Edit = std::pair<const char*, double>;
  const TransferFunction function{.opacity = {{0.1f, 0.0f}, {0.9f, 0.5f}}, .color = {{0.0f, glm::vec3(1, 0, 0.25f)}}};
  for (const bool isFunction : {false, true})
    for (const auto& [key, value] : {Edit("/channels/0/scale", 1e10), Edit("/channels/0/scale", 1.0), Edit("/channels/0/offset", -1e6)}) {
      if (isFunction)
        bake(test::denseVolume({38, 26, 31}), {}, {.transferFunction = function});
      else
        bake(test::denseVolume({38, 26, 31}));
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

TEST_F(FvxValues, AlbedosBeyondTheBoxWhichEarlierVersionsStoredAreLeftOut) {
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
  const auto lastBrick = baked.albedo->values[2].brick(baked.albedo->values[2].count() - 1);
  EXPECT_EQ(lastBrick.back(), kInactiveVoxel);
}

TEST_F(FvxValues, AlbedosThatReachBeyondTheBoxAreNotStored) {
  Volume volume = test::volumeOfAllChannels();
  for (ScalarBricks& values : volume.albedo->values)
    for (ScalarBricks::Brick& brick : values.editable()) brick.fill(0.25f);
  bake(volume, {.keepScalars = true});
  FvxEditor edited(bytes_);
  for (const ChunkEntry& chunk : edited.chunks(0, Channel::Albedo))
    for (int brick = 0, number = 0; brick < fvx::kChunkBricks; ++brick) {
      if (!chunk.hasBrick(brick)) continue;
      const glm::ivec3 inside = glm::min(volume.dimensions - chunk.brickCell(brick) * ScalarBricks::kEdge, ScalarBricks::kEdge);
      const float last = edited.storedValues<float>(chunk)[std::size_t(number++) * 3 * 512 + 511];
      EXPECT_EQ(last, inside == glm::ivec3(ScalarBricks::kEdge) ? 0.25f : kInactiveVoxel);
    }
}

}  // namespace
}  // namespace freevoxels
