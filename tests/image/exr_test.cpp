#include <ImfChannelList.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "tests/limited_disk.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::readBytes;
using test::TemporaryFolder;
using test::writeBytes;

/// Values that differ from channel to channel and pixel to pixel, so that no swap passes.
Image makeImage(glm::ivec2 size, bool depth) {
  Image image;
  image.size = size;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const float u = float(x) / float(size.x), v = float(y) / float(size.y);
      image.pixels.emplace_back(0.1f + u, v * v, std::sin(7.0f * u + 3.0f * v), 0.5f * (u + v));
      if (depth) image.depth.push_back(x == 0 ? std::numeric_limits<float>::infinity() : 1000.0f + u - v);
    }
  return image;
}

/// Compressible only a little, so that it needs its disk space.
Image makeNoise(glm::ivec2 size) {
  Image image;
  image.size = size;
  std::uint32_t state = 1;
  const auto random = [&state] { return float((state = state * 1664525u + 1013904223u) >> 8) / 16777216.0f; };
  for (int i = 0; i < size.x * size.y; ++i) image.pixels.emplace_back(random(), random(), random(), random());
  return image;
}

TEST(Exr, FloatComesBackBitForBitWithDepth) {
  const TemporaryFolder folder;
  const Image image = makeImage({37, 19}, true);
  writeExr(folder / "a.exr", image, {.fullFloat = true, .metadata = {}, .matrices = {}});
  const Image back = readExr(folder / "a.exr");
  EXPECT_EQ(back.size, image.size);
  EXPECT_EQ(back.pixels, image.pixels);
  EXPECT_EQ(back.depth, image.depth);
}

TEST(Exr, HalfComesBackToElevenBitsAndDepthStaysFloat) {
  const TemporaryFolder folder;
  const Image image = makeImage({64, 33}, true);
  writeExr(folder / "a.exr", image, {});
  const Image back = readExr(folder / "a.exr");
  ASSERT_EQ(back.size, image.size);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      ASSERT_NEAR(back.pixels[i][c], image.pixels[i][c], std::abs(image.pixels[i][c]) / 2048.0f + 3e-8f);
  EXPECT_EQ(back.depth, image.depth);
}

TEST(Exr, HasNoDepthWhereTheImageHasNone) {
  const TemporaryFolder folder;
  writeExr(folder / "a.exr", makeImage({4, 4}, false), {});
  EXPECT_TRUE(readExr(folder / "a.exr").depth.empty());
}

TEST(Exr, BrightPixelsDoNotBecomeInfiniteInHalf) {
  const TemporaryFolder folder;
  Image image;
  image.size = {1, 1};
  image.pixels = {{1e6f, -1e6f, 65504.0f, 1.0f}};
  writeExr(folder / "a.exr", image, {});
  EXPECT_EQ(readExr(folder / "a.exr").pixels[0], glm::vec4(65504.0f, -65504.0f, 65504.0f, 1.0f));
}

TEST(Exr, HeaderTellsChannelsColourSpaceMetadataAndMatrices) {
  const TemporaryFolder folder;
  ExrOptions options;
  options.metadata["freevoxels:command"] = "render \"a\"\nb";
  glm::mat4 matrix(1.0f);
  matrix[3] = {5.0f, 6.0f, 7.0f, 1.0f};  // a translation, in glm's convention
  matrix[1][0] = 0.25f;
  options.matrices["worldToCamera"] = matrix;
  writeExr(folder / "a.exr", makeImage({3, 2}, true), options);

  const Imf::InputFile file((folder / "a.exr").c_str());
  const Imf::Header& header = file.header();
  EXPECT_EQ(header.channels()["A"].type, Imf::HALF);
  EXPECT_EQ(header.channels()["Z"].type, Imf::FLOAT);
  EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
  EXPECT_EQ(Imf::chromaticities(header).red, Imath::V2f(0.64f, 0.33f));
  EXPECT_EQ(Imf::chromaticities(header).white, Imath::V2f(0.3127f, 0.3290f));
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("freevoxels:command").value(), "render \"a\"\nb");
  // OpenEXR's points are rows, multiplied from the left.
  Imath::V3f moved;
  header.typedAttribute<Imf::M44fAttribute>("worldToCamera")
      .value()
      .multVecMatrix(Imath::V3f(1, 2, 3), moved);
  const glm::vec4 expected = matrix * glm::vec4(1, 2, 3, 1);
  EXPECT_EQ(moved, Imath::V3f(expected.x, expected.y, expected.z));
}

TEST(Exr, SameImageGivesTheSameBytes) {
  const TemporaryFolder folder;
  const Image image = makeImage({100, 70}, true);
  writeExr(folder / "a.exr", image, {});
  writeExr(folder / "b.exr", image, {});
  EXPECT_EQ(readBytes(folder / "a.exr"), readBytes(folder / "b.exr"));
}

TEST(Exr, RefusesToReadMissingForeignAndTruncatedFiles) {
  const TemporaryFolder folder;
  writeBytes(folder / "text.exr", "this is no image");
  writeExr(folder / "a.exr", makeNoise({64, 64}), {});
  const std::string whole = readBytes(folder / "a.exr");
  writeBytes(folder / "short.exr", whole.substr(0, whole.size() / 2));
  writeBytes(folder / "header.exr", whole.substr(0, 40));
  for (const char* name : {"missing.exr", "text.exr", "short.exr", "header.exr", ""}) {
    try {
      readExr(folder / name);
      ADD_FAILURE() << "no error for " << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_NE(std::string(error.what()).find((folder / name).string()), std::string::npos) << error.what();
    }
  }
}

/// Whatever an attribute's length says, no more memory is taken than the file has bytes.
TEST(Exr, RefusesAttributesThatAreLongerThanTheFile) {
  const TemporaryFolder folder;
  const auto file = folder / "a.exr";
  writeExr(file, makeImage({8, 4}, false), {.metadata = {{"freevoxels:note", "short"}}});
  std::string bytes = readBytes(file);
  const std::string name = std::string("freevoxels:note") + '\0' + "string" + '\0';
  const std::size_t length = bytes.find(name) + name.size();
  for (const int high : {0x69, 0xff}) {
    bytes[length + 3] = char(high);
    writeBytes(file, bytes);
    test::expectRefusal([&] { readExr(file); }, ErrorKind::Input, {"a.exr", "freevoxels:note", "longer than the file"});
  }
}

TEST(ExrDeathTest, FullDiskIsOneSentenceAndLeavesNoFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  FV_REQUIRE_LIMITED_DISK(folder.path());
  // One image that fails early, and one whose end alone does not fit: OpenEXR writes that in a destructor.
  writeExr(folder / "size.exr", makeNoise({64, 64}), {});
  const std::size_t size = readBytes(folder / "size.exr").size();
  ASSERT_GT(size % 4096, 0u);
  for (const auto& [side, bytes] : {std::pair<int, std::size_t>{512, 65536}, {64, size / 4096 * 4096}})
    EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), bytes,
                                                 [s = side](const auto& disk) {
                                                   writeExr(disk / "a.exr", makeNoise({s, s}), {});
                                                 }),
                testing::ExitedWithCode(int(ErrorKind::Output)),
                "cannot write '.*a.exr': No space left on device");
}

}  // namespace
}  // namespace freevoxels
