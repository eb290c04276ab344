// The bricks of a scan, of which numbers of 8 and 16 bits stay such.

#include "engine/volume/scan_voxels.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <vector>

#include "engine/volume/content_hash.h"
#include "engine/volume/histogram.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {
namespace {

constexpr glm::ivec3 kScanSize{19, 9, 12};

template <typename Value>
std::vector<Value> ramp(glm::ivec3 size) {
  std::vector<Value> values;
  for (int i = 0; i < size.x * size.y * size.z; ++i) values.push_back(Value(i * 37));
  return values;
}

template <typename Value>
SampleBlock blockOf(const std::vector<Value>& values, SampleType type, glm::ivec3 extent, glm::ivec3 first = glm::ivec3(0)) {
  return {.samples = reinterpret_cast<const std::byte*>(values.data()), .type = type, .first = first, .extent = extent};
}

template <typename Value>
void expectRamp(const ScalarBricks& bricks, double slope, double intercept) {
  const std::vector<Value> values = ramp<Value>(kScanSize);
  std::size_t i = 0;
  for (int z = 0; z < kScanSize.z; ++z)
    for (int y = 0; y < kScanSize.y; ++y)
      for (int x = 0; x < kScanSize.x; ++x) ASSERT_EQ(bricks.at({x, y, z}), float(double(values[i++]) * slope + intercept));
}

template <typename Value>
void expectCodes(SampleType type, std::size_t codes) {
  const std::vector<Value> values = ramp<Value>(kScanSize);
  ScanVoxels voxels(type, kScanSize);
  SampleBlock block = blockOf(values, type, kScanSize);
  block.slope = 0.5;
  block.intercept = -1024.0;
  voxels.put(block);
  const ScalarBricks bricks = voxels.take();
  EXPECT_EQ(bricks.values().size(), codes);
  expectRamp<Value>(bricks, 0.5, -1024.0);
}

TEST(ScanVoxels, NumbersOfEightAndSixteenBitsStaySuch) {
  expectCodes<std::uint8_t>(SampleType::U8, 256);
  expectCodes<std::int8_t>(SampleType::I8, 256);
  expectCodes<std::uint16_t>(SampleType::U16, 65536);
  expectCodes<std::int16_t>(SampleType::I16, 65536);
  expectCodes<std::int32_t>(SampleType::I32, 0);
  expectCodes<float>(SampleType::F32, 0);
  expectCodes<double>(SampleType::F64, 0);
}

/// Slices of other numbers than the first, as a series of DICOM may have them.
TEST(ScanVoxels, BlocksOfOtherNumbersMakeFloats) {
  const glm::ivec3 slice(kScanSize.x, kScanSize.y, 1);
  const auto first = ramp<std::int16_t>(slice);
  const auto second = ramp<float>(slice);
  ScanVoxels voxels(SampleType::I16, kScanSize);
  for (int z = 0; z < kScanSize.z; ++z) {
    SampleBlock block = blockOf(first, SampleType::I16, slice, {0, 0, z});
    if (z == 3) block = blockOf(second, SampleType::F32, slice, {0, 0, z});
    if (z == 5) block.slope = 0.5;
    voxels.put(block);
  }
  const ScalarBricks bricks = voxels.take();
  EXPECT_TRUE(bricks.values().empty());
  for (int z = 0; z < kScanSize.z; ++z)
    for (int y = 0; y < kScanSize.y; ++y)
      for (int x = 0; x < kScanSize.x; ++x) {
        const std::size_t i = std::size_t(x + kScanSize.x * y);
        ASSERT_EQ(bricks.at({x, y, z}), z == 3 ? second[i] : float(first[i]) * (z == 5 ? 0.5f : 1.0f));
      }
  for (std::size_t brick = 0; brick < bricks.count(); ++brick) {
    const ScalarBricks::Brick values = bricks.brick(brick);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool isBeyond = glm::any(glm::greaterThanEqual(bricks.firstVoxel(brick) + ScalarBricks::placeInBrick(i), kScanSize));
      ASSERT_EQ(values[i] == kInactiveVoxel, isBeyond);
    }
  }
}

TEST(ScanVoxels, BlocksAreTakenFromSeveralThreads) {
  const glm::ivec3 slice(kScanSize.x, kScanSize.y, 1);
  const auto bytes = ramp<std::uint8_t>(slice);
  const auto words = ramp<std::uint16_t>(slice);
  for (const bool isMixed : {false, true}) {
    ScanVoxels voxels(SampleType::U8, kScanSize);
    tbb::parallel_for(0, kScanSize.z, [&](int z) {
      voxels.put(isMixed && z % 4 == 3 ? blockOf(words, SampleType::U16, slice, {0, 0, z})
                                       : blockOf(bytes, SampleType::U8, slice, {0, 0, z}));
    });
    const ScalarBricks bricks = voxels.take();
    EXPECT_EQ(bricks.values().empty(), isMixed);
    for (int z = 0; z < kScanSize.z; ++z)
      for (int x = 0; x < kScanSize.x; ++x)
        ASSERT_EQ(bricks.at({x, 0, z}), isMixed && z % 4 == 3 ? float(words[std::size_t(x)]) : float(bytes[std::size_t(x)]));
  }
}

/// A head in the air, with padding around it.
float scanAt(glm::ivec3 v) {
  const float distance = glm::length(glm::vec3(v) - 0.5f * glm::vec3(40, 33, 29));
  return distance > 17.0f ? 255.0f : distance > 13.0f ? 20.0f + float((v.x + v.y) % 5) : 90.0f - distance * 4.0f;
}

TEST(ScanVoxels, VolumesOfCodesAreThoseOfFloats) {
  const glm::ivec3 size(40, 33, 29);
  std::vector<float> values(256);
  for (std::size_t code = 0; code < values.size(); ++code) values[code] = float(code);
  const auto volumeOf = [&](bool areCodes) {
    ScalarBricks scalars = areCodes ? ScalarBricks::makeCodes<std::uint8_t>(
                                          size, [](glm::ivec3 v) { return std::uint8_t(scanAt(v)); }, values)
                                    : ScalarBricks::make(size, [](glm::ivec3 v) { return float(std::uint8_t(scanAt(v))); });
    return volumeOfScalars(std::move(scalars), glm::dmat4(1.0), std::nullopt);
  };
  const Volume codes = volumeOf(true), floats = volumeOf(false);
  EXPECT_FALSE(codes.scalars.values().empty());
  EXPECT_TRUE(floats.scalars.values().empty());
  ASSERT_TRUE(floats.padding.has_value()) << "which is what the fixture is for";
  EXPECT_EQ(codes.padding, floats.padding);
  EXPECT_EQ(codes.activeVoxels, floats.activeVoxels);
  EXPECT_EQ(codes.missingVoxels, floats.missingVoxels);
  EXPECT_EQ(codes.minimum, floats.minimum);
  EXPECT_EQ(codes.maximum, floats.maximum);
  EXPECT_EQ(codes.remarks, floats.remarks);
  EXPECT_EQ(histogramOf(codes, 64).counts, histogramOf(floats, 64).counts);
  EXPECT_EQ(contentHash(codes, {}, nullptr), contentHash(floats, {}, nullptr));
}

}  // namespace
}  // namespace freevoxels
