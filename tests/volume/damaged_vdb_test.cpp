// Files that are truncated, damaged, or no .vdb files at all.
#include <openvdb/io/Stream.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "tests/volume/vdb_fixture.h"

/// For the leak sanitizer: OpenVDB drops the nodes it was reading when a truncated stream throws.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:readTopology\nleak:readBuffers\n";
}

namespace freevoxels {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using test::expectRefusal;
using test::kPlenty;
using test::makeGrid;
using test::named;
using test::patchyVolume;
using test::readBytes;
using test::Vdb;
using test::writeBytes;

TEST_F(Vdb, WhatIsNoVdbFileIsRefused) {
  expectReadRefused({file.string(), "there is no file"});
  writeBytes(file, "ply\nformat ascii 1.0\n");
  expectReadRefused({file.string(), "not an OpenVDB file", "text"});
  writeBytes(file, std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16));
  expectReadRefused({file.string(), "not an OpenVDB file", "signature"});
  writeBytes(file, "");
  expectReadRefused({file.string(), "not an OpenVDB file", "empty"});
  fs::remove(file);
  fs::create_directory(file);
  expectReadRefused({file.string(), "folder"});
  expectRefusal([] { readVdb("/dev/null", "", kPlenty); }, ErrorKind::Input, {"/dev/null"});
}

TEST_F(Vdb, ATruncatedFileIsRefusedWhereverItEnds) {
  const Volume volume = patchyVolume({20, 20, 20}, glm::dmat4(1.0));
  writeVdb(file, volume, "density");
  const std::string bytes = readBytes(file);
  ASSERT_GT(bytes.size(), 1000u);
  for (std::size_t length = 8; length < bytes.size(); length += length < 400 ? 1 : 97) {
    writeBytes(file, bytes.substr(0, length));
    SCOPED_TRACE(length);
    expectReadRefused({file.string(), "incomplete"});
  }
  writeBytes(file, bytes.substr(0, bytes.size() - 1));
  expectReadRefused({file.string(), "incomplete"});
  expectRefusal([&] { describeVdb(file); }, ErrorKind::Input, {file.string(), "incomplete"});
}

TEST_F(Vdb, AStreamedFileIsReadAndRefusedWhenTruncated) {
  {
    std::ofstream stream(file, std::ios::binary);
    openvdb::io::Stream(stream).write(openvdb::GridPtrVec{makeGrid("a", 0.1f), makeGrid("density", 0.2f)});
  }
  EXPECT_EQ(read().maximum, 0.2f);
  EXPECT_EQ(read("a").maximum, 0.1f);
  const std::string bytes = readBytes(file);
  for (std::size_t length = 60; length < bytes.size(); length += 211) {
    writeBytes(file, bytes.substr(0, length));
    SCOPED_TRACE(length);
    expectReadRefused({file.string()});
  }
}

TEST_F(Vdb, AStreamThatCountsMoreGridsThanItHasRoomForIsRefused) {
  {
    std::ofstream stream(file, std::ios::binary);
    openvdb::io::Stream(stream).write(openvdb::GridPtrVec{makeGrid("density", 0.2f)});
  }
  constexpr std::size_t kGridCount = 61;  // signature, versions, identifier, and no metadata
  std::string bytes = readBytes(file);
  ASSERT_EQ(bytes[kGridCount], 1);
  bytes[kGridCount + 3] = 0x64;
  writeBytes(file, bytes);
  expectReadRefused({file.string(), "incomplete"});
}

TEST_F(Vdb, ANewerFormatIsTriedWithoutNoiseAndAnAncientOneIsRefused) {
  write({makeGrid("density", 0.5f)});
  std::string bytes = readBytes(file);
  bytes[8] = char(openvdb::OPENVDB_FILE_VERSION + 1);  // the format version follows the signature
  writeBytes(file, bytes);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  EXPECT_EQ(read().maximum, 0.5f);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  bytes[8] = char(200);
  writeBytes(file, bytes);
  expectReadRefused({file.string(), "format 200"});
}

/// Where `bytes` begin in the file.
std::size_t find(const std::string& file, const std::string& bytes) {
  const std::size_t at = file.find(bytes);
  EXPECT_NE(at, std::string::npos) << bytes;
  return at;
}

template <typename Value>
void overwrite(std::string& file, std::size_t at, Value value) {
  file.replace(at, sizeof(Value), reinterpret_cast<const char*>(&value), sizeof(Value));
}

