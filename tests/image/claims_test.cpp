// Images whose headers claim more than their files can hold are refused before memory is taken for them; images that shrink as far as
// their compression allows are read.

#include <ImfCompression.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>
#include <png.h>
#include <zlib.h>

#include <cstring>
#include <functional>
#include <limits>

#include "engine/image/exr_claims.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "tests/image/exr_parts.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using test::frameOf, test::headerOf, test::patched, test::placeOf, test::Window;
using test::TemporaryFolder;

constexpr int kBig = std::numeric_limits<int>::max();

/// Larger than what a small file holds, along one edge or both, at the origin and elsewhere.
const std::vector<Window> kWindows{{0, 0, 16383, 16383},
                                   {0, 0, 65535, 65535},
                                   {0, 0, 1 << 29, 0},
                                   {0, 0, 0, 1 << 29},
                                   {-(1 << 29), -(1 << 29), 1 << 29, 1 << 29},
                                   {1 << 20, 1 << 20, (1 << 20) + 40000, (1 << 20) + 40000},
                                   {std::numeric_limits<int>::min(), std::numeric_limits<int>::min(), kBig, kBig}};

TEST(Claims, ImagesOfOneValueAreReadWhateverTheirCompression) {
  const TemporaryFolder folder;
  const glm::ivec2 size(2048, 300);
  const std::vector<float> floats(std::size_t(size.x) * std::size_t(size.y), 0.25f);
  const std::vector<half> halves(floats.size(), half(0.25f));
  for (int compression = 0; compression < int(Imf::NUM_COMPRESSION_METHODS); ++compression)
    for (const bool isHalf : {true, false})
      for (const bool tiled : {false, true}) {
        const Imf::PixelType type = isHalf ? Imf::HALF : Imf::FLOAT;
        const Imf::FrameBuffer frame = isHalf ? frameOf(halves, size, type) : frameOf(floats, size, type);
        const std::string file = (folder / "a.exr").string();
        Imf::Header header = headerOf(size, type, compression);
        if (tiled) {
          header.setTileDescription(Imf::TileDescription(1024, 512));
          Imf::TiledOutputFile exr(file.c_str(), header);
          exr.setFrameBuffer(frame);
          exr.writeTiles(0, exr.numXTiles() - 1, 0, exr.numYTiles() - 1);
        } else {
          Imf::OutputFile exr(file.c_str(), header);
          exr.setFrameBuffer(frame);
          exr.writePixels(size.y);
        }
        SCOPED_TRACE(fmt::format("compression {}, half {}, tiled {}, {} bytes", compression, isHalf, tiled, fs::file_size(file)));
        const Image image = readExr(file);
        EXPECT_EQ(image.size, size);
        EXPECT_NEAR(image.pixels.back().g, 0.25f, 0.01f);
      }
}

