#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "engine/core/error.h"
#include "engine/image/decode_png.h"
#include "engine/image/image.h"
#include "engine/image/srgb.h"
#include "tests/limited_disk.h"
#include "tests/not_finite.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::readBytes;
using test::TemporaryFolder;

using test::kNan;

struct Png {
  unsigned width = 0, height = 0;
  int channels = 0;
  std::vector<std::uint8_t> bytes;
};

/// As stored, by libpng's simplified reader: no conversion.
Png readStored(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0) << image.message;
  Png png{image.width, image.height, int(PNG_IMAGE_SAMPLE_CHANNELS(image.format)), {}};
  EXPECT_EQ(image.format & PNG_FORMAT_FLAG_LINEAR, 0u);
  png.bytes.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, png.bytes.data(), 0, nullptr), 0) << image.message;
  return png;
}

DisplayLook over(glm::vec3 color) {
  return {.background = Background{color, color}};
}

std::vector<std::uint8_t> writeAndRead(const std::vector<glm::vec4>& pixels,
                                       const DisplayLook& look = {}) {
  const TemporaryFolder folder;
  Image image;
  image.size = {int(pixels.size()), 1};
  image.pixels = pixels;
  writePng(folder / "a.png", image, look);
  const Png png = readStored(folder / "a.png");
  EXPECT_EQ(png.channels, look.background ? 3 : 4);
  return png.bytes;
}

using Bytes = std::vector<std::uint8_t>;

TEST(Png, EncodesLinearLightAsSrgb) {
  // 0.5 linear is byte 188 and 0.18 is 118; 0.002 lies on the linear part of the curve: 12.92 * 0.002 * 255
  // = 6.6.
  EXPECT_EQ(writeAndRead({{0.5f, 0.18f, 0.002f, 1.0f}, {0.0f, 1.0f, 0.25f, 1.0f}}),
            (Bytes{188, 118, 7, 255, 0, 255, 137, 255}));
}

/// Tries every 61st value, so that all buckets of the table and both sides of its steps are met.
TEST(Png, LooksUpTheByteThatTheCurveGives) {
  const auto last = std::bit_cast<std::uint32_t>(1.0f);
  for (std::uint32_t bits = 0; bits <= last; bits += bits < 0x38000000u ? 99'991u : 61u) {
    const float linear = std::bit_cast<float>(bits);
    ASSERT_EQ(int(srgbByteFromLinear(linear)), int(std::lround(255.0f * srgbFromLinear(linear)))) << linear;
    ASSERT_EQ(int(byteFromUnit(linear)), int(std::lround(255.0f * linear))) << linear;
  }
  EXPECT_EQ(int(srgbByteFromLinear(1.0f)), 255);
}

TEST(Png, StraightAlphaIsTheColourDividedByAlpha) {
  EXPECT_EQ(writeAndRead({{0.25f, 0.09f, 0.5f, 0.5f}, {0.0f, 0.0f, 0.0f, 0.0f}}),
            (Bytes{188, 118, 255, 128, 0, 0, 0, 0}));
}

/// A flame without smoke has none of its own: 0.4 / 1 is byte 170 where alpha is 0.25. Over a background it
/// adds.
TEST(Png, LightTakesAsMuchAlphaAsItNeeds) {
  const std::vector<glm::vec4> flame{{0.25f, 0.1f, 0.0f, 0.0f}, {3.0f, 0.5f, 0.18f, 0.2f}};
  EXPECT_EQ(writeAndRead(flame), (Bytes{255, 170, 0, 64, 255, 188, 118, 255}));
  const glm::vec3 background(0.25f, 0.08f, 0.0f);
  EXPECT_EQ(writeAndRead({flame[0]}, over(background)), (Bytes{188, 118, 0}));
}

TEST(Png, BackgroundShowsThroughAndMakesTheImageOpaque) {
  const glm::vec3 background(1.0f, 0.0f, 0.36f);
  // 0.25 + 0.5 * 1 = 0.75 is byte 225; 0.5 * 0.36 = 0.18; an empty pixel is the background.
  EXPECT_EQ(writeAndRead({{0.25f, 0.5f, 0.0f, 0.5f}, {0.0f, 0.0f, 0.0f, 0.0f}}, over(background)),
            (Bytes{225, 188, 118, 255, 0, 162}));
}

