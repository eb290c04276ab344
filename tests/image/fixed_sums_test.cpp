// Fixed-point sums: exact addition, files without loss, and what becomes of them.

#include "engine/image/fixed_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/image/image.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

FixedSums randomSums(int channels, unsigned seed = 5) {
  FixedSums sums{.size = {9, 7}, .first = {2, 1}, .extent = {5, 4}, .channels = channels, .digits = {40, 40, 40, 43, 50, 38}};
  sums.method = "rays";
  std::mt19937_64 generator(seed);
  for (std::size_t i = 0; i < sums.pixelCount() * std::size_t(channels); ++i) sums.values.push_back(std::int64_t(generator()) >> 10);
  return sums;
}

TEST(FixedSums, FilesKeepEveryBit) {
  const test::TemporaryFolder folder;
  for (const int channels : {kSumChannels, kSumChannels - 1}) {
    FixedSums sums = randomSums(channels);
    sums.values[0] = std::numeric_limits<std::int64_t>::max();
    sums.values[1] = std::numeric_limits<std::int64_t>::min();
    sums.values[2] = -1;
    ExrOptions header;
    header.metadata["freevoxels:share"] = "3/7";
    header.matrices["worldToCamera"] = glm::mat4(1.5f);
    header.matrices["worldToCamera"][3][1] = 0.25f;
    writeSums(folder / "a.exr", sums, header);
    const SumsFile read = readSums(folder / "a.exr");
    EXPECT_TRUE(read.sums.isLike(sums));
    EXPECT_EQ(read.sums.values, sums.values);
    EXPECT_EQ(read.header.metadata.at("freevoxels:share"), "3/7");
    EXPECT_EQ(read.header.matrices, header.matrices);
    EXPECT_TRUE(holdsSums(folder / "a.exr"));
  }
}

/// Files are read a quarter of a million pixels at a time.
TEST(FixedSums, LargeFilesKeepEveryBit) {
  const test::TemporaryFolder folder;
  for (const glm::ivec2 extent : {glm::ivec2(16384, 33), glm::ivec2(700, 800), glm::ivec2(1, 16384), glm::ivec2(512, 512)})
    for (const int channels : {kSumChannels, kSumChannels - 1}) {
      const glm::ivec2 first = glm::min(glm::ivec2(37, 5), kMaxImageEdge - extent);
      FixedSums sums{.size = first + extent, .first = first, .extent = extent, .channels = channels, .digits = {40, 40, 40, 43, 50, 38}};
      sums.values.resize(sums.pixelCount() * std::size_t(channels));
      for (std::size_t i = 0; i < sums.values.size(); ++i) sums.values[i] = std::int64_t(i % 251 == 0 ? ~i << 20 : i);
      writeSums(folder / "a.exr", sums, {});
      EXPECT_TRUE(readSums(folder / "a.exr").sums.values == sums.values) << extent.x << 'x' << extent.y << ", " << channels << " channels";
      const std::string bytes = test::readBytes(folder / "a.exr");
      for (const double part : {0.2, 0.999}) {
        test::writeBytes(folder / "cut.exr", bytes.substr(0, std::size_t(part * double(bytes.size()))));
        test::expectRefusal([&] { readSums(folder / "cut.exr"); }, ErrorKind::Input, {"cut.exr", "again"});
      }
    }
}

TEST(FixedSums, TreesOfAdditionsHaveTheSameBits) {
  const FixedSums a = randomSums(kSumChannels, 1), b = randomSums(kSumChannels, 2), c = randomSums(kSumChannels, 3);
  FixedSums left = a, right = c;
  (left += b) += c;
  (right += b) += a;
  EXPECT_EQ(left.values, right.values);
}

TEST(FixedSums, ImagesAndDamagedFilesAreRefused) {
  const test::TemporaryFolder folder;
  writeExr(folder / "image.exr", {.size = {4, 4}, .pixels = std::vector<glm::vec4>(16)}, {});
  EXPECT_FALSE(holdsSums(folder / "image.exr"));
  test::expectRefusal([&] { readSums(folder / "image.exr"); }, ErrorKind::Input, {"image.exr", "it is an image"});
  test::expectRefusal([&] { readSums(folder / "none.exr"); }, ErrorKind::Input, {"none.exr", "no such file"});
  writeSums(folder / "sums.exr", randomSums(kSumChannels), {});
  const std::string bytes = test::readBytes(folder / "sums.exr");
  for (const double part : {0.1, 0.5, 0.98}) {
    test::writeBytes(folder / "cut.exr", bytes.substr(0, std::size_t(part * double(bytes.size()))));
    test::expectRefusal([&] { readSums(folder / "cut.exr"); }, ErrorKind::Input, {"cut.exr", "again"});
  }
}

TEST(FixedSums, ResolveToTheSumsClosedForm) {
  FixedSums sums{.size = {3, 2}, .first = {1, 1}, .extent = {1, 1}, .digits = {40, 40, 40, 40, 50, 30}};
  const auto fixed = [](double value, int digits) { return std::int64_t(std::llround(std::ldexp(value, digits))); };
  sums.values = {fixed(0.1, 40), fixed(0.2, 40), fixed(0.4, 40), fixed(0.5, 40), fixed(std::log(2.0), 50), fixed(1.75, 30)};
  const Image normalised = resolveSums(sums, true), additive = resolveSums(sums, false);
  const auto expectPixel = [](glm::vec4 pixel, glm::vec4 expected) {
    for (int c = 0; c < 4; ++c) EXPECT_FLOAT_EQ(pixel[c], expected[c]);
  };
  expectPixel(normalised.pixels[4], {0.1f, 0.2f, 0.4f, 0.5f});  // alpha and E are both one half
  expectPixel(additive.pixels[4], {0.1f, 0.2f, 0.4f, 0.5f});
  EXPECT_FLOAT_EQ(normalised.depth[4], 3.5f);
  EXPECT_EQ(normalised.pixels[0], glm::vec4(0.0f));
  EXPECT_TRUE(std::isinf(normalised.depth[0]));
  sums.values[4] = fixed(30.0, 50);
  expectPixel(resolveSums(sums, true).pixels[4], {0.2f, 0.4f, 0.8f, 1.0f});
}

}  // namespace
}  // namespace freevoxels
