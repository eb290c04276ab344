// OME-Zarr of versions 0.4 and 0.5.

#include <glm/gtc/packing.hpp>

#include "engine/image/srgb.h"
#include "engine/volume/chunk_codecs.h"
#include "engine/volume/scan_file.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"
#include "tests/volume/zarr_fixture.h"

namespace freevoxels::test {

namespace {

using nlohmann::json;

std::filesystem::path writeZarr(const std::filesystem::path& folder, const ZarrFiles& files) {
  for (const auto& [name, bytes] : files) {
    std::filesystem::create_directories((folder / name).parent_path());
    writeBytes(folder / name, bytes);
  }
  return folder;
}

Volume readZarr(const std::filesystem::path& file, ScanRequest request = {.array = "1"}) {
  request.maximumVoxels = std::uint64_t(1) << 40;
  return readScan(file, request);
}

/// Whether channel 1 of a file has the values of the fixture.
void expectValues(const std::filesystem::path& file, const ZarrFixture& array = {}) {
  SCOPED_TRACE(file.string());
  testing::internal::CaptureStderr();
  const Volume volume = readZarr(file);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(volume.dimensions, glm::ivec3(array.shape[3], array.shape[2], array.shape[1]));
  for (int z = 0; z < array.shape[1]; ++z)
    for (int y = 0; y < array.shape[2]; ++y)
      for (int x = 0; x < array.shape[3]; ++x)
        ASSERT_EQ(volume.scalar(x, y, z), float(array.valueAt({1, z, y, x}))) << x << " " << y << " " << z;
}

void expectZarrRefusal(const std::filesystem::path& file, ErrorKind kind, std::initializer_list<std::string> parts,
                       const ScanRequest& request = {.array = "1"}) {
  testing::internal::CaptureStderr();
  expectRefusal([&] { readZarr(file, request); }, kind, parts);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

json codecOf(const char* name, const json& configuration = json::object()) {
  return {{"name", name}, {"configuration", configuration}};
}

/// Bytes in this order, then the codecs.
json codecsOf(std::initializer_list<json> more, const char* endian = "little") {
  json codecs{codecOf("bytes", {{"endian", endian}})};
  for (const json& one : more) codecs.push_back(one);
  return codecs;
}

/// A hierarchy of one level.
ZarrFiles secondOf(const ZarrFixture& array, const json& more = json::object()) {
  ZarrFiles files;
  array.addSecond(files, "0", more);
  addImage(files, {{"multiscales", multiscalesOf(1)}});
  return files;
}

ZarrFiles thirdOf(const ZarrFixture& array, const json& codecs, std::array<int, 4> perShard = {1, 1, 1, 1},
                  const json& more = json::object()) {
  ZarrFiles files;
  array.addThird(files, "0", codecs, perShard, more);
  addImage(files, {{"version", "0.5"}, {"multiscales", multiscalesOf(1)}}, true);
  return files;
}

}  // namespace

TEST(NgffScan, ChecksumsAreThoseOfCastagnoli) {
  const std::string text = "123456789";  // of RFC 3720
  EXPECT_EQ(crc32cOf(std::as_bytes(std::span(text))), 0xe3069283u);
}

TEST(NgffScan, EveryCodecOfZarr2) {
  const TemporaryFolder folder;
  ZarrFixture array;
  expectValues(writeZarr(folder / "raw.zarr", secondOf(array)));
  expectValues(writeZarr(folder / "dots.zarr", secondOf(array, {{"dimension_separator", "."}})));
  array.pack = zstdOf;
  expectValues(writeZarr(folder / "zstd.zarr", secondOf(array, {{"compressor", {{"id", "zstd"}, {"level", 3}}}})));
  array.pack = [](const std::string& bytes) { return deflateOf(bytes, 31); };
  expectValues(writeZarr(folder / "gzip.zarr", secondOf(array, {{"compressor", {{"id", "gzip"}}}})));
  array.pack = [](const std::string& bytes) { return deflateOf(bytes, 15); };
  expectValues(writeZarr(folder / "zlib.zarr", secondOf(array, {{"compressor", {{"id", "zlib"}}}})));
  for (const char* compressor : {"blosclz", "lz4", "zlib", "zstd"})
    for (const int shuffle : {BLOSC_NOSHUFFLE, BLOSC_SHUFFLE, BLOSC_BITSHUFFLE}) {
      array.pack = [&](const std::string& bytes) { return bloscOf(bytes, compressor, shuffle); };
      const std::string name = std::string(compressor) + std::to_string(shuffle) + ".zarr";
      expectValues(writeZarr(folder / name, secondOf(array, {{"compressor", {{"id", "blosc"}, {"cname", compressor}}}})));
    }
}

TEST(NgffScan, Zarr3WithShardsChecksumsAndTransposes) {
  const TemporaryFolder folder;
  ZarrFixture array;
  expectValues(writeZarr(folder / "raw.zarr", thirdOf(array, codecsOf({}))));
  expectValues(writeZarr(folder / "raw_shards.zarr", thirdOf(array, codecsOf({}), {2, 2, 1, 3})));
  array.pack = [](const std::string& bytes) { return withCrc32c(zstdOf(bytes)); };
  expectValues(writeZarr(folder / "checked.zarr", thirdOf(array, codecsOf({codecOf("zstd"), codecOf("crc32c")}))));
  array.pack = [](const std::string& bytes) { return bloscOf(bytes, "lz4", BLOSC_BITSHUFFLE); };
  expectValues(writeZarr(folder / "shards.zarr", thirdOf(array, codecsOf({codecOf("blosc")}), {1, 3, 2, 2})));
  array.pack = [](const std::string& bytes) { return deflateOf(bytes, 31); };
  array.isReversed = true;
  json codecs = codecsOf({codecOf("gzip")});
  codecs.insert(codecs.begin(), codecOf("transpose", {{"order", {3, 2, 1, 0}}}));
  expectValues(writeZarr(folder / "transposed.zarr", thirdOf(array, codecs)));
  expectValues(writeZarr(folder / "fortran.zarr", secondOf(array, {{"order", "F"}, {"compressor", {{"id", "gzip"}}}})));
}

TEST(NgffScan, EveryTypeOfValueInBothOrdersOfBytes) {
  const TemporaryFolder folder;
  ZarrFixture array{.shape = {2, 2, 3, 4}, .chunk = {1, 2, 2, 4}};
  array.valueAt = [](ZarrPlace v) { return 3 + v[3] + 4 * v[2] + 12 * v[1] + 50 * v[0]; };
  const auto expectType = [&](const std::string& second, const std::string& third, const auto& typed) {
    for (const bool isBig : {false, true}) {
      array.append = [&](std::string& bytes, int value) { appendTo(bytes, std::decay_t<decltype(typed)>(value), isBig); };
      const std::string order = isBig ? ">" : "<";
      expectValues(writeZarr(folder / (third + order + "2.zarr"), secondOf(array, {{"dtype", order + second}})), array);
      expectValues(writeZarr(folder / (third + order + "3.zarr"),
                             thirdOf(array, codecsOf({}, isBig ? "big" : "little"), {1, 1, 1, 1}, {{"data_type", third}})),
                   array);
    }
  };
  expectType("u1", "uint8", std::uint8_t());
  expectType("i1", "int8", std::int8_t());
  expectType("u2", "uint16", std::uint16_t());
  expectType("i2", "int16", std::int16_t());
  expectType("u4", "uint32", std::uint32_t());
  expectType("i4", "int32", std::int32_t());
  expectType("u8", "uint64", std::uint64_t());
  expectType("i8", "int64", std::int64_t());
  expectType("f4", "float32", float());
  expectType("f8", "float64", double());
  array.append = [](std::string& bytes, int value) { appendTo(bytes, glm::packHalf1x16(float(value)), true); };
  expectValues(writeZarr(folder / "half.zarr", secondOf(array, {{"dtype", ">f2"}})), array);
  array.valueAt = [](ZarrPlace v) { return int((v[3] + v[2]) % 2 == 0); };
  array.append = [](std::string& bytes, int value) { bytes += char(value); };
  expectValues(writeZarr(folder / "bool.zarr", secondOf(array, {{"dtype", "|b1"}})), array);
}

TEST(NgffScan, UnitsScalesAndTranslationsPlaceTheVoxels) {
  const TemporaryFolder folder;
  ZarrFiles files = secondOf({});
  const Volume volume = readZarr(writeZarr(folder / "a.zarr", files));
  for (const auto& [axis, spacing, origin] : {std::tuple(0, 0.25e-3, 30e-3), std::tuple(1, 0.25e-3, 20e-3), std::tuple(2, 0.5e-3, 10e-3)}) {
    EXPECT_NEAR(volume.indexToWorld[axis][axis], spacing, 1e-12);
    EXPECT_NEAR(volume.indexToWorld[3][axis], origin, 1e-12);
  }
  EXPECT_EQ(volume.up, glm::dvec3(0.0, 0.0, 1.0));
  json images = multiscalesOf(1);
  images[0]["coordinateTransformations"] = {{{"type", "scale"}, {"scale", {1.0, 2.0, 1.0, 1.0}}}};
  addImage(files, {{"multiscales", images}});
  const ScanHeader scaled = readScanHeader(writeZarr(folder / "b.zarr", files), {});
  EXPECT_NEAR(scaled.indexToWorld[2][2], 1e-3, 1e-12);
  EXPECT_NEAR(scaled.indexToWorld[3][2], 20e-3, 1e-12) << "what holds for all levels comes after what is of one";
  EXPECT_EQ(readZarr(folder / "a.zarr", {.array = "0", .spacing = glm::dvec3(1.0, 2.0, 3.0)}).indexToWorld[2][2], 3.0);
}

TEST(NgffScan, LevelsAreChosenByTheImageOrByTheirNumber) {
  const TemporaryFolder folder;
  ZarrFiles files;
  ZarrFixture array{.shape = {1, 8, 16, 16}, .chunk = {1, 8, 16, 16}};
  array.addSecond(files, "0");
  array.shape = {1, 8, 8, 8};
  array.addSecond(files, "1");
  addImage(files, {{"multiscales", multiscalesOf(2)}});
  const auto file = writeZarr(folder / "a.ome.zarr", files);
  EXPECT_EQ(readZarr(file, {.imageEdge = 11}).dimensions.x, 16) << "at most 1.5 voxels a pixel";
  const Volume coarse = readZarr(file, {.imageEdge = 10});
  EXPECT_EQ(coarse.dimensions, glm::ivec3(8));
  EXPECT_NEAR(coarse.indexToWorld[0][0], 0.5e-3, 1e-12);
  ASSERT_FALSE(coarse.remarks.empty());
  EXPECT_NE(coarse.remarks[0].find("level 1"), std::string::npos);
  EXPECT_EQ(readZarr(file, {.pyramidLevel = 0, .imageEdge = 2}).dimensions.x, 16);
  EXPECT_EQ(readScanHeader(file, {}).levels, (std::vector{glm::ivec3(16, 16, 8), glm::ivec3(8)}));
  EXPECT_EQ(readScanHeader(file, {}).format, "OME-Zarr 0.4");
  expectZarrRefusal(file, ErrorKind::Usage, {"pyramid-level", "2 levels"}, {.pyramidLevel = 2});
}

TEST(NgffScan, ChannelsHaveTheirColoursAndWindows) {
  const TemporaryFolder folder;
  ZarrFiles files = secondOf({});
  const json omero{{"channels",
                    {omeroChannel("DAPI", "0000FF", true, 0, 4000), omeroChannel("GFP", "00FF00", false, 0, 1),
                     omeroChannel("mCherry", "FF0000", true, 1000, 3000)}}};
  addImage(files, {{"multiscales", multiscalesOf(1)}, {"omero", omero}});
  const auto file = writeZarr(folder / "a.zarr", files);
  const Volume shown = readZarr(file, {});
  const ZarrFixture array;
  const double blue = array.valueAt({0, 4, 6, 10}) / 4000.0, red = (array.valueAt({2, 4, 6, 10}) - 1000) / 2000.0;
  EXPECT_NEAR(shown.scalar(10, 6, 4), blue + red, 1e-6);
  EXPECT_NEAR(shown.albedo->values[0].at({10, 6, 4}), red / (blue + red), 1e-6);
  EXPECT_EQ(shown.albedo->values[1].at({10, 6, 4}), 0.0f) << "the file does not show it";
  const Volume chosen = readZarr(file, {.channels = {{.name = "GFP", .window = std::array{0.0f, 2000.0f}}}});
  EXPECT_NEAR(chosen.scalar(10, 6, 4), array.valueAt({1, 4, 6, 10}) / 2000.0, 1e-6);
  EXPECT_EQ(chosen.albedo->values[1].at({10, 6, 4}), 1.0f) << "the file's colour";
  EXPECT_EQ(readZarr(file, {.array = "mCherry"}).scalar(0, 0, 0), float(array.valueAt({2, 0, 0, 0}))) << "one alone is a scan";
  EXPECT_EQ(scanChannels(file, {}).size(), 2u);
  EXPECT_TRUE(scanChannels(file, {.array = "GFP"}).empty());
  expectZarrRefusal(file, ErrorKind::Input, {"0 'DAPI', 1 'GFP'", "Cy5"}, {.channels = {{.name = "Cy5"}}});
  const Labels labels;
  expectZarrRefusal(file, ErrorKind::Usage, {"labels", "grid"}, {.labels = &labels});
}

TEST(NgffScan, AClipBoxReadsItsChunksAlone) {
  const TemporaryFolder folder;
  const ZarrFixture array;  // with chunks of 2 x 4 x 5 voxels along z, y and x
  const auto expectPart = [&](const std::string& name, ZarrFiles files, const std::string& needed, const VoxelBox& box) {
    SCOPED_TRACE(name);
    for (auto& [chunk, bytes] : files)
      if (chunk.starts_with("0/") && chunk.find("zar") == std::string::npos && chunk != needed) bytes = "damaged";
    const auto file = writeZarr(folder / name, files);
    const Volume part = readZarr(file, {.array = "1", .clipBox = box});
    const glm::ivec3 size = glm::min(box.last, glm::ivec3(10, 6, 4)) - box.first + 1;
    ASSERT_EQ(part.dimensions, size);
    EXPECT_TRUE(part.isPart);
    EXPECT_EQ(part.indexOrigin, box.first);
    EXPECT_NEAR(part.indexToWorld[3][0], 30e-3 + box.first.x * 0.25e-3, 1e-12);
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          EXPECT_EQ(part.scalar(x, y, z), float(array.valueAt({1, box.first.z + z, box.first.y + y, box.first.x + x})));
  };
  expectPart("chunks.zarr", secondOf(array), "0/1/0/1/1", {{6, 5, 0}, {8, 99, 1}});
  expectPart("shards.zarr", thirdOf(array, codecsOf({}), {1, 2, 1, 2}), "0/c/1/0/1/0", {{6, 5, 1}, {8, 6, 3}});
  expectZarrRefusal(folder / "chunks.zarr", ErrorKind::Usage, {"clip-box", "11 x 7 x 5"},
                    {.array = "1", .clipBox = VoxelBox{{11, 0, 0}, {20, 9, 9}}});
}

TEST(NgffScan, ASmallClipBoxShowsAFinerLevel) {
  const TemporaryFolder folder;
  ZarrFiles files;
  ZarrFixture{.shape = {2, 8, 64, 64}, .chunk = {1, 8, 16, 16}}.addSecond(files, "0");
  ZarrFixture{.shape = {2, 8, 32, 32}, .chunk = {1, 8, 16, 16}}.addSecond(files, "1");
  ZarrFixture{.shape = {2, 8, 16, 16}, .chunk = {1, 8, 16, 16}}.addSecond(files, "2");
  addImage(files, {{"multiscales", multiscalesOf(3)}});
  const auto file = writeZarr(folder / "a.zarr", files);
  const auto headerOf = [&](ScanRequest request) {
    request.array = "0";
    request.maximumVoxels = 1 << 30;
    return readScanHeader(file, request);
  };
  const VoxelBox box{{20, 21, 2}, {31, 40, 5}};
  EXPECT_EQ(headerOf({.imageEdge = 14}).level, 2);
  EXPECT_EQ(headerOf({.imageEdge = 14, .clipBox = box}).level, 0);
  EXPECT_EQ(headerOf({.imageEdge = 14, .clipBox = box}).part, box);
  EXPECT_EQ(headerOf({.imageEdge = 8, .clipBox = box}).level, 1);
  EXPECT_EQ(headerOf({.imageEdge = 8, .clipBox = box}).part, (VoxelBox{{10, 10, 2}, {15, 20, 5}})) << "the box counts voxels of level 0";
  EXPECT_EQ(headerOf({.pyramidLevel = 1, .clipBox = box}).part, (VoxelBox{{20, 21, 2}, {31, 31, 5}})) << "unless a level is given";
  EXPECT_EQ(headerOf({.memoryBytes = 4 * 6 * 4 * 8 * 32 * 32}).level, 1);
  EXPECT_EQ(headerOf({.memoryBytes = 1}).level, 2);
}

TEST(NgffScan, ChannelsThatAreRedGreenAndBlueAreColours) {
  const TemporaryFolder folder;
  ZarrFixture array{.valueAt = [](ZarrPlace v) { return (1 + v[3] + 11 * v[2] + 77 * v[1] + 50 * v[0]) % 256; },
                    .append = [](std::string& bytes, int value) { bytes += char(value); }};
  const auto fileOf = [&](const std::string& name, const json& channels) {
    ZarrFiles files = secondOf(array, {{"dtype", "|u1"}});
    addImage(files, {{"multiscales", multiscalesOf(1)}, {"omero", {{"channels", channels}}}});
    return writeZarr(folder / name, files);
  };
  const json whole{omeroChannel("0", "FF0000", true, 0, 255), omeroChannel("1", "00FF00", true, 0, 255),
                   omeroChannel("2", "0000FF", true, 0, 255)};
  for (const auto& file : {fileOf("a.zarr", whole), fileOf("b.zarr", {{{"label", "Red"}}, {{"label", "Green"}}, {{"label", "Blue"}}})}) {
    const Volume volume = readZarr(file, {});
    ASSERT_TRUE(volume.albedo);
    EXPECT_EQ(volume.albedo->name, "colors");
    EXPECT_EQ(volume.albedo->values[2].at({3, 2, 1}), linearFromSrgb(float(array.valueAt({2, 1, 2, 3})) / 255.0f));
    EXPECT_EQ(readZarr(file, {.channels = {{.name = "0", .window = std::array{0.0f, 100.0f}}}}).albedo->name, kChannelsName);
  }
  json dyes = whole;
  dyes[1] = omeroChannel("GFP", "00FF00", true, 20, 180);
  EXPECT_EQ(readZarr(fileOf("c.zarr", dyes), {}).albedo->name, kChannelsName);
}

TEST(NgffScan, ChunksThatAreNotThereAreTheFillValue) {
  const TemporaryFolder folder;
  ZarrFiles files = secondOf({}, {{"fill_value", 7}});
  ASSERT_EQ(files.erase("0/1/0/0/0"), 1u);
  const Volume volume = readZarr(writeZarr(folder / "a.zarr", files), {.array = "1", .noData = NoData()});
  EXPECT_EQ(volume.scalar(0, 0, 0), 7.0f);
  EXPECT_EQ(volume.scalar(5, 0, 0), float(ZarrFixture().valueAt({1, 0, 0, 5})));
  files = secondOf({}, {{"fill_value", "NaN"}});
  files.erase("0/1/0/0/0");
  EXPECT_EQ(readZarr(writeZarr(folder / "b.zarr", files)).scalar(0, 0, 0), kInactiveVoxel);
}

TEST(NgffScan, TimeStepsAndAxesOfTheFirstVersions) {
  const TemporaryFolder folder;
  ZarrFiles files;
  ZarrFixture array{.shape = {2, 5, 7, 11}};
  array.addSecond(files, "0");
  json image = multiscalesOf(1);
  image[0]["axes"] = {"t", "z", "y", "x"};
  image[0]["datasets"][0].erase("coordinateTransformations");
  addImage(files, {{"multiscales", image}});
  const auto file = writeZarr(folder / "a.zarr", files);
  EXPECT_EQ(readScanHeader(file, {}).timeSteps, 2);
  EXPECT_EQ(readZarr(file, {.timeStep = 1}).scalar(3, 2, 1), float(array.valueAt({1, 1, 2, 3})));
  EXPECT_EQ(readZarr(file, {}).indexToWorld, glm::dmat4(1.0));
  expectZarrRefusal(file, ErrorKind::Usage, {"2 time steps"}, {.timeStep = 2});
}

TEST(NgffScan, ZipArchivesAndFoldersOfImages) {
  const TemporaryFolder folder;
  const ZarrFiles files = secondOf({});
  for (const bool isDeflated : {false, true}) {
    writeBytes(folder / "a.zarr.zip", zipOf(files, isDeflated));
    expectValues(folder / "a.zarr.zip");
    writeBytes(folder / "b.zip", zipOf(files, isDeflated, "cells.zarr/"));
    expectValues(folder / "b.zip");
  }
  ZarrFiles inner;
  for (const auto& [name, bytes] : files) inner["0/" + name] = bytes;
  inner[".zattrs"] = R"({"bioformats2raw.layout": 3})";
  expectValues(writeZarr(folder / "c.zarr", inner));
  std::filesystem::rename(folder / "c.zarr", folder / "without_ending");
  EXPECT_TRUE(isScanFile(folder / "without_ending"));
  EXPECT_EQ(stemOf("a/cells.ome.zarr"), "cells");
  EXPECT_EQ(stemOf("a/cells.ome.zarr/"), "cells");
}

TEST(NgffScan, DamagedChunksAreNamed) {
  const TemporaryFolder folder;
  ZarrFixture array;
  const auto expectDamage = [&](const std::string& name, ZarrFiles files, const std::string& chunk,
                                const std::function<void(std::string&)>& damage) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(files.contains(chunk));
    damage(files[chunk]);
    expectZarrRefusal(writeZarr(folder / name, files), ErrorKind::Input, {chunk, "damaged"});
  };
  const auto cut = [](std::string& bytes) { bytes.resize(bytes.size() / 2); };
  const auto empty = [](std::string& bytes) { bytes.clear(); };
  expectDamage("raw.zarr", secondOf(array), "0/1/0/0/0", cut);
  array.pack = zstdOf;
  const json zstd{{"compressor", {{"id", "zstd"}}}};
  expectDamage("zstd.zarr", secondOf(array, zstd), "0/1/2/1/2", cut);
  expectDamage("zstd_bomb.zarr", secondOf(array, zstd), "0/1/0/0/0", [](std::string& bytes) { bytes = zstdOf(std::string(1 << 24, 'x')); });
  expectDamage("zstd_empty.zarr", secondOf(array, zstd), "0/1/0/0/0", empty);
  array.pack = [](const std::string& bytes) { return bloscOf(bytes, "lz4", BLOSC_SHUFFLE); };
  const json blosc{{"compressor", {{"id", "blosc"}}}};
  expectDamage("blosc.zarr", secondOf(array, blosc), "0/1/0/0/0", cut);
  expectDamage("blosc_bomb.zarr", secondOf(array, blosc), "0/1/0/0/0",
               [](std::string& bytes) { bytes = bloscOf(std::string(1 << 24, 'x'), "lz4", BLOSC_SHUFFLE); });
  expectDamage("blosc_empty.zarr", secondOf(array, blosc), "0/1/0/0/0", empty);
  array.pack = [](const std::string& bytes) { return deflateOf(bytes, 31); };
  const json gzip{{"compressor", {{"id", "gzip"}}}};
  expectDamage("gzip.zarr", secondOf(array, gzip), "0/1/0/0/0", cut);
  expectDamage("gzip_bomb.zarr", secondOf(array, gzip), "0/1/0/0/0",
               [](std::string& bytes) { bytes = deflateOf(std::string(1 << 24, 'x'), 31); });
  array.pack = [](const std::string& bytes) { return withCrc32c(bytes); };
  expectDamage("checksum.zarr", thirdOf(array, codecsOf({codecOf("crc32c")})), "0/c/1/0/0/0", [](std::string& bytes) { bytes[0] ^= 1; });
  array.pack = [](const std::string& bytes) { return bytes; };
  expectDamage("shard.zarr", thirdOf(array, codecsOf({}), {1, 2, 2, 2}), "0/c/1/0/0/0", cut);
  expectDamage("index.zarr", thirdOf(array, codecsOf({}), {1, 2, 2, 2}), "0/c/1/0/0/0",
               [](std::string& bytes) { bytes[bytes.size() - 9] ^= 1; });
  expectDamage("offset.zarr", thirdOf(array, codecsOf({}), {1, 2, 2, 2}), "0/c/1/0/0/0", [](std::string& bytes) {
    std::string index = bytes.substr(bytes.size() - 132, 128);
    index[6] = 1;
    bytes = bytes.substr(0, bytes.size() - 132) + withCrc32c(index);
  });
}

TEST(NgffScan, WhatIsNotReadIsNamed) {
  const TemporaryFolder folder;
  const ZarrFixture array;
  const auto expect = [&](const std::string& name, const ZarrFiles& files, std::initializer_list<std::string> parts) {
    SCOPED_TRACE(name);
    expectZarrRefusal(writeZarr(folder / name, files), ErrorKind::Input, parts);
  };
  expect("codec.zarr", secondOf(array, {{"compressor", {{"id", "lzma"}}}}), {"lzma", "zstd"});
  expect("filter.zarr", secondOf(array, {{"filters", {{{"id", "delta"}}}}}), {"delta"});
  expect("type.zarr", secondOf(array, {{"dtype", "<c8"}}), {"<c8"});
  expect("third_codec.zarr", thirdOf(array, codecsOf({codecOf("numcodecs.pcodec")})), {"pcodec"});
  expect("shape.zarr", secondOf(array, {{"shape", {1, -2, 3, 4}}}), {"shape"});
  expect("axes.zarr", secondOf(array, {{"shape", {2, 3, 4}}, {"chunks", {1, 1, 1}}}), {"3 axes"});
  expect("huge.zarr", secondOf(array, {{"shape", {3, 1 << 30, 1 << 30, 1 << 30}}}), {"voxels"});
  expect("chunks.zarr", secondOf(array, {{"chunks", {1, 1 << 20, 1 << 20, 1 << 20}}}), {"chunks of more"});
  ZarrFiles files = secondOf(array);
  files[".zattrs"] = "{}";
  expect("plain.zarr", files, {"without multiscales"});
  files[".zattrs"] = R"({"plate": {}})";
  expect("plate.zarr", files, {"plate"});
  files[".zattrs"] = "{]";
  expect("text.zarr", files, {".zattrs", "JSON"});
  files[".zattrs"] = std::string(100000, '[');
  expect("deep.zarr", files, {".zattrs", "JSON"});
  json outside = multiscalesOf(1);
  outside[0]["datasets"][0]["path"] = "../0";
  files[".zattrs"] = json{{"multiscales", outside}}.dump();
  expect("outside.zarr", files, {"path"});
  files = secondOf(array);
  files.erase("0/.zarray");
  expect("missing.zarr", files, {"no array"});
  writeBytes(folder / "none.zip", std::string(500, 'x'));
  expectZarrRefusal(folder / "none.zip", ErrorKind::Input, {"zip"});
  const std::string zip = zipOf(secondOf(array), true);
  for (const double part : {0.0, 0.3, 0.99}) {
    writeBytes(folder / "cut.zip", zip.substr(0, std::size_t(part * double(zip.size()))));
    expectZarrRefusal(folder / "cut.zip", ErrorKind::Input, {"cut.zip"});
  }
}

}  // namespace freevoxels::test
