// OpenEXR files of kinds that this project does not write: channels of few samples, tiles larger than the image, several parts. Sound ones
// are read, and what claims more than the file can hold is refused whatever kind the file is of.

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <half.h>

#include <functional>

#include "engine/image/exr_claims.h"
#include "engine/image/image.h"
#include "tests/image/exr_parts.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using test::frameOf, test::headerOf, test::patched, test::placeOf, test::Window;
using test::TemporaryFolder;

/// More channels of an image, of one value for several pixels.
struct SampledChannels {
  int count;
  Imf::PixelType type;
  int samplingX, samplingY;
};

void writeWithSampled(const fs::path& file, glm::ivec2 size, int compression, const SampledChannels& sampled, const std::vector<half>& halves) {
  Imf::Header header = headerOf(size, Imf::HALF, compression);
  Imf::FrameBuffer frame = frameOf(halves, size, Imf::HALF);
  const std::vector<float> others(halves.size(), 0.0f);
  const std::size_t bytes = sampled.type == Imf::FLOAT ? sizeof(float) : sizeof(half);
  for (int i = 0; i < sampled.count; ++i) {
    const std::string name = fmt::format("sampled.{}", i);
    header.channels().insert(name, Imf::Channel(sampled.type, sampled.samplingX, sampled.samplingY));
    frame.insert(name, Imf::Slice(sampled.type, reinterpret_cast<char*>(const_cast<float*>(others.data())), bytes,
                                  bytes * std::size_t(size.x / sampled.samplingX), sampled.samplingX, sampled.samplingY));
  }
  Imf::OutputFile exr(file.c_str(), header);
  exr.setFrameBuffer(frame);
  exr.writePixels(size.y);
}

TEST(ExrKinds, ImagesWithChannelsOfFewerSamplesThanPixelsAreRead) {
  const TemporaryFolder folder;
  for (int compression = 0; compression < int(Imf::NUM_COMPRESSION_METHODS); ++compression)
    for (const glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(192, 320)})
      for (const SampledChannels& sampled : {SampledChannels{2, Imf::HALF, 2, 2}, {8, Imf::FLOAT, 1, 64}, {8, Imf::FLOAT, 64, 1}, {20, Imf::HALF, 32, 64}})
        for (const bool noisy : {false, true}) {
          SCOPED_TRACE(fmt::format("compression {}, {}x{} pixels, sampling {}x{}, noisy {}", compression, size.x, size.y, sampled.samplingX, sampled.samplingY, noisy));
          std::vector<half> halves(std::size_t(size.x) * std::size_t(size.y), half(0.25f));
          for (std::size_t i = 0; noisy && i < halves.size(); ++i) halves[i] = half(float(i * 7919 % 1021) / 1024.0f);
          writeWithSampled(folder / "a.exr", size, compression, sampled, halves);
          const Image image = readExr(folder / "a.exr");
          EXPECT_EQ(image.size, size);
          EXPECT_NEAR(image.pixels.back().r, float(halves.back()), 0.05f);
        }
}

TEST(ExrKinds, ImagesOfOneTileThatIsLargerAreRead) {
  const TemporaryFolder folder;
  for (int compression = 0; compression < int(Imf::NUM_COMPRESSION_METHODS); ++compression)
    for (const glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(33, 7), glm::ivec2(1, 300)})
      for (const glm::ivec2 tile : {glm::ivec2(4096, 4096), glm::ivec2(1 << 20, 8), glm::ivec2(64, 512)}) {
        SCOPED_TRACE(fmt::format("compression {}, {}x{} pixels, tile {}x{}", compression, size.x, size.y, tile.x, tile.y));
        Imf::Header header = headerOf(size, Imf::HALF, compression);
        header.setTileDescription(Imf::TileDescription(unsigned(tile.x), unsigned(tile.y)));
        const std::vector<half> halves(std::size_t(size.x) * std::size_t(size.y), half(0.25f));
        {
          Imf::TiledOutputFile exr((folder / "a.exr").c_str(), header);
          exr.setFrameBuffer(frameOf(halves, size, Imf::HALF));
          exr.writeTiles(0, exr.numXTiles() - 1, 0, exr.numYTiles() - 1);
        }
        const Image image = readExr(folder / "a.exr");
        EXPECT_EQ(image.size, size);
        EXPECT_NEAR(image.pixels.back().g, 0.25f, 0.01f);
      }
}