TEST(Png, ClampsAndMakesNanBlack) {
  EXPECT_EQ(writeAndRead({{7.0f, -1.0f, kNan, 1.0f}, {0.5f, 0.5f, 0.5f, kNan}, {0.5f, 0.18f, 0.0f, 3.0f}}),
            (Bytes{255, 0, 0, 255, 0, 0, 0, 0, 188, 118, 0, 255}));
  const glm::vec3 background(0.5f);
  EXPECT_EQ(writeAndRead({{0.25f, kNan, 2.0f, 2.0f}}, over(background)), (Bytes{137, 0, 255}));
}

TEST(Png, BackgroundChangesLinearlyFromTheTopEdgeToTheBottomEdge) {
  const TemporaryFolder folder;
  Image image;
  image.size = {1, 2};
  image.pixels.assign(2, glm::vec4(0.0f));
  writePng(folder / "a.png", image, {.background = Background{glm::vec3(0.0f, 1.0f, 0.5f), glm::vec3(1.0f, 0.0f, 0.5f)}});
  EXPECT_EQ(readStored(folder / "a.png").bytes, (Bytes{137, 225, 188, 225, 137, 188}));
}

TEST(Png, ExposureBrightensTheImageButNotTheBackground) {
  EXPECT_EQ(writeAndRead({{0.125f, 0.045f, 0.0f, 1.0f}}, {.exposure = 2.0}), (Bytes{188, 118, 0, 255}));
  DisplayLook look = over(glm::vec3(0.5f));
  look.exposure = -1.0;
  EXPECT_EQ(writeAndRead({{1.0f, 0.36f, 0.0f, 1.0f}, glm::vec4(0.0f)}, look), (Bytes{188, 118, 0, 188, 188, 188}));
}

TEST(Png, ToneMapsBringBrightLightIntoRange) {
  for (const ToneMap map : {ToneMap::Filmic, ToneMap::Aces}) {
    const Bytes bytes = writeAndRead({{0.0f, 0.18f, 0.5f, 1.0f}, {1.0f, 2.0f, 4.0f, 1.0f}}, {.toneMap = map});
    EXPECT_EQ(bytes[0], 0);
    for (const std::size_t i : {1u, 2u, 4u, 5u}) EXPECT_GT(bytes[i], bytes[i == 4 ? 2 : i - 1]) << i;
    EXPECT_LT(bytes[4], 255) << "a white surface is not clipped";
  }
  // Narkowicz's fit of 0.5 is 0.6163; Hable's of 0.5 is 0.2193 / 0.7338 = 0.2988.
  EXPECT_EQ(writeAndRead({glm::vec4(glm::vec3(0.5f), 1.0f)}, {.toneMap = ToneMap::Aces})[0], 206);
  EXPECT_EQ(writeAndRead({glm::vec4(glm::vec3(5.6f), 1.0f)}, {.toneMap = ToneMap::Filmic})[0], 255);
}

TEST(Png, InMemoryIsWhatTheFileHolds) {
  const TemporaryFolder folder;
  Image image;
  image.size = {2, 1};
  image.pixels = {{0.5f, 0.18f, 0.002f, 1.0f}, {0.1f, 0.0f, 0.0f, 0.5f}};
  for (const DisplayLook& look : {DisplayLook{}, over(glm::vec3(0.25f))}) {
    writePng(folder / "a.png", image, look);
    const Bytes bytes = encodePng(image, look);
    EXPECT_EQ(readBytes(folder / "a.png"), std::string(bytes.begin(), bytes.end()));
    EXPECT_EQ(decodePng("a.png", bytes).pixels, readPng(folder / "a.png").pixels);
  }
}

TEST(Png, RowZeroIsTheTopAndSrgbIsDeclared) {
  const TemporaryFolder folder;
  Image image;
  image.size = {3, 2};
  image.pixels.assign(6, glm::vec4(0, 0, 0, 1));
  image.pixels[2] = {1, 0, 0, 1};  // top right
  writePng(folder / "a.png", image);
  const Png png = readStored(folder / "a.png");
  ASSERT_EQ(png.width, 3u);
  ASSERT_EQ(png.height, 2u);
  EXPECT_EQ(png.bytes[4 * 2], 255);
  EXPECT_EQ(png.bytes[4 * 5], 0);
  const std::string bytes = readBytes(folder / "a.png");
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
  writePng(folder / "b.png", image);
  EXPECT_EQ(readBytes(folder / "b.png"), bytes);
}

