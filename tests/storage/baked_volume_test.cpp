#include "engine/storage/baked_volume.h"
#include "engine/storage/baked_source.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "engine/storage/procedural_stream.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_parts.h"
#include "tests/limited_disk.h"
#include "tests/refusal.h"
#include "tests/storage/baked_fixture.h"
#include "tests/temporary_folder.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::FvxFile;

const Classification kDense{.densityScale = 0.7, .albedo = glm::vec3(0.3f, 0.5f, 0.9f)};

Classification banded() {
  TransferFunction function{.unitDistance = 0.3};
  function.opacity = {{0.1f, 0.0f}, {0.9f, 0.5f}, {1.7f, 0.1f}};
  function.color = {{0.0f, glm::vec3(1, 0, 0)}, {2.0f, glm::vec3(0, 1, 0.25f)}};
  return {.transferFunction = function, .order = ClassificationOrder::Pre};
}

TEST(BakedVolume, KeptScalarsTemperaturesAndAlbedosAreTheSameBits) {
  const test::TemporaryFolder folder;
  const Volume volume = test::volumeOfAllChannels();
  for (const bool compress : {false, true}) {
    const Volume baked =
        test::bakedAndRead(folder / "a.fvx", volume, kDense, {.keepScalars = true, .compress = compress});
    test::expectSameVoxels(baked.scalars, volume.scalars);
    test::expectSameVoxels(baked.temperature->values, volume.temperature->values);
    for (std::size_t c = 0; c < 3; ++c) test::expectSameVoxels(baked.albedo->values[c], volume.albedo->values[c]);
    for (std::size_t brick = 0; brick < volume.temperature->values.count(); ++brick)
      EXPECT_TRUE(baked.scalars.numberAt(volume.temperature->values.cell(brick)).has_value()) << "light without a brick of scalars";
  }
}

TEST(BakedVolume, DescriptionIsThatOfTheVolume) {
  const test::TemporaryFolder folder;
  Volume volume = test::volumeOfAllChannels();
  volume.up = {0, 0, 1};
  volume.upReason = "a test says so";
  volume.indexOrigin = {-3, 5, 7};
  Classification classification = kDense;
  classification.emission = Emission{.strength = 2.5, .temperatureScale = 0.1, .temperatureOffset = 7.0};
  const Volume baked = test::bakedAndRead(folder / "a.fvx", volume, classification, {});
  EXPECT_EQ(baked.source, "a.fvx (test volume)");
  EXPECT_EQ(baked.dimensions, volume.dimensions);
  EXPECT_EQ(baked.indexOrigin, volume.indexOrigin);
  EXPECT_EQ(baked.indexToWorld, volume.indexToWorld);
  EXPECT_EQ(baked.up, volume.up);
  EXPECT_EQ(baked.upReason, volume.upReason);
  EXPECT_EQ(baked.activeVoxels, volume.activeVoxels);
  EXPECT_EQ(baked.minimum, volume.minimum);
  EXPECT_EQ(baked.maximum, volume.maximum);
  EXPECT_EQ(baked.temperature->name, "heat");
  EXPECT_EQ(baked.temperature->maximum, volume.temperature->maximum);
  EXPECT_EQ(baked.albedo->clippedVoxels, 3u);
  EXPECT_TRUE(baked.classificationIsFixed);
  EXPECT_EQ(baked.classification->densityScale, kDense.densityScale);
  EXPECT_EQ(baked.classification->albedo, kDense.albedo);
  EXPECT_EQ(baked.classification->emission->temperatureScale, 0.1);
}

TEST(BakedVolume, TransferFunctionIsKeptExactly) {
  const test::TemporaryFolder folder;
  const Volume baked = test::bakedAndRead(folder / "a.fvx", test::smoothVolume(), banded(), {});
  const Classification wanted = banded();
  ASSERT_TRUE(baked.classification->transferFunction);
  EXPECT_EQ(transferFunctionJson(*baked.classification->transferFunction), transferFunctionJson(*wanted.transferFunction));
  EXPECT_EQ(baked.classification->order, ClassificationOrder::Pre);
}

