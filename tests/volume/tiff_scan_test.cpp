// Stacks of TIFF with channels and time.

#include <limits>

#include "engine/image/srgb.h"
#include "engine/volume/scan_file.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"
#include "tests/volume/tiff_fixture.h"

namespace freevoxels::test {

namespace {

Volume readTiff(const std::filesystem::path& file, ScanRequest request = {}) {
  request.maximumVoxels = std::uint64_t(1) << 40;
  return readScan(file, request);
}

void expectTiffRefusal(const std::filesystem::path& file, std::initializer_list<std::string> parts) {
  testing::internal::CaptureStderr();
  expectRefusal([&] { readTiff(file, {.array = "0"}); }, ErrorKind::Input, parts);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

constexpr const char* kImageJ = "ImageJ=1.54f\nimages=12\nchannels=2\nslices=3\nframes=2\nhyperstack=true\nunit=\\u00B5m\nspacing=0.5\n";

}  // namespace

TEST(TiffScan, HyperstacksOfImageJHaveChannelsFirst) {
  const TemporaryFolder folder;
  writeBytes(folder / "a.tif", TiffFixture{.pages = 12, .description = kImageJ, .resolution = {4, 1}}.bytes());
  const ScanHeader header = readScanHeader(folder / "a.tif", {});
  EXPECT_EQ(header.dimensions, glm::ivec3(4, 3, 3));
  EXPECT_EQ(header.channels.size(), 2u);
  EXPECT_EQ(header.timeSteps, 2);
  EXPECT_EQ(header.format, "TIFF of ImageJ");
  EXPECT_NEAR(header.indexToWorld[0][0], 0.25e-3, 1e-9);
  EXPECT_NEAR(header.indexToWorld[2][2], 0.5e-3, 1e-9);
  EXPECT_EQ(readTiff(folder / "a.tif", {.array = "1", .timeStep = 1}).scalar(2, 1, 2), 100.0f * (1 + 2 * (2 + 3 * 1)) + 6.0f);
  const Volume both =
      readTiff(folder / "a.tif", {.channels = {{.name = "1", .color = glm::vec3(1.0f, 0.0f, 0.0f), .window = std::array{0.0f, 1000.0f}}}});
  EXPECT_NEAR(both.scalar(2, 1, 2), 0.506f, 1e-6f);
}

TEST(TiffScan, ImagesBehindTheOnlyPageAreThoseOfImageJ) {
  const TemporaryFolder folder;
  TiffFixture stack{.description = kImageJ, .images = 12};
  writeBytes(folder / "a.tif", stack.bytes());
  EXPECT_EQ(readTiff(folder / "a.tif", {.array = "0", .timeStep = 1}).scalar(3, 2, 1), 100.0f * (2 * (1 + 3)) + 11.0f);
  stack.size = {40, 30};
  stack.images = 11;
  writeBytes(folder / "short.tif", stack.bytes());
  expectTiffRefusal(folder / "short.tif", {"short.tif", "bytes of values"});
}

TEST(TiffScan, OmeSaysTheOrderOfPagesColoursAndDistances) {
  const TemporaryFolder folder;
  const std::string xml = omeXml(
      "SizeZ=\"3\" SizeC=\"2\" SizeT=\"1\" DimensionOrder=\"XYZCT\" PhysicalSizeX=\"250\" PhysicalSizeXUnit=\"nm\" "
      "PhysicalSizeY=\"0.25\" PhysicalSizeZ=\"0.001\" PhysicalSizeZUnit=\"mm\"",
      "<Channel ID=\"Channel:0:0\" Name=\"DAPI\" Color=\"65535\"/><Channel ID=\"Channel:0:1\" Name=\"GFP\" "
      "Color=\"16711935\"/><TiffData/>");
  writeBytes(folder / "a.ome.tif", TiffFixture{.pages = 6, .description = xml}.bytes());
  const ScanHeader header = readScanHeader(folder / "a.ome.tif", {});
  ASSERT_EQ(header.channels.size(), 2u);
  EXPECT_EQ(header.channels[0].name, "DAPI");
  EXPECT_EQ(header.channels[0].color, glm::vec3(0.0f, 0.0f, 1.0f));
  EXPECT_EQ(header.channels[1].color, glm::vec3(0.0f, 1.0f, 0.0f));
  for (const auto& [axis, spacing] : {std::pair(0, 0.25e-3), std::pair(1, 0.25e-3), std::pair(2, 1e-3)})
    EXPECT_NEAR(header.indexToWorld[axis][axis], spacing, 1e-12);
  EXPECT_EQ(readTiff(folder / "a.ome.tif", {.array = "GFP"}).scalar(0, 0, 1), 100.0f * (3 + 1));
  EXPECT_EQ(stemOf(folder / "a.ome.tif"), "a");
}

TEST(TiffScan, WithoutAWindowTheNoiseOfTheBackgroundIsNotDrawn) {
  const TemporaryFolder folder;
  // Noise of -6 to 6 around 25, most often 25, and 225 in a tenth of the voxels.
  std::string values;
  for (int i = 0; i < 20 * 20 * 20; ++i) {
    const auto value = std::uint8_t(i % 10 == 0 ? 225 : 25 + (i % 13 - 6) * (i / 13 % 2));
    values += char(value);
  }
  writeBytes(folder / "a_20x20x20_uint8.raw", values);
  const Volume volume = readTiff(folder / "a_20x20x20_uint8.raw", {.channels = {{.name = "0"}}});
  EXPECT_EQ(volume.activeVoxels, 20u * 20u * 20u / 10u);
  EXPECT_NEAR(volume.minimum, 1.0f, 1e-3f);
}

TEST(TiffScan, OmeMayListThePageOfEachPlane) {
  const TemporaryFolder folder;
  const auto dataOf = [](int z, int page) {
    return "<TiffData FirstZ=\"" + std::to_string(z) + "\" IFD=\"" + std::to_string(page) + "\"/>";
  };
  const std::string sizes = "SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\" DimensionOrder=\"XYCZT\"";
  writeBytes(folder / "a.ome.tif",
             TiffFixture{.pages = 3, .description = omeXml(sizes, dataOf(0, 2) + dataOf(1, 1) + dataOf(2, 0))}.bytes());
  EXPECT_EQ(readTiff(folder / "a.ome.tif").scalar(0, 0, 0), 200.0f);
  writeBytes(folder / "b.ome.tif", TiffFixture{.pages = 3, .description = omeXml(sizes, dataOf(0, 2) + dataOf(1, 1))}.bytes());
  expectTiffRefusal(folder / "b.ome.tif", {"plane 2"});
}

TEST(TiffScan, FilesOfAFolderAreSlicesInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  const auto slices = folder / "slices";
  std::filesystem::create_directories(slices);
  for (int i = 0; i < 11; ++i)
    writeBytes(slices / ("slice_" + std::to_string(i) + ".tif"), TiffFixture{.resolution = {1, 2}, .unit = 3, .firstPage = i}.bytes());
  writeBytes(slices / "notes.txt", "nothing");
  const Volume volume = readTiff(slices);
  EXPECT_EQ(volume.dimensions, glm::ivec3(4, 3, 11));
  for (int z = 0; z < 11; ++z) EXPECT_EQ(volume.scalar(1, 0, z), 100.0f * float(z) + 1.0f);
  EXPECT_NEAR(volume.indexToWorld[0][0], 20.0, 1e-4) << "half a pixel per centimetre";
  EXPECT_NEAR(volume.indexToWorld[2][2], 20.0, 1e-4) << "cubes, where nothing is said of the distance";
  EXPECT_EQ(readScanHeader(slices, {}).format, "TIFF in 11 files");
  writeBytes(slices / "slice_4.tif", TiffFixture{.size = {5, 3}}.bytes());
  expectTiffRefusal(slices, {"slice_4.tif", "differ"});
}

TEST(TiffScan, WhereWhiteIsZeroValuesAreTurnedRound) {
  const TemporaryFolder folder;
  writeBytes(folder / "a.tif", TiffFixture{.pages = 2, .photometric = 0}.bytes());
  EXPECT_EQ(readTiff(folder / "a.tif").scalar(1, 0, 0), 65534.0f);
}

TEST(TiffScan, PhotographsAreColoursHoweverTheirPlanesLie) {
  const TemporaryFolder folder;
  for (const bool isPlanar : {false, true})
    for (const std::uint16_t samples : {std::uint16_t(3), std::uint16_t(4)}) {
      writeBytes(folder / "a.tif",
                 TiffFixture{.pages = 2, .samples = samples, .photometric = 2, .hasBytes = true, .isPlanar = isPlanar}.bytes());
      const Volume volume = readTiff(folder / "a.tif");
      ASSERT_TRUE(volume.albedo);
      const int first = 100 + samples * (2 + 4 * 1);  // of pixel (2, 1) of page 1
      glm::vec3 color;
      for (int c = 0; c < 3; ++c) color[c] = linearFromSrgb(float(first + c) / 255.0f);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(volume.albedo->values[std::size_t(c)].at({2, 1, 1}), color[c]);
      const float luminance = srgbFromLinear(glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f)));
      EXPECT_NEAR(volume.scalar(2, 1, 1), samples == 3 ? luminance : float(first + 3) / 255.0f, 1e-5f);
      EXPECT_EQ(readTiff(folder / "a.tif", {.array = "green"}).scalar(2, 1, 1), float(first + 1));
      EXPECT_EQ(readScanHeader(folder / "a.tif", {}).channels.size(), samples);
    }
  writeBytes(folder / "b.tif", TiffFixture{.pages = 2, .samples = 3, .photometric = 2, .size = {40, 30}}.bytes());
  EXPECT_NEAR(readTiff(folder / "b.tif").albedo->values[1].at({2, 1, 1}), (100.0f + 3.0f * 42.0f + 1.0f) / 65535.0f, 1e-7f)
      << "those of 16 bits are linear";
}