TEST_F(Vdb, SizesInDamagedMetadataAllocateNothing) {
  write({makeGrid("density")});
  const std::string whole = readBytes(file);
  const std::size_t metadata = find(whole, "file_bbox_min");
  const std::size_t type = metadata + std::string("file_bbox_min").size();
  for (const std::size_t size : {metadata - 4, type, type + 4 + std::string("vec3i").size()}) {
    std::string bytes = whole;
    overwrite(bytes, size, 0x7fffffffu);
    writeBytes(file, bytes);
    SCOPED_TRACE(size);
    expectReadRefused({file.string(), "damaged"});
    expectRefusal([&] { describeVdb(file); }, ErrorKind::Input, {file.string(), "damaged"});
  }
}

TEST_F(Vdb, ALeafLongerThanItsNodeIsRefusedBeforeItIsRead) {
  const FloatGrid::Ptr grid = makeGrid("density", CoordBBox(Coord(0), Coord(0)), 0.7f);
  grid->setSaveFloatAsHalf(true);
  openvdb::io::File output(file.string());
  output.setCompression(openvdb::io::COMPRESS_BLOSC);
  output.write(openvdb::GridPtrVec{grid});
  ASSERT_GT(read().maximum, 0.6f);
  std::string bytes = readBytes(file);
  // The leaf is the last of the file: 512 halves behind their size and Blosc's header, or as they are.
  const std::string header{"\x02\x01", 2};
  const std::size_t blosc = bytes.rfind(header);
  ASSERT_NE(blosc, std::string::npos);
  overwrite(bytes, blosc - sizeof(std::int64_t), std::int64_t{-100'000});
  writeBytes(file, bytes);
  expectReadRefused({file.string(), "1024 bytes are given as -100000"});
}

TEST_F(Vdb, AnOutOfPlaceNodeIsRefused) {
  write({makeGrid("density", CoordBBox(Coord(4096, 8192, 12288), Coord(4096, 8192, 12288)), 1.0f)});
  std::string bytes = readBytes(file);
  const std::int32_t corner[] = {4096, 8192, 12288};
  const std::size_t at = bytes.rfind(std::string(reinterpret_cast<const char*>(corner), sizeof(corner)));
  ASSERT_NE(at, std::string::npos);
  overwrite(bytes, at, 4097);
  writeBytes(file, bytes);
  expectReadRefused({file.string(), "4097 8192 12288"});
}

using VdbDeathTest = Vdb;

/// Grids of several types, compressions and classes in one small file, as bytes.
std::string assortedFile(const fs::path& file) {
  const FloatGrid::Ptr half = makeGrid("half", CoordBBox(Coord(-3), Coord(6, 5, 4)), 0.3f);
  half->tree().setValueOn(Coord(20, 0, 0), 0.1f);
  half->setSaveFloatAsHalf(true);
  const auto velocity = named<openvdb::Vec3SGrid>(openvdb::Vec3SGrid::create(), "velocity");
  velocity->tree().setValueOn(Coord(1, 2, 3), openvdb::Vec3s(1.0f, 2.0f, 3.0f));
  const auto inside = named<openvdb::BoolGrid>(openvdb::BoolGrid::create(), "inside");
  inside->tree().setValueOn(Coord(1, 2, 3), true);
  openvdb::io::File(file.string()).write(openvdb::GridPtrVec{makeGrid("density"), half, velocity, inside});
  return readBytes(file);
}

TEST_F(VdbDeathTest, DamagedBytesGiveAVolumeOrOneSentence) {
  const std::string whole = assortedFile(file);
  std::mt19937 random(7);
  const auto below = [&](std::size_t end) { return random() % end; };
  int refused = 0;
  const auto tryToRead = [&] {
    for (const std::string name : {"density", "half"}) try {
        EXPECT_GT(read(name).voxelCount(), 0u);
        for (const GridInfo& grid : describeVdb(file)) EXPECT_FALSE(grid.name.empty());
      } catch (const Error& error) {
        ++refused;
        const std::string sentence = error.what();
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
        EXPECT_LT(sentence.size(), 2000u) << sentence;
        EXPECT_NE(sentence.find("test.vdb"), std::string::npos) << sentence;
      }
  };
  const auto tryAll = [&] {
    for (int i = 0; i < 500; ++i) {
      std::string bytes = whole;
      const std::size_t flips = 1 + below(4);
      for (std::size_t flip = 0; flip < flips; ++flip) {
        // Every other one where the structure is: most of the file is values.
        const std::size_t end = below(2) == 0 ? std::min<std::size_t>(bytes.size(), 1500) : bytes.size();
        bytes[below(end)] ^= char(1 << below(8));
      }
      writeBytes(file, bytes);
      SCOPED_TRACE(i);
      tryToRead();
    }
    EXPECT_GT(refused, 100);
    fs::remove_all(folder.path());  // a death test runs in a process and a folder of its own
    _exit(HasFailure() ? 1 : 0);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(tryAll(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace freevoxels