TEST(BakedVolume, DensitiesIn16BitsAreWithinAHalfsPrecision) {
  const test::TemporaryFolder folder;
  const Volume volume = test::smoothVolume();
  const Volume baked = test::bakedAndRead(folder / "a.fvx", volume, kDense, {});
  for (glm::ivec3 v(0); v.z < volume.dimensions.z; ++v.z)
    for (v.y = 0; v.y < volume.dimensions.y; ++v.y)
      for (v.x = 0; v.x < volume.dimensions.x; ++v.x) {
        const double density = std::max(volume.scalars.at(v), 0.0f);
        ASSERT_NEAR(std::max(baked.scalars.at(v), 0.0f), density, 1e-6 + density / 2047.0);
      }
}

TEST(BakedVolume, ScalarsOfATransferFunctionIn16BitsAreWithinHalfACode) {
  const test::TemporaryFolder folder;
  const Volume volume = test::smoothVolume();
  const Volume baked = test::bakedAndRead(folder / "a.fvx", volume, banded(), {});
  test::expectSameVoxels(volume.scalars, baked.scalars, 0.51 / 65534.0, double(volume.maximum - volume.minimum));
}

TEST(BakedVolume, OutlivesItsFileAndCanBeChanged) {
  const test::TemporaryFolder folder;
  for (const bool keepScalars : {false, true}) {
    bakeVolume(folder / "a.fvx", test::smoothVolume(), kDense, {.keepScalars = keepScalars});
    auto file = std::make_shared<const FvxFile>(folder / "a.fvx");
    Volume volume = readBaked(file);
    const float before = volume.scalar(1, 2, 3);
    file.reset();
    std::filesystem::resize_file(folder / "a.fvx", 10);
    EXPECT_EQ(volume.scalar(1, 2, 3), before);
    volume.scalars.set({1, 2, 3}, 42.0f);
    EXPECT_EQ(volume.scalar(1, 2, 3), 42.0f);
    EXPECT_NE(before, 42.0f);
  }
}

TEST(BakedVolume, LevelsAreMeansOfTheLevelBelow) {
  const test::TemporaryFolder folder;
  const Volume volume = test::smoothVolume();
  for (const bool densities : {true, false}) {
    bakeVolume(folder / "a.fvx", volume, densities ? kDense : banded(), {.keepScalars = true});
    const auto file = std::make_shared<const FvxFile>(folder / "a.fvx");
    ASSERT_EQ(file->levels(), 3);
    Volume expected = volume;
    for (int level = 1; level < file->levels(); ++level) {
      expected = coarseVolume(expected, 2, densities ? WithoutData::Zero : WithoutData::Ignored);
      const Volume coarse = readBaked(file, level);
      EXPECT_EQ(coarse.dimensions, expected.dimensions);
      EXPECT_LT(glm::length(coarse.indexToWorld[3] - expected.indexToWorld[3]), 1e-12);
      EXPECT_EQ(coarse.indexToWorld[0], expected.indexToWorld[0]);
      test::expectSameVoxels(coarse.scalars, expected.scalars);
      EXPECT_EQ(coarse.activeVoxels, expected.activeVoxels);
    }
  }
}

TEST(BakedVolume, ChunkIndexSaysWhatIsInAChunk) {
  const test::TemporaryFolder folder;
  const Volume volume = test::smoothVolume();
  bakeVolume(folder / "a.fvx", volume, kDense, {.keepScalars = true});
  const FvxFile file(folder / "a.fvx");
  std::uint64_t active = 0;
  const auto chunks = file.chunks(Channel::Scalars, 0);
  EXPECT_EQ(chunks.size(), 8u);  // of 3 x 2 x 2; the last four have no data
  for (const ChunkEntry& chunk : chunks) {
    active += chunk.activeVoxels;
    EXPECT_LE(chunk.minimum, chunk.maximum);
    EXPECT_GE(chunk.minimum, volume.minimum);
    EXPECT_LE(chunk.maximum, volume.maximum);
    EXPECT_FLOAT_EQ(chunk.leastExtinction, float(kDense.densityScale) * chunk.minimum);
    EXPECT_FLOAT_EQ(chunk.mostExtinction, float(kDense.densityScale) * chunk.maximum);
    EXPECT_EQ(chunk.offset % 64, 0u);
  }
  EXPECT_EQ(active, volume.activeVoxels);
}

TEST(BakedVolume, ACroppedVolumeIsAlignedToItsBox) {
  const test::TemporaryFolder folder;
  Volume volume = test::smoothVolume();
  volume.scalars = volume.scalars.cropped({3, 5, 9}, {34, 40, 36});
  volume.dimensions = volume.scalars.dimensions();
  summariseValues(volume);
  ASSERT_NE(volume.scalars.corner(), glm::ivec3(0));
  const Volume baked = test::bakedAndRead(folder / "a.fvx", volume, kDense, {.keepScalars = true});
  EXPECT_EQ(baked.scalars.corner(), glm::ivec3(0));
  test::expectSameVoxels(baked.scalars, volume.scalars);
}