/// As libpng stores it, with sub-images where `interlace` says so. Rows of big-endian samples.
void writeStored(const std::filesystem::path& file, glm::ivec2 size, int depth, int type,
                 std::vector<std::uint8_t> bytes, int interlace = PNG_INTERLACE_NONE) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  ASSERT_NE(stream, nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, stream);
  png_set_IHDR(png, info, png_uint_32(size.x), png_uint_32(size.y), depth, type, interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[] = {{0, 255, 0}, {188, 0, 255}};
  png_byte transparency[] = {0, 255};
  if (type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette, 2);
    png_set_tRNS(png, info, transparency, 2, nullptr);
  }
  png_write_info(png, info);
  std::vector<png_bytep> rows;
  const std::size_t rowBytes = png_get_rowbytes(png, info);
  ASSERT_EQ(bytes.size(), rowBytes * std::size_t(size.y));
  for (std::size_t y = 0; y < std::size_t(size.y); ++y) rows.push_back(bytes.data() + y * rowBytes);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(stream);
}

void expectNear(const glm::vec4& pixel, const glm::vec4& expected) {
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(pixel[c], expected[c], 2e-6f) << "channel " << c;
}

TEST(PngInput, DecodesSrgbAndPremultiplies) {
  const TemporaryFolder folder;
  // By the curve of IEC 61966-2-1: byte 188 is 0.502886, 118 is 0.181164, 10 is 10 / 255 / 12.92 = 0.0030353.
  writeStored(folder / "a.png", {2, 1}, 8, PNG_COLOR_TYPE_RGB_ALPHA, {188, 118, 10, 51, 255, 0, 188, 0});
  const Image image = readPng(folder / "a.png");
  ASSERT_EQ(image.size, glm::ivec2(2, 1));
  EXPECT_TRUE(image.depth.empty());
  expectNear(image.pixels[0], {0.2f * 0.502886f, 0.2f * 0.181164f, 0.2f * 0.0030353f, 0.2f});
  expectNear(image.pixels[1], {0, 0, 0, 0});
}

TEST(PngInput, ReadsEveryKindOfFile) {
  const TemporaryFolder folder;
  const auto read = [&] { return readPng(folder / "a.png").pixels; };
  writeStored(folder / "a.png", {1, 1}, 8, PNG_COLOR_TYPE_RGB, {255, 0, 188});
  expectNear(read()[0], {1, 0, 0.502886f, 1});
  writeStored(folder / "a.png", {1, 1}, 8, PNG_COLOR_TYPE_GRAY, {118});
  expectNear(read()[0], {0.181164f, 0.181164f, 0.181164f, 1});
  writeStored(folder / "a.png", {1, 1}, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {255, 51});
  expectNear(read()[0], {0.2f, 0.2f, 0.2f, 0.2f});
  writeStored(folder / "a.png", {3, 1}, 1, PNG_COLOR_TYPE_GRAY, {0b01000000});
  EXPECT_EQ(read()[1], glm::vec4(1.0f));
  EXPECT_EQ(read()[2], glm::vec4(0, 0, 0, 1));
  writeStored(folder / "a.png", {2, 1}, 8, PNG_COLOR_TYPE_PALETTE, {1, 0});
  expectNear(read()[0], {0.502886f, 0, 1, 1});
  expectNear(read()[1], {0, 0, 0, 0});
  // 0x8000 of 16 bits is 0.500008, and 0.214048 in linear light; 0x0100 would be 1 if the bytes were swapped.
  writeStored(folder / "a.png", {1, 1}, 16, PNG_COLOR_TYPE_RGB, {0x80, 0x00, 0x01, 0x00, 0xff, 0xff});
  expectNear(read()[0], {0.214048f, 256.0f / 65535.0f / 12.92f, 1, 1});
}

