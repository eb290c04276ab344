// Radiance pictures: all three kinds of rows, both orders of them, exposures, and files that are damaged.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/image/image.h"
#include "engine/scene/environment.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::TemporaryFolder;

/// Red, green, blue and exponent of a pixel, different for all of an image.
std::array<char, 4> pixelAt(int x, int y) {
  return {char(17 + 5 * (x / 3) + y), char(200 - x % 7), char(3 * y + 2), char(128 + (x + y) % 4)};
}

glm::vec4 colorAt(int x, int y) {
  const std::array<char, 4> pixel = pixelAt(x, y);
  const float scale = std::ldexp(1.0f, int(std::uint8_t(pixel[3])) - 136);
  const auto component = [&](std::size_t c) { return (float(std::uint8_t(pixel[c])) + 0.5f) * scale; };
  return {component(0), component(1), component(2), 1.0f};
}

std::string header(glm::ivec2 size, const std::string& lines = "", char sign = '-') {
  return fmt::format("#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n{}\n{}Y {} +X {}\n", lines, sign, size.y, size.x);
}

enum class Rows { Plain, ByComponent };

/// As a writer of each kind packs a row.
std::string row(int width, int y, Rows kind) {
  std::string bytes;
  if (kind == Rows::ByComponent) {
    bytes = {2, 2, char(width >> 8), char(width & 255)};
    for (std::size_t c = 0; c < 4; ++c)
      for (int x = 0; x < width;) {
        int run = 1;
        while (x + run < width && run < 127 && pixelAt(x + run, y)[c] == pixelAt(x, y)[c]) ++run;
        if (run > 2) {
          bytes += {char(128 + run), pixelAt(x, y)[c]};
        } else {
          bytes += char(run);
          for (int i = 0; i < run; ++i) bytes += pixelAt(x + i, y)[c];
        }
        x += run;
      }
    return bytes;
  }
  for (int x = 0; x < width; ++x) {
    const std::array<char, 4> pixel = pixelAt(x, y);
    bytes.append(pixel.begin(), pixel.end());
  }
  return bytes;
}

void expectImage(const Image& image, glm::ivec2 size) {
  ASSERT_EQ(image.size, size);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) ASSERT_EQ(image.pixels[std::size_t(y * size.x + x)], colorAt(x, y)) << x << ' ' << y;
}

class HdrTest : public testing::Test {
 protected:
  Image read(const std::string& bytes) const {
    test::writeBytes(folder / "a.hdr", bytes);
    EXPECT_EQ(isHdr(folder / "a.hdr"), true);
    return readImage(folder / "a.hdr");
  }
  void expectRefused(const std::string& bytes, const std::string& part) const {
    test::writeBytes(folder / "a.hdr", bytes);
    test::expectRefusal([&] { readHdr(folder / "a.hdr"); }, ErrorKind::Input, {"a.hdr", part});
  }
  const TemporaryFolder folder;
};

TEST_F(HdrTest, RowsOfEveryKindAreRead) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(7, 3), glm::ivec2(8, 4), glm::ivec2(300, 5), glm::ivec2(1024, 2)})
    for (const Rows kind : {Rows::Plain, Rows::ByComponent})
      for (const char sign : {'-', '+'}) {
        if (kind == Rows::ByComponent && size.x < 8) continue;
        std::string bytes = header(size, "", sign);
        for (int y = 0; y < size.y; ++y) bytes += row(size.x, sign == '-' ? y : size.y - 1 - y, kind);
        SCOPED_TRACE(fmt::format("{}x{} {}", size.x, size.y, int(kind)));
        expectImage(read(bytes), size);
      }
}

TEST_F(HdrTest, RepeatedPixelsOfOldFilesAreRead) {
  // 1 + 3 + 2 x 256 times the same pixel.
  const std::string bytes = header({516, 1}) + std::string("\x40\x50\x60\x81", 4) + std::string("\1\1\1\3", 4) + std::string("\1\1\1\2", 4);
  const Image image = read(bytes);
  for (const glm::vec4& pixel : image.pixels) EXPECT_EQ(pixel, (glm::vec4(64.5f, 80.5f, 96.5f, 128.0f) / 128.0f));
}

TEST_F(HdrTest, ExposuresAreTakenBack) {
  const std::string pixel("\x40\x50\x60\x81", 4);
  EXPECT_EQ(read(header({1, 1}, "EXPOSURE=4\nEXPOSURE= 0.5\n") + pixel).pixels[0],
            glm::vec4(glm::vec3(64.5f, 80.5f, 96.5f) / 256.0f, 1.0f));
  EXPECT_EQ(read(header({1, 1}, "EXPOSURE=nan\nEXPOSURE=0\n") + pixel).pixels[0], glm::vec4(glm::vec3(64.5f, 80.5f, 96.5f) / 128.0f, 1.0f));
}

TEST_F(HdrTest, WhiteSpaceOfHeadersMeansNothing) {
  const std::string pixel("\x40\x50\x60\x81", 4);
  for (const char* text : {"#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n", "#?RGBE\nFORMAT= 32-bit_rle_rgbe \n \n-Y 1 +X 1\n"})
    EXPECT_EQ(read(text + pixel).size, glm::ivec2(1)) << text;
}

TEST_F(HdrTest, ADarkPixelIsBlack) {
  EXPECT_EQ(read(header({1, 1}) + std::string("\x40\x50\x60\0", 4)).pixels[0], glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
}

TEST_F(HdrTest, DamagedFilesAreRefused) {
  const std::string pixels(4 * 64, '\x70');
  expectRefused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 2\n" + pixels, "32-bit_rle_xyze");
  expectRefused("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "does not end");
  expectRefused("#?RADIANCE\n" + std::string(100000, 'x'), "does not end");
  for (const char* layout : {"+X 2 -Y 2", "-Y 0 +X 2", "-Y 2 +X -2", "-Y 2 -X 2", "2 2", ""})
    expectRefused(fmt::format("#?RADIANCE\n\n{}\n", layout) + pixels, "laid out");
  expectRefused(header({8, 8}) + pixels.substr(0, 100), "ends early");
  expectRefused(header({1 << 30, 1 << 30}) + pixels, "too many");
  expectRefused(header({1 << 14, 1 << 14}) + pixels, "ends early");
  expectRefused(header({8, 1}) + std::string("\2\2\0\7", 4) + pixels, "another length");
  expectRefused(header({8, 1}) + std::string("\2\2\0\10\211\1", 6) + pixels, "longer than its row");
  expectRefused(header({8, 1}) + std::string("\2\2\0\10\0\1", 6) + pixels, "longer than its row");
  expectRefused(header({8, 1}) + std::string("\3\3\3\3\1\1\1\10", 8) + pixels, "longer than its row");
  expectRefused("P6\n2 2\n255\n" + pixels, "Radiance");
}

TEST_F(HdrTest, AnEnvironmentMayBeOne) {
  std::string bytes = header({16, 8});
  for (int y = 0; y < 8; ++y) bytes += row(16, y, Rows::ByComponent);
  test::writeBytes(folder / "sky.hdr", bytes);
  const Environment environment = readEnvironment(folder / "sky.hdr");
  EXPECT_EQ(environment.size, glm::ivec2(16, 8));
  EXPECT_EQ(environment.radiance[16 * 3 + 5], glm::vec3(colorAt(5, 3)));
}

}  // namespace
}  // namespace freevoxels