TEST(BakedVolume, TheSameVolumeGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.fvx", "b.fvx"}) bakeVolume(folder / name, test::volumeOfAllChannels(), kDense, {.compress = true});
  EXPECT_TRUE(test::readBytes(folder / "a.fvx") == test::readBytes(folder / "b.fvx"));
}

TEST(BakedVolume, CompressedFilesAreSmaller) {
  const test::TemporaryFolder folder;
  bakeVolume(folder / "a.fvx", test::smoothVolume(), kDense, {.keepScalars = true});
  bakeVolume(folder / "b.fvx", test::smoothVolume(), kDense, {.keepScalars = true, .compress = true});
  EXPECT_LT(std::filesystem::file_size(folder / "b.fvx"), std::filesystem::file_size(folder / "a.fvx"));
}

TEST(BakedVolume, FinestLevelIsTheFirstThatFits) {
  const test::TemporaryFolder folder;
  bakeVolume(folder / "a.fvx", test::smoothVolume(), kDense, {});
  const FvxFile file(folder / "a.fvx");
  const auto stored = [&](int level) {  // voxels of the bricks, or of the box
    std::uint64_t bricks = 0;
    for (const fvx::ChunkEntry& chunk : file.chunks(fvx::Channel::Scalars, level)) bricks += std::uint64_t(chunk.bricks());
    const glm::u64vec3 box(file.dimensions(level));
    return std::min(bricks * fvx::kBrickVoxels, box.x * box.y * box.z);
  };
  EXPECT_EQ(finestLevel(file, stored(0)), 0);
  EXPECT_EQ(finestLevel(file, stored(0) - 1), 1);
  EXPECT_EQ(finestLevel(file, stored(2)), 2);
  test::expectRefusal([&] { finestLevel(file, 100); }, ErrorKind::OutOfMemory, {"a.fvx", "memory-limit"});
}

TEST(BakedVolume, AStreamedVolumeIsTheOneThatIsHeldInMemory) {
  const test::TemporaryFolder folder;
  const glm::ivec3 size(70, 40, 50);
  for (const char* name : {"plume", "fire"}) {
    const ProceduralField field(name, size);
    const Volume whole = makeProcedural(name, size);
    bakeVolume(folder / "whole.fvx", whole, kDense, {});
    bakeStreamed(folder / "streamed.fvx", proceduralStream(field, whole, kDense), kDense, {});
    EXPECT_TRUE(test::readBytes(folder / "whole.fvx") == test::readBytes(folder / "streamed.fvx")) << name;
  }
}

TEST(BakedVolume, PartsOfAnOpenVdbFileMakeTheSameFileAsTheWhole) {
  const test::TemporaryFolder folder;
  Volume volume = test::patchyVolume({75, 40, 53}, test::smoothVolume().indexToWorld);
  volume.indexOrigin = {-21, 5, -130};
  for (glm::ivec3 v(24, 20, 30); v.x < 56; ++v.x)  // uniform leaves, which become tiles
    for (v.y = 4; v.y < 36; ++v.y)
      for (v.z = 12; v.z < 44; ++v.z) volume.scalars.set(v, 0.75f);
  volume.scalars.set({3, 2, 1}, std::numeric_limits<float>::quiet_NaN());
  const std::filesystem::path file = folder / "a.vdb";
  writeVdb(file, volume, "density");
  const Volume whole = readVdb(file, "", std::uint64_t(1) << 28);
  EXPECT_EQ(VdbParts::open(file, {}, std::uint64_t(1) << 28), nullptr) << "it fits";
  const std::unique_ptr<const VdbParts> parts = VdbParts::open(file, {}, 0);
  ASSERT_NE(parts, nullptr);
  EXPECT_EQ(parts->outline().nanVoxels, 1u);
  EXPECT_EQ(parts->sample().nanVoxels, 1u);
  EXPECT_EQ(denseScalars(parts->sample()), denseScalars(whole)) << "of so few voxels, every one";
  bakeVolume(folder / "whole.fvx", whole, kDense, {});
  bakeStreamed(folder / "parts.fvx", partsStream(*parts, kDense), kDense, {});
  EXPECT_TRUE(test::readBytes(folder / "whole.fvx") == test::readBytes(folder / "parts.fvx"));
}