TEST(TiffScan, ColoursOfOneFileAreOneChannelOfOme) {
  const TemporaryFolder folder;
  const std::string xml = omeXml("SizeZ=\"2\" SizeC=\"3\" SizeT=\"1\" DimensionOrder=\"XYCZT\"",
                                 "<Channel ID=\"Channel:0:0\" SamplesPerPixel=\"3\"/><TiffData/>");
  writeBytes(folder / "a.ome.tif", TiffFixture{.pages = 2, .description = xml, .samples = 3, .photometric = 2, .hasBytes = true}.bytes());
  EXPECT_EQ(readTiff(folder / "a.ome.tif").dimensions, glm::ivec3(4, 3, 2));
  EXPECT_TRUE(readScanHeader(folder / "a.ome.tif", {}).areColors);
}

TEST(TiffScan, ColoursAreDividedByAnAssociatedOpacity) {
  const TemporaryFolder folder;
  for (const bool isPlanar : {false, true})
    for (const std::uint16_t extra : {std::uint16_t(0), std::uint16_t(1), std::uint16_t(2)}) {
      writeBytes(folder / "a.tif",
                 TiffFixture{.pages = 2, .samples = 4, .photometric = 2, .isPlanar = isPlanar, .extraSample = extra}.bytes());
      const Volume volume = readTiff(folder / "a.tif");
      ASSERT_TRUE(volume.albedo);
      for (int pixel = 0; pixel < 12; ++pixel)
        for (int c = 0; c < 3; ++c) {
          const int value = 100 + 4 * pixel + c, opacity = 100 + 4 * pixel + 3;  // of the second page
          const double expected = extra == 1 ? double(value) / opacity : value / 65535.0;
          EXPECT_NEAR(volume.albedo->values[std::size_t(c)].at({pixel % 4, pixel / 4, 1}), expected, 1.0 / 65535.0);
          EXPECT_NEAR(volume.scalar(pixel % 4, pixel / 4, 1), opacity / 65535.0, 1e-6);
        }
    }
}