TEST(Claims, ExrImagesThatTheirFileCannotHoldAreRefused) {
  const TemporaryFolder folder;
  for (int compression = 0; compression < int(Imf::NUM_COMPRESSION_METHODS); ++compression) {
    {
      const std::vector<half> halves(64 * 48, half(0.25f));
      Imf::OutputFile exr((folder / "a.exr").c_str(), headerOf({64, 48}, Imf::HALF, compression));
      exr.setFrameBuffer(frameOf(halves, {64, 48}, Imf::HALF));
      exr.writePixels(48);
    }
    const std::string bytes = test::readBytes(folder / "a.exr");
    for (const Window& window : kWindows) {
      test::writeBytes(folder / "b.exr", patched(bytes, "dataWindow", "box2i", window));
      SCOPED_TRACE(fmt::format("compression {}, window to {},{}", compression, window[2], window[3]));
      const bool isHalfGiB = compression >= 8 && window[2] == 16383;  // which its compression may shrink to a file of this size
      if (!isHalfGiB) test::expectRefusal([&] { checkExrClaims(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
      test::expectRefusal([&] { readExr(folder / "b.exr"); }, ErrorKind::Input, {"b.exr"});
    }
  }
}

TEST(Claims, TilesThatTheirFileCannotHoldAreRefused) {
  const TemporaryFolder folder;
  {
    Imf::Header header = headerOf({64, 48}, Imf::HALF, Imf::ZIP_COMPRESSION);
    header.setTileDescription(Imf::TileDescription(16, 16));
    const std::vector<half> halves(64 * 48, half(0.25f));
    Imf::TiledOutputFile exr((folder / "a.exr").c_str(), header);
    exr.setFrameBuffer(frameOf(halves, {64, 48}, Imf::HALF));
    exr.writeTiles(0, exr.numXTiles() - 1, 0, exr.numYTiles() - 1);
  }
  const std::string bytes = test::readBytes(folder / "a.exr");
  readExr(folder / "a.exr");
  for (const std::array<std::uint32_t, 2> tile : {std::array<std::uint32_t, 2>{1u << 20, 1u << 10}, {1u << 31, 1u}, {1u, 1u << 30}, {~0u, ~0u}}) {
    test::writeBytes(folder / "b.exr", patched(bytes, "tiles", "tiledesc", tile));
    test::expectRefusal([&] { readExr(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
  }
}

TEST(Claims, AHeaderWithAnAttributeTwiceIsRefused) {
  const TemporaryFolder folder;
  writeExr(folder / "a.exr", {.size = {4, 4}, .pixels = std::vector<glm::vec4>(16)}, {});
  std::string bytes = test::readBytes(folder / "a.exr");
  const std::size_t value = placeOf(bytes, "dataWindow", "box2i"), begin = bytes.find(std::string("dataWindow") + '\0');
  bytes.insert(begin, bytes.substr(begin, value + sizeof(Window) - begin));
  test::writeBytes(folder / "a.exr", bytes);
  test::expectRefusal([&] { readExr(folder / "a.exr"); }, ErrorKind::Input, {"a.exr", "'dataWindow' twice"});
}

FixedSums smallSums(bool gathered) {
  FixedSums sums{.size = {33, 24}, .first = {2, 1}, .extent = {5, 4}, .digits = {40, 40, 40, 43, 50, 38}};
  if (gathered) {
    SampleLattice lattice{.samples = latticeSamples({33, 24}, 0.5), .pitch = 0.5, .first = {-16.5, -12.0}, .depth = true};
    lattice.axes[2].along = {1.0, 0.0, 0.0};
    sums.lattice = lattice;
  }
  sums.method = "rays";
  sums.values.assign(sums.pixelCount() * kSumChannels, 1 << 20);
  return sums;
}

TEST(Claims, SumsThatTheirFileCannotHoldAreRefused) {
  const TemporaryFolder folder;
  for (const bool gathered : {false, true}) {
    writeSums(folder / "a.exr", smallSums(gathered), {});
    EXPECT_EQ(resolveSums(readSums(folder / "a.exr").sums, true).size, glm::ivec2(33, 24));
    const std::string bytes = test::readBytes(folder / "a.exr");
    for (const Window& window : kWindows) {
      std::string both = patched(bytes, "dataWindow", "box2i", window);
      both = patched(both, "displayWindow", "box2i", window);
      test::writeBytes(folder / "b.exr", both);
      test::expectRefusal([&] { holdsSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
      test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
    }
    const std::vector<Window> outside{{2, 1, 33, 4}, {2, 1, 6, 100}, {-1, 1, 6, 4}, {2, -1, 6, 4}, {6, 1, 2, 4}};
    for (const Window& window : outside) {
      if (gathered && window[2] == 33) continue;  // there are more samples than pixels
      test::writeBytes(folder / "b.exr", patched(bytes, "dataWindow", "box2i", window));
      test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr"});
    }
    for (const Window& window : {Window{0, 0, 16384, 23}, Window{0, 0, 32, 65535}, Window{1, 0, 32, 23}, Window{0, -1, 32, 23}, Window{0, 0, -1, 23}}) {
      test::writeBytes(folder / "b.exr", patched(bytes, "displayWindow", "box2i", window));
      test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr"});
    }
  }
}

/// Shares of large images: the finest lattice that a frame has is read, a finer one is refused.
TEST(Claims, LatticesFinerThanThoseOfFramesAreRefused) {
  const TemporaryFolder folder;
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2048, 2048), glm::ivec2(3000, 2000), glm::ivec2(4096, 4096), glm::ivec2(16384, 1),
                                glm::ivec2(8192, 16384), glm::ivec2(16384, 16384)}) {
    SCOPED_TRACE(fmt::format("{}x{} pixels", size.x, size.y));
    FixedSums sums = smallSums(true);
    sums.size = size;
    const auto writeOf = [&](double pitch) {
      sums.lattice->samples = latticeSamples(size, pitch);
      sums.lattice->pitch = pitch;
      sums.first = {0, 1};
      writeSums(folder / "a.exr", sums, {});
    };
    const double least = leastPitch(size);
    for (const double pitch : {least, 1.5 * least}) {
      writeOf(pitch);
      EXPECT_EQ(readSums(folder / "a.exr").sums.values, sums.values);
    }
    if (least == 0.5) continue;
    for (const double pitch : {0.5, least - 1.0 / 1024.0}) {
      writeOf(pitch);
      test::expectRefusal([&] { readSums(folder / "a.exr"); }, ErrorKind::Input, {"a.exr", "lattice"});
    }
  }
}

/// What OpenEXR itself can write: channels of few pixels in a large window, of another type, or not all of them.
TEST(Claims, SumsWithOtherChannelsAreRefusedBeforeTheyAreRead) {
  const TemporaryFolder folder;
  writeSums(folder / "a.exr", smallSums(false), {});
  const Imf::Header sound = Imf::InputFile((folder / "a.exr").c_str()).header();
  const auto expectOtherChannels = [&](glm::ivec2 size, const std::function<void(Imf::ChannelList&)>& change) {
    Imf::Header header = sound;
    header.displayWindow() = header.dataWindow() = {{0, 0}, {size.x - 1, size.y - 1}};
    change(header.channels());
    { const Imf::OutputFile exr((folder / "b.exr").c_str(), header); }
    test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "channels are not those of sums"});
  };
  for (const glm::ivec2 size : {glm::ivec2(64, 48), glm::ivec2(16384, 256)}) {
    expectOtherChannels({8, 8}, [](Imf::ChannelList& list) {
      Imf::ChannelList fewer;
      for (const char* name : {"energy.high", "energy.low"}) fewer.insert(name, list[name]);
      list = fewer;
    });
    expectOtherChannels({8, 8}, [](Imf::ChannelList& list) { list["red.low"].type = Imf::FLOAT; });
    expectOtherChannels(size, [&](Imf::ChannelList& list) {
      for (auto channel = list.begin(); channel != list.end(); ++channel) channel.channel().xSampling = size.x;
    });
    expectOtherChannels({8, 8}, [](Imf::ChannelList& list) {
      for (auto channel = list.begin(); channel != list.end(); ++channel) channel.channel().ySampling = 4;
    });
  }
}

/// The compressions that lose precision shrink floating-point numbers, not sums.
TEST(Claims, NoCompressionOfSumsClaimsMoreThanALosslessOne) {
  const TemporaryFolder folder;
  writeSums(folder / "a.exr", smallSums(false), {});
  const std::string bytes = test::readBytes(folder / "a.exr");
  for (std::uint8_t compression = 0; compression < std::uint8_t(Imf::NUM_COMPRESSION_METHODS); ++compression) {
    std::string changed = patched(bytes, "compression", "compression", compression);
    for (const char* window : {"dataWindow", "displayWindow"}) changed = patched(changed, window, "box2i", Window{0, 0, 16383, 16383});
    test::writeBytes(folder / "b.exr", changed + std::string(200'000, 'x'));
    test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
  }
}

TEST(Claims, ALatticeOfAnotherImageIsRefused) {
  const TemporaryFolder folder;
  writeSums(folder / "a.exr", smallSums(true), {});
  const std::string bytes = test::readBytes(folder / "a.exr");
  for (const Window& window : {Window{0, 0, 16383, 16383}, Window{0, 0, 32, 30}, Window{0, 0, 10, 10}}) {
    test::writeBytes(folder / "b.exr", patched(bytes, "displayWindow", "box2i", window));
    test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "lattice"});
  }
}

TEST(Claims, DigitsThatNoSumHasAreRefused) {
  const TemporaryFolder folder;
  writeSums(folder / "a.exr", smallSums(false), {});
  const std::string bytes = test::readBytes(folder / "a.exr");
  for (const char* channel : {"red", "green", "blue", "energy", "depth", "distance"})
    for (const std::int32_t digits : {std::numeric_limits<int>::min(), std::numeric_limits<int>::min() + 1, -513, 513, 100'000, kBig}) {
      test::writeBytes(folder / "b.exr", patched(bytes, fmt::format("freevoxels:digits.{}", channel), "int", digits));
      test::expectRefusal([&] { readSums(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "number of digits"});
    }
}

TEST(Claims, SumsWhoseSumWouldOverflowAreKnown) {
  FixedSums a = smallSums(false), b = a;
  EXPECT_TRUE(a.canAdd(b));
  for (const std::int64_t most : {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
    a.values.back() = most;
    b.values.back() = most > 0 ? 1 : -1;
    EXPECT_FALSE(a.canAdd(b));
    b.values.back() = 0;
    EXPECT_TRUE(a.canAdd(b));
  }
}

/// A PNG of one value, of any kind; libpng's own writer of rows.
void writePlainPng(const fs::path& file, glm::ivec2 size, int type, int bits, int interlace) {
  std::FILE* const stream = std::fopen(file.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, stream);
  png_set_IHDR(png, info, png_uint_32(size.x), png_uint_32(size.y), bits, type, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 9);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  png_write_info(png, info);
  const int passes = png_set_interlace_handling(png);
  const std::vector<png_byte> row(png_get_rowbytes(png, info), 0);
  for (int pass = 0; pass < passes; ++pass)
    for (int y = 0; y < size.y; ++y) png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(stream);
}

TEST(Claims, PngImagesOfOneValueAreReadAndLargerOnesThanTheirFileHoldsAreRefused) {
  const TemporaryFolder folder;
  struct Kind {
    int type, bits;
  };
  for (const Kind kind : {Kind{PNG_COLOR_TYPE_GRAY, 1}, Kind{PNG_COLOR_TYPE_GRAY, 16}, Kind{PNG_COLOR_TYPE_RGB, 8}, Kind{PNG_COLOR_TYPE_RGB_ALPHA, 16}})
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
      SCOPED_TRACE(fmt::format("type {}, {} bits, interlace {}", kind.type, kind.bits, interlace));
      writePlainPng(folder / "a.png", {1024, 600}, kind.type, kind.bits, interlace);
      EXPECT_EQ(readPng(folder / "a.png").pixels.size(), std::size_t(1024 * 600));
      writePlainPng(folder / "b.png", {20, 10}, kind.type, kind.bits, interlace);
      std::string bytes = test::readBytes(folder / "b.png");
      for (const std::array<std::uint8_t, 8> size : {std::array<std::uint8_t, 8>{0, 0, 0x7f, 0, 0, 0, 0x7f, 0}, {0x1f, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 0, 1, 0x0f, 0, 0, 0}}) {
        std::memcpy(&bytes[16], size.data(), size.size());
        const auto check = png_uint_32(crc32(0, reinterpret_cast<const Bytef*>(&bytes[12]), 17));
        for (int i = 0; i < 4; ++i) bytes[29 + std::size_t(i)] = char(check >> (24 - 8 * i));
        test::writeBytes(folder / "b.png", bytes);
        test::expectRefusal([&] { readPng(folder / "b.png"); }, ErrorKind::Input, {"b.png", "cannot hold"});
      }
    }
}

}  // namespace
}  // namespace freevoxels