TEST(BakedVolume, MoreVoxelsMayBeWithoutNumbersThanWith) {
  const test::TemporaryFolder folder;
  const Volume volume = makeVolume({19, 8, 33}, glm::dmat4(1.0), [](int x, int y, int) { return x + y < 6 ? 0.5f : std::nanf(""); });
  EXPECT_GT(volume.nanVoxels, volume.activeVoxels);
  bakeVolume(folder / "a.fvx", volume, kDense, {});
  EXPECT_EQ(readBaked(std::make_shared<const fvx::FvxFile>(folder / "a.fvx"), 0).nanVoxels, volume.nanVoxels);
}

TEST(BakedVolume, WhatIsSeenTravelsWithEveryLevel) {
  const test::TemporaryFolder folder;
  // Boxes that end with a group of 4 voxels, a brick, a chunk, and elsewhere.
  for (const glm::ivec3 dimensions : {glm::ivec3(70, 41, 37), {4, 4, 4}, {8, 16, 9}, {32, 64, 31}, {33, 7, 65}, {2, 1, 40}}) {
    const Volume volume = test::smoothVolume(dimensions);
    const Subject found = contentOf(volume, kDense);
    bakeVolume(folder / "a.fvx", volume, kDense, {});
    const auto file = std::make_shared<const FvxFile>(folder / "a.fvx");
    for (int level = 0; level < file->levels(); ++level)
      for (const Volume& read : {readBaked(file, level), bakedOutline(*file, level)}) {
        const Subject subject = contentOf(read, {.densityScale = 7.0});
        EXPECT_EQ(subject.points, found.points) << level;
        EXPECT_EQ(subject.centre, found.centre) << level;
      }
  }
}

/// How far along x something is seen.
double farthestX(const Volume& volume, const Classification& classification) {
  double farthest = -1e9;
  for (const glm::dvec3& point : contentOf(volume, classification).points) farthest = std::max(farthest, point.x);
  return farthest;
}

TEST(BakedVolume, WhatIsSeenOfAPartOrOtherwiseClassifiedIsFoundInTheVoxels) {
  const test::TemporaryFolder folder;
  const Volume whole = test::bakedAndRead(folder / "a.fvx", test::smoothVolume(), kDense, {.keepScalars = true});
  const double farthest = farthestX(whole, kDense);
  EXPECT_LT(farthestX(clippedVolume(whole, VoxelBox{{3, 4, 5}, {20, 20, 20}}), kDense), farthest);
  const ClipPlane plane{.point = glm::dvec3(whole.indexToWorld * glm::dvec4(10.0, 0.0, 0.0, 1.0))};
  EXPECT_LT(farthestX(clippedVolume(whole, plane), kDense), farthest);
  EXPECT_NE(contentOf(whole, banded()).points, contentOf(whole, kDense).points);
}

/// Bytes of a file that are in memory.
std::uint64_t cachedBytes(const std::filesystem::path& file) {
  const auto size = std::size_t(std::filesystem::file_size(file));
  const int descriptor = open(file.c_str(), O_RDONLY);
  void* const map = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
  close(descriptor);
  std::vector<unsigned char> pages((size + 4095) / 4096);
  mincore(map, size, pages.data());
  munmap(map, size);
  return std::uint64_t(std::ranges::count_if(pages, [](unsigned char page) { return (page & 1) != 0; })) * 4096;
}

void forget(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDWR);
  fsync(descriptor);
  posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
  close(descriptor);
}

TEST(BakedVolume, ReadersOfBoxesReadTheirPartOfTheFileAlone) {
  const test::TemporaryFolder folder;
  const Volume volume = makeVolume({256, 256, 128}, glm::dmat4(1.0), [](int x, int y, int z) { return 0.1 + 0.001 * (x + y + z); });
  bakeVolume(folder / "a.fvx", volume, {.densityScale = 0.01}, {});
  forget(folder / "a.fvx");
  if (cachedBytes(folder / "a.fvx") > 0) GTEST_SKIP() << "this file system keeps files in memory";
  constexpr int kReaders = 4;
  const auto size = double(std::filesystem::file_size(folder / "a.fvx"));
  for (int reader = 0; reader < kReaders; ++reader) {
    BakedSource(std::make_shared<const FvxFile>(folder / "a.fvx")).read(0, {{0, 64 * reader, 0}, {256, 64 * (reader + 1), 128}});
    // The kernel reads ahead, and coarse levels, which none of them reads, are a seventh.
    EXPECT_GT(double(cachedBytes(folder / "a.fvx")), 0.7 * size / kReaders);
    EXPECT_LT(double(cachedBytes(folder / "a.fvx")), 1.5 * size / kReaders);
    forget(folder / "a.fvx");
  }
}

