#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "tests/limited_disk.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::readBytes;
using test::TemporaryFolder;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Png {
  unsigned width = 0, height = 0;
  int channels = 0;
  std::vector<std::uint8_t> bytes;
};

/// As stored, by libpng's simplified reader: no conversion.
Png readPng(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0) << image.message;
  Png png{image.width, image.height, int(PNG_IMAGE_SAMPLE_CHANNELS(image.format)), {}};
  EXPECT_EQ(image.format & PNG_FORMAT_FLAG_LINEAR, 0u);
  png.bytes.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, png.bytes.data(), 0, nullptr), 0) << image.message;
  return png;
}

std::vector<std::uint8_t> writeAndRead(const std::vector<glm::vec4>& pixels,
                                       const glm::vec3* background = nullptr) {
  const TemporaryFolder folder;
  Image image;
  image.size = {int(pixels.size()), 1};
  image.pixels = pixels;
  writePng(folder / "a.png", image, background);
  const Png png = readPng(folder / "a.png");
  EXPECT_EQ(png.channels, background ? 3 : 4);
  return png.bytes;
}

using Bytes = std::vector<std::uint8_t>;

TEST(Png, EncodesLinearLightAsSrgb) {
  // 0.5 linear is byte 188 and 0.18 is 118; 0.002 lies on the linear part of the curve: 12.92 * 0.002 * 255
  // = 6.6.
  EXPECT_EQ(writeAndRead({{0.5f, 0.18f, 0.002f, 1.0f}, {0.0f, 1.0f, 0.25f, 1.0f}}),
            (Bytes{188, 118, 7, 255, 0, 255, 137, 255}));
}

TEST(Png, StraightAlphaIsTheColourDividedByAlpha) {
  EXPECT_EQ(writeAndRead({{0.25f, 0.09f, 0.5f, 0.5f}, {0.0f, 0.0f, 0.0f, 0.0f}}),
            (Bytes{188, 118, 255, 128, 0, 0, 0, 0}));
}

TEST(Png, BackgroundShowsThroughAndMakesThePictureOpaque) {
  const glm::vec3 background(1.0f, 0.0f, 0.36f);
  // 0.25 + 0.5 * 1 = 0.75 is byte 225; 0.5 * 0.36 = 0.18; an empty pixel is the background.
  EXPECT_EQ(writeAndRead({{0.25f, 0.5f, 0.0f, 0.5f}, {0.0f, 0.0f, 0.0f, 0.0f}}, &background),
            (Bytes{225, 188, 118, 255, 0, 162}));
}

TEST(Png, ClampsAndMakesNanBlack) {
  EXPECT_EQ(writeAndRead({{7.0f, -1.0f, kNan, 1.0f}, {0.5f, 0.5f, 0.5f, kNan}, {0.5f, 0.18f, 0.0f, 3.0f}}),
            (Bytes{255, 0, 0, 255, 0, 0, 0, 0, 188, 118, 0, 255}));
  const glm::vec3 background(0.5f);
  EXPECT_EQ(writeAndRead({{0.25f, kNan, 2.0f, 2.0f}}, &background), (Bytes{137, 0, 255}));
}

TEST(Png, RowZeroIsTheTopAndSrgbIsDeclared) {
  const TemporaryFolder folder;
  Image image;
  image.size = {3, 2};
  image.pixels.assign(6, glm::vec4(0, 0, 0, 1));
  image.pixels[2] = {1, 0, 0, 1};  // top right
  writePng(folder / "a.png", image, nullptr);
  const Png png = readPng(folder / "a.png");
  ASSERT_EQ(png.width, 3u);
  ASSERT_EQ(png.height, 2u);
  EXPECT_EQ(png.bytes[4 * 2], 255);
  EXPECT_EQ(png.bytes[4 * 5], 0);
  const std::string bytes = readBytes(folder / "a.png");
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
  writePng(folder / "b.png", image, nullptr);
  EXPECT_EQ(readBytes(folder / "b.png"), bytes);
}

TEST(PngDeathTest, FullDiskIsOneSentenceAndLeavesNoFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  FV_REQUIRE_LIMITED_DISK(folder.path());
  const auto write = [](const std::filesystem::path& disk) {
    Image image;
    image.size = {512, 512};
    std::uint32_t state = 1;
    for (int i = 0; i < 512 * 512; ++i)
      image.pixels.emplace_back(glm::vec3(float((state = state * 1664525u + 1013904223u) >> 8) / 16777216.0f),
                                1.0f);
    writePng(disk / "a.png", image, nullptr);
  };
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536, write),
              testing::ExitedWithCode(int(ExitCode::Output)),
              "cannot write '.*a.png': No space left on device");
}

}  // namespace
}  // namespace freevoxels