/// Of two parts: an image, and eight channels of deep samples of another size, of which there are none.
void writeWithDeepPart(const fs::path& file, glm::ivec2 size, glm::ivec2 deepSize, const std::function<void(Imf::Header&)>& change) {
  std::array<Imf::Header, 2> headers{headerOf(size, Imf::HALF, Imf::ZIP_COMPRESSION), Imf::Header(deepSize.x, deepSize.y)};
  headers[0].setType(Imf::SCANLINEIMAGE);
  headers[0].setName("image");
  change(headers[0]);
  headers[1].setType(Imf::DEEPSCANLINE);
  headers[1].setName("deep");
  headers[1].displayWindow() = headers[0].displayWindow();
  headers[1].compression() = Imf::NO_COMPRESSION;
  std::vector<std::uint32_t> counts(std::size_t(deepSize.x) * std::size_t(deepSize.y), 0);
  std::vector<float*> samples(counts.size(), nullptr);
  const auto width = std::size_t(deepSize.x);
  Imf::DeepFrameBuffer deepFrame;
  deepFrame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(std::uint32_t), sizeof(std::uint32_t) * width));
  for (int i = 0; i < 8; ++i) {
    headers[1].channels().insert(fmt::format("channel.{}", i), Imf::Channel(Imf::FLOAT));
    deepFrame.insert(fmt::format("channel.{}", i),
                     Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float*), sizeof(float*) * width, sizeof(float)));
  }
  Imf::MultiPartOutputFile exr(file.c_str(), headers.data(), int(headers.size()));
  const std::vector<half> halves(std::size_t(size.x) * std::size_t(size.y), half(0.25f));
  Imf::OutputPart image(exr, 0);
  image.setFrameBuffer(frameOf(halves, size, Imf::HALF));
  image.writePixels(size.y);
  Imf::DeepScanLineOutputPart deep(exr, 1);
  deep.setFrameBuffer(deepFrame);
  deep.writePixels(deepSize.y);
}

TEST(ExrKinds, ImagesBesidePartsOfFewDeepSamplesAreRead) {
  const TemporaryFolder folder;
  for (const glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(5, 300)})
    for (const glm::ivec2 deepSize : {glm::ivec2(64, 48), glm::ivec2(512, 256)}) {
      writeWithDeepPart(folder / "a.exr", size, deepSize, [](Imf::Header&) {});
      EXPECT_EQ(readExr(folder / "a.exr").size, size);
      // The table of chunks of every part is read, not only that of the first one.
      std::string bytes = test::readBytes(folder / "a.exr");
      const std::size_t second = placeOf(bytes, "channels", "chlist") + 100;
      const Window tall{0, 0, 0, 1 << 29};
      std::memcpy(&bytes[second + placeOf(bytes.substr(second), "dataWindow", "box2i")], &tall, sizeof(tall));
      test::writeBytes(folder / "b.exr", bytes);
      test::expectRefusal([&] { checkExrClaims(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
    }
}

/// Only the version of a file, or the type of one of its parts, says that there are tiles.
TEST(ExrKinds, TilesOfFilesWithoutTilesAreIgnored) {
  const TemporaryFolder folder;
  const glm::ivec2 size(64, 48);
  const std::vector<half> halves(64 * 48, half(0.25f));
  for (const std::uint32_t edge : {1u, 16u, 1000u, 1u << 20}) {
    const auto withTiles = [&](Imf::Header& header) {
      header.compression() = Imf::DWAB_COMPRESSION;
      header.setTileDescription(Imf::TileDescription(edge, edge));
    };
    for (const char* type : {"", "tiledimage", "scanlineimage"}) {
      Imf::Header header = headerOf(size, Imf::HALF, Imf::DWAB_COMPRESSION);
      withTiles(header);
      if (*type != '\0') header.setType(type);
      const fs::path file = folder / fmt::format("a{}.exr", type);
      {
        Imf::OutputFile exr(file.c_str(), header);
        exr.setFrameBuffer(frameOf(halves, size, Imf::HALF));
        exr.writePixels(size.y);
      }
      std::string bytes = test::readBytes(file);
      bytes[5] = 0;  // OpenEXR says that such a file has tiles
      test::writeBytes(file, bytes);
    }
    writeWithDeepPart(folder / "a parts.exr", size, {8, 8}, withTiles);
    for (const char* name : {"", "tiledimage", "scanlineimage", " parts"}) {
      SCOPED_TRACE(fmt::format("tiles of {}, file '{}'", edge, name));
      const fs::path file = folder / fmt::format("a{}.exr", name);
      EXPECT_EQ(readExr(file).size, size);
      const std::string bytes = test::readBytes(file);
      ASSERT_NE(bytes.find(std::string("tiles") + '\0'), std::string::npos);
      for (const Window& wide : {Window{0, 0, 199'999'999, 0}, Window{-50'000'000, 3, 50'000'000, 10}}) {
        test::writeBytes(folder / "b.exr", patched(bytes, "dataWindow", "box2i", wide) + std::string(20'000, 'x'));
        test::expectRefusal([&] { checkExrClaims(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", "cannot hold"});
      }
    }
  }
}

/// Colours of few samples do not vouch for the size of the image.
TEST(ExrKinds, ImagesOfFewerColoursThanPixelsAreRefusedBeforeTheyAreRead) {
  const TemporaryFolder folder;
  for (const char* name : {"R", "G", "B", "A", "Z"})
    for (const glm::ivec2 sampling : {glm::ivec2(2, 1), glm::ivec2(1, 2), glm::ivec2(64, 64)}) {
      Imf::Header header = headerOf({64, 64}, Imf::HALF, Imf::ZIP_COMPRESSION);
      header.channels().insert(name, Imf::Channel(Imf::HALF, sampling.x, sampling.y));
      { const Imf::OutputFile exr((folder / "b.exr").c_str(), header); }
      test::expectRefusal([&] { readExr(folder / "b.exr"); }, ErrorKind::Input, {"b.exr", fmt::format("channel {} has fewer samples", name)});
    }
}

}  // namespace
}  // namespace freevoxels