TEST(PngInput, InterlacedRowsComeInOrder) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 9 * 11; ++i) bytes.push_back(std::uint8_t(2 * i));
  writeStored(folder / "a.png", {9, 11}, 8, PNG_COLOR_TYPE_GRAY, bytes);
  writeStored(folder / "b.png", {9, 11}, 8, PNG_COLOR_TYPE_GRAY, bytes, PNG_INTERLACE_ADAM7);
  const Image image = readPng(folder / "b.png");
  EXPECT_EQ(image.pixels, readPng(folder / "a.png").pixels);
  for (std::size_t i = 1; i < image.pixels.size(); ++i)
    ASSERT_GT(image.pixels[i].r, image.pixels[i - 1].r) << i;
}

TEST(PngInput, WhatWasReadIsWrittenAsTheSameBytes) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 256; ++i)
    for (const int value : {i, 255 - i, i / 2, 255}) bytes.push_back(std::uint8_t(value));
  writeStored(folder / "a.png", {16, 16}, 8, PNG_COLOR_TYPE_RGB_ALPHA, bytes);
  writePng(folder / "b.png", readPng(folder / "a.png"));
  EXPECT_EQ(readStored(folder / "b.png").bytes, bytes);
}

TEST(PngInput, RefusesMissingForeignAndTruncatedFiles) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> noise(64 * 64 * 3);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : noise) byte = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
  writeStored(folder / "a.png", {64, 64}, 8, PNG_COLOR_TYPE_RGB, noise);
  std::string whole = readBytes(folder / "a.png");
  test::writeBytes(folder / "text.png", "this is no image");
  test::writeBytes(folder / "empty.png", "");
  test::writeBytes(folder / "short.png", whole.substr(0, whole.size() / 2));
  test::writeBytes(folder / "header.png", whole.substr(0, 20));
  whole[whole.size() / 2] ^= 0x55;
  test::writeBytes(folder / "damaged.png", whole);
  for (const char* name :
       {"missing.png", "text.png", "empty.png", "short.png", "header.png", "damaged.png", ""}) {
    try {
      readPng(folder / name);
      ADD_FAILURE() << "no error for " << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_NE(std::string(error.what()).find((folder / name).string()), std::string::npos) << error.what();
    }
  }
}

TEST(ImageFile, IsReadByWhatItIsNotByItsName) {
  const TemporaryFolder folder;
  Image image;
  image.size = {2, 1};
  image.pixels = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  writePng(folder / "a.png", image);
  std::filesystem::rename(folder / "a.png", folder / "image.exr");
  EXPECT_EQ(readImage(folder / "image.exr").pixels, image.pixels);
  writeExr(folder / "b.exr", image, {});
  EXPECT_EQ(readImage(folder / "b.exr").pixels, image.pixels);
  test::writeBytes(folder / "text.png", "x");
  EXPECT_THROW(readImage(folder / "text.png"), Error);
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
    writePng(disk / "a.png", image);
  };
  EXPECT_EXIT(test::exitWithErrorOnLimitedDisk(folder.path(), 65536, write),
              testing::ExitedWithCode(int(ErrorKind::Output)),
              "cannot write '.*a.png': No space left on device");
}

TEST(Png, SixteenBitsHoldTheCurveToAStep) {
  const TemporaryFolder folder;
  Image image{.size = {256, 2}};
  for (int i = 0; i < 512; ++i) {
    const float light = std::pow(float(i) / 511.0f, 3.0f);
    image.pixels.emplace_back(light, 0.5f * light, 0.0f, 1.0f);
  }
  for (const DisplayLook& look : {DisplayLook{}, over(glm::vec3(0.0f))}) {
    writePng(folder / "a.png", image, look, 16);
    EXPECT_EQ(readBytes(folder / "a.png")[24], 16) << "bits a sample";
    const Image back = readPng(folder / "a.png");
    ASSERT_EQ(back.size, image.size);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      for (int c = 0; c < 4; ++c) {
        const float step = std::abs(srgbFromLinear(back.pixels[i][c]) - srgbFromLinear(image.pixels[i][c])) * 65535.0f;
        ASSERT_LE(step, 0.6f) << i << " " << c;
      }
  }
}

}  // namespace
}  // namespace freevoxels