TEST(TiffScan, LookUpTablesAndDisplayRangesOfImageJAreTheLooksOfChannels) {
  const TemporaryFolder folder;
  TiffFixture stack{.pages = 12, .description = kImageJ};
  for (const bool isBigEndian : {false, true}) {
    stack.metadata = ImageJMetadata({{255, 0, 0}, {0, 255, 255}}, isBigEndian, {{100.0, 900.5}, {-3.0, 0.25}});
    writeBytes(folder / "a.tif", stack.bytes());
    const ScanHeader header = readScanHeader(folder / "a.tif", {});
    ASSERT_EQ(header.channels.size(), 2u);
    EXPECT_EQ(header.channels[0].color, glm::vec3(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(header.channels[1].color, glm::vec3(0.0f, 1.0f, 1.0f));
    EXPECT_EQ(header.channels[0].window, (std::array{100.0f, 900.5f}));
    EXPECT_EQ(header.channels[1].window, (std::array{-3.0f, 0.25f}));
  }
  const auto expectNone = [&](const ImageJMetadata& metadata) {
    stack.metadata = metadata;
    writeBytes(folder / "a.tif", stack.bytes());
    const ScanChannel channel = readScanHeader(folder / "a.tif", {}).channels[0];
    EXPECT_FALSE(channel.color);
    EXPECT_FALSE(channel.window);
  };
  expectNone(ImageJMetadata({{255, 255, 255}, {255, 255, 255}}));
  expectNone(ImageJMetadata({{255, 0, 0}}));
  expectNone(ImageJMetadata({}, false, {{5.0, 5.0}, {0.0, std::numeric_limits<double>::quiet_NaN()}}));
  expectNone(ImageJMetadata({}, false, {{0.0, 1.0}}));
  ImageJMetadata damaged({{255, 0, 0}, {0, 255, 255}});
  damaged.counts.back() = 1u << 31;
  expectNone(damaged);
  damaged.counts = {5000};
  expectNone(damaged);
  damaged.counts = {28, 6};
  damaged.bytes.replace(8, 4, "\xff\xff\xff\xff");
  expectNone(damaged);
}

TEST(TiffScan, WrongDescriptionsAndPagesAreRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const TiffFixture& stack, std::initializer_list<std::string> parts) {
    writeBytes(folder / "a.tif", stack.bytes());
    expectTiffRefusal(folder / "a.tif", parts);
  };
  expect({.pages = 5, .description = kImageJ}, {"12 planes", "5 pages"});
  expect({.pages = 2, .description = "ImageJ=1\nimages=2\nchannels=-3\n"}, {"channels", "-3"});
  expect({.pages = 2, .description = "ImageJ=1\nimages=7\nchannels=2\nslices=3\n"}, {"7 images"});
  expect({.pages = 2, .description = "ImageJ=1\nimages=1048576\nchannels=1048576\nslices=1048576\nframes=1048576\n"}, {"planes"});
  expect({.pages = 2, .description = omeXml("SizeZ=\"x\" SizeC=\"1\" SizeT=\"1\"", "")}, {"SizeZ"});
  expect({.pages = 2, .description = omeXml("SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\" DimensionOrder=\"XYZZT\"", "")}, {"DimensionOrder"});
  expect({.pages = 2, .description = "<OME><Image>"}, {"XML"});
  const std::string ofTwo =
      "<TiffData IFD=\"0\"><UUID FileName=\"a.tif\"/></TiffData><TiffData FirstZ=\"1\" IFD=\"0\"><UUID FileName=\"b.tif\"/></TiffData>";
  expect({.pages = 2, .description = omeXml("SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\" DimensionOrder=\"XYZCT\"", ofTwo)}, {"2 files"});
  expect({.pages = 2, .samples = 2}, {"2 numbers a voxel", "colours"});
  expect({.pages = 2, .samples = 3}, {"3 numbers a pixel", "RGB"});
  expect({.pages = 2, .description = "ImageJ=1\nimages=2\nchannels=2\n", .samples = 3, .photometric = 2}, {"2 channels of colours"});
}

}  // namespace freevoxels::test
