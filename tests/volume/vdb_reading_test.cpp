// The reading of OpenVDB files as work: its progress, its end before time, by several threads, many times.

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <vector>

#include "engine/core/error.h"
#include "engine/volume/procedural.h"
#include "engine/volume/vdb.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels::test {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::FloatGrid;

/// What ends a reading; no std::exception, as those of callers need not be.
struct Abandoned {};

/// Reads the densities until the progress function is called for the `last` time, which throws.
template <typename Thrown>
void readUntil(const fs::path& file, int last, const Thrown& thrown) {
  readVdb(file, "density", kPlenty, {}, [&](std::string_view, double) {
    if (--last == 0) throw thrown;
  });
}

TEST_F(Vdb, ReadingReportsProgressAndChangesNothing) {
  constexpr std::uint32_t kNone = openvdb::io::COMPRESS_NONE, kZip = openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK;
  for (const bool isHalf : {false, true})
    for (const std::uint32_t compression : {kNone, kZip}) {
      const FloatGrid::Ptr density = makeGrid("density", {Coord(-3, 5, 0), Coord(180, 170, 160)}, 0.5f), other = makeGrid("density");
      int leaves = 0;
      for (auto leaf = density->tree().beginLeaf(); leaf; ++leaf, ++leaves)
        for (auto voxel = leaf->beginValueOn(); voxel; ++voxel) voxel.setValue(float((int(voxel.pos()) * 7 + leaves) % 1000) / 512.0f);
      density->setSaveFloatAsHalf(isHalf);
      openvdb::io::File written(file.string());
      written.setCompression(compression);
      written.write(openvdb::GridPtrVec{other, makeGrid("heat"), density});
      written.close();
      for (const char* name : {"density[0]", "density[1]", "heat"}) {
        std::vector<double> fractions;
        const Volume plain = readVdb(file, name, kPlenty);
        const Volume reported = readVdb(file, name, kPlenty, {}, [&](std::string_view, double fraction) { fractions.push_back(fraction); });
        EXPECT_EQ(denseScalars(reported), denseScalars(plain)) << name;
        EXPECT_EQ(reported.indexToWorld, plain.indexToWorld);
        EXPECT_EQ(reported.indexOrigin, plain.indexOrigin);
        EXPECT_EQ(reported.source, plain.source);
        for (const double fraction : fractions) EXPECT_TRUE(fraction >= 0.0 && fraction <= 1.0) << fraction;
        EXPECT_GE(fractions.size(), plain.activeVoxels > 1000 ? 5u : 2u);
      }
    }
}

TEST_F(Vdb, ReadingOfStreamedFilesReportsToo) {
  const FloatGrid::Ptr density = makeGrid("density", {Coord(0), Coord(200, 190, 180)}, 0.5f);
  for (auto leaf = density->tree().beginLeaf(); leaf; ++leaf)
    for (auto voxel = leaf->beginValueOn(); voxel; ++voxel) voxel.setValue(float(voxel.pos() * 7 % 1000) / 512.0f);
  {
    std::ofstream stream(file, std::ios::binary);
    openvdb::io::Stream(stream).write(openvdb::GridPtrVec{density, makeGrid("heat")});
  }
  int reports = 0;
  const Volume plain = read("density"), reported = readVdb(file, "density", kPlenty, {}, [&](std::string_view, double) { ++reports; });
  EXPECT_EQ(denseScalars(reported), denseScalars(plain));
  ASSERT_GE(reports, 5);
  for (int last = 1; last <= reports; ++last) EXPECT_THROW(readUntil(file, last, Abandoned()), Abandoned) << last;
}

TEST_F(Vdb, ReadingMayBeAbandonedAtEveryReport) {
  writeVdb(file, makeProcedural("marschner-lobb", glm::ivec3(130, 140, 150)), "density");
  int reports = 0;
  const Volume whole = readVdb(file, "", kPlenty, {}, [&](std::string_view, double) { ++reports; });
  ASSERT_GE(reports, 5);
  for (int last = 1; last <= reports; ++last) {
    EXPECT_THROW(readUntil(file, last, Abandoned()), Abandoned) << last;
    try {
      readUntil(file, last, std::runtime_error("mine"));
      ADD_FAILURE() << last;
    } catch (const std::exception& error) {
      EXPECT_STREQ(error.what(), "mine") << last;
    }
  }
  EXPECT_EQ(denseScalars(read()), denseScalars(whole));
}

TEST_F(Vdb, ThreadsReadAtTheSameTimeWithoutDisturbingEachOther) {
  const std::string good = (folder / "good.vdb").string(), bad = (folder / "bad.vdb").string();
  write({makeGrid("density", 0.5f), makeGrid("density", 0.25f)});
  fs::rename(file, good);
  writeBytes(bad, readBytes(good).substr(0, 900));
  std::atomic<int> read = 0, refused = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 25; ++k) {
        if (readVdb(good, "density[1]", kPlenty).maximum == 0.25f && listVdb(good).size() == 2) ++read;
        try {
          readVdb(bad, "", kPlenty);
        } catch (const Error&) {
          ++refused;
        }
      }
    });
  testing::internal::CaptureStdout();
  for (int k = 0; k < 100; ++k) std::cout << "." << std::flush;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), std::string(100, '.')) << "this program's own output is lost";
  EXPECT_EQ(read, 100);
  EXPECT_EQ(refused, 100);
}

std::size_t openDescriptors() {
  return std::size_t(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

/// Resident in memory.
std::size_t residentBytes() {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

TEST_F(Vdb, TwoHundredVolumesInOneProcessLeaveMemoryAndDescriptorsFlat) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer keeps freed memory";
#endif
  writeVdb(file, makeProcedural("cloud", 40), "density");
  const std::string broken = (folder / "broken.vdb").string(), whole = readBytes(file);
  writeBytes(broken, whole.substr(0, whole.size() / 2));
  const auto open = [&](int times) {
    for (int i = 0; i < times; ++i) {
      EXPECT_GT(read().activeVoxels, 0u);
      expectRefusal([&] { readVdb(broken, "", kPlenty); }, ErrorKind::Input, {"broken.vdb"});
    }
  };
  open(20);  // what is allocated once
  const std::size_t descriptors = openDescriptors(), bytes = residentBytes();
  open(180);
  EXPECT_EQ(openDescriptors(), descriptors);
  EXPECT_LT(residentBytes(), bytes + (std::size_t(8) << 20));
}

}  // namespace
}  // namespace freevoxels::test