/// The box begins and ends within bricks, and beyond the volume.
TEST(BakedVolume, APartThatIsReadIsThatOfTheWhole) {
  const test::TemporaryFolder folder;
  const Volume whole = test::bakedAndRead(folder / "a.fvx", test::volumeOfAllChannels(), kDense, {.keepScalars = true});
  const auto file = std::make_shared<const FvxFile>(folder / "a.fvx");
  for (const VoxelBox& box : {VoxelBox{{3, 9, 8}, {44, 99, 20}}, VoxelBox{{0, 0, 0}, {99, 99, 99}}, VoxelBox{{69, 40, 36}, {70, 41, 37}}}) {
    const Volume part = readBakedPart(file, box), expected = clippedVolume(whole, box);
    EXPECT_EQ(part.dimensions, expected.dimensions);
    EXPECT_EQ(part.indexToWorld, expected.indexToWorld);
    EXPECT_EQ(part.indexOrigin, expected.indexOrigin);
    EXPECT_EQ(part.activeVoxels, expected.activeVoxels);
    EXPECT_EQ(part.minimum, expected.minimum);
    EXPECT_EQ(part.maximum, expected.maximum);
    test::expectSameVoxels(part.scalars, expected.scalars);
    test::expectSameVoxels(part.temperature->values, expected.temperature->values);
    for (std::size_t c = 0; c < 3; ++c) test::expectSameVoxels(part.albedo->values[c], expected.albedo->values[c]);
  }
}

TEST(BakedVolume, VoxelsFarApartAreBakedAndReadBack) {
  const test::TemporaryFolder folder;
  Volume volume{.source = "far", .dimensions = {20'000'001, 40, 9}, .scalars = ScalarBricks({20'000'001, 40, 9}, {3, 0, 5})};
  const std::vector<glm::ivec3> places{{0, 0, 0}, {8191, 39, 8}, {8192, 0, 4}, {20'000'000, 39, 8}};
  for (const glm::ivec3 place : places) volume.scalars.set(place, 0.5f + float(place.x % 7));
  summariseValues(volume);
  bakeVolume(folder / "a.fvx", volume, kDense, {.keepScalars = true});
  const auto file = std::make_shared<const fvx::FvxFile>(folder / "a.fvx");
  EXPECT_EQ(file->levels(), fvx::kMaxLevels);
  EXPECT_EQ(finestLevel(*file, 4 * 512), 0);
  const Volume read = readBaked(file);
  EXPECT_EQ(read.activeVoxels, places.size());
  for (const glm::ivec3 place : places) EXPECT_EQ(read.scalars.at(place), volume.scalars.at(place));
  const Volume part = BakedSource(file).read(0, {{20'000'000 - 64, 32, 0}, {20'000'001, 40, 9}});
  EXPECT_EQ(part.scalars.at({64, 7, 8}), volume.scalars.at(places.back()));
  EXPECT_EQ(readBaked(file, 8).activeVoxels, places.size());
}

TEST(BakedVolume, AVolumeThatIsTooLongIsRefused) {
  const test::TemporaryFolder folder;
  const StreamedVolume volume{.outline = {.source = "long", .dimensions = {fvx::kLongestEdge + 1, 1, 1}},
                              .content = {.cells = Cells(glm::ivec3(1))}};
  test::expectRefusal([&] { bakeStreamed(folder / "a.fvx", volume, kDense, {}); }, ErrorKind::Input, {"long", "67108865", "67108864"});
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(BakedVolume, AFullDiskIsSaidAndLeavesNothing) {
  const test::TemporaryFolder folder;
  if (!test::canLimitDisks(folder.path())) GTEST_SKIP() << "no disk can be limited here";
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536,
                                               [](const std::filesystem::path& disk) {
                                                 bakeVolume(disk / "a.fvx", test::smoothVolume(), kDense, {.keepScalars = true});
                                               }),
              testing::ExitedWithCode(int(ErrorKind::Output)), "No space left");
}

}  // namespace
}  // namespace freevoxels
