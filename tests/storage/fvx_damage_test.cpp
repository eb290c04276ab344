// What is wrong with a baked volume is found before anything of it is used.

#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstring>
#include <fstream>

#include "engine/storage/baked_volume.h"
#include "tests/refusal.h"
#include "tests/storage/baked_fixture.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using fvx::Channel;
using fvx::FvxFile;
using fvx::Header;

class FvxDamage : public testing::Test {
 protected:
  FvxDamage() { bake({}); }

  void bake(const BakeSettings& settings) {
    bakeVolume(file_, test::volumeOfAllChannels(), {.densityScale = 0.7}, settings);
    bytes_ = test::readBytes(file_);
  }
  void patch(std::size_t offset, char value) const {
    std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(std::streamoff(offset));
    stream.put(value);
  }
  void flip(std::size_t offset) const { patch(offset, char(bytes_[offset] ^ 0x10)); }
  void restore(std::size_t offset) const { patch(offset, bytes_[offset]); }
  void read() const { readBaked(std::make_shared<const FvxFile>(file_)); }
  /// Changes the header as a correct writer would have written it.
  template <typename Change>
  void rewriteHeader(const Change& change) const {
    Header header;
    std::memcpy(&header, bytes_.data(), sizeof(header));
    change(header);
    header.hash = 0;
    header.hash = XXH3_64bits(&header, sizeof(header));
    std::string bytes = bytes_;
    std::memcpy(bytes.data(), &header, sizeof(header));
    test::writeBytes(file_, bytes);
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.fvx";
  std::string bytes_;
};

TEST_F(FvxDamage, EveryFlippedByteOfTheHeaderIsRefused) {
  for (std::size_t offset = 0; offset < sizeof(Header); ++offset) {
    flip(offset);
    test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx"});
    restore(offset);
  }
  read();
}

TEST_F(FvxDamage, EveryFlippedByteOfDescriptionProvenanceAndIndicesIsRefused) {
  std::vector<fvx::Section> sections;
  {
    const FvxFile file(file_);
    sections.assign(file.sections().begin(), file.sections().end());
  }
  for (const fvx::Section& section : sections) {
    if (section.kind == fvx::SectionKind::Chunks) continue;
    for (std::uint64_t i = 0; i < section.bytes; i += 7) {
      flip(section.offset + i);
      test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx", "damaged"});
      restore(section.offset + i);
    }
  }
}

TEST_F(FvxDamage, TheFlippedFirstByteOfEveryChunkIsRefusedWhenItIsRead) {
  for (const bool compress : {false, true})
    for (const bool keepScalars : {false, true}) {
      bake({.keepScalars = keepScalars, .compress = compress});
      std::vector<std::pair<int, std::uint64_t>> chunks;
      {
        const FvxFile file(file_);
        for (int level = 0; level < file.levels(); ++level)
          for (const Channel channel : {Channel::Scalars, Channel::Temperature, Channel::Albedo})
            for (const fvx::ChunkEntry& chunk : file.chunks(channel, level)) chunks.emplace_back(level, chunk.offset);
      }
      ASSERT_GT(chunks.size(), 20u);
      for (const auto& [level, offset] : chunks) {
        flip(offset);
        const auto file = std::make_shared<const FvxFile>(file_);
        test::expectRefusal([&, level = level] { readBaked(file, level); }, ErrorKind::Input, {"a.fvx", "damaged"});
        test::expectRefusal([&] { file->checkAll(); }, ErrorKind::Input, {"a.fvx", "damaged"});
        restore(offset);
      }
    }
}

TEST_F(FvxDamage, AFileOfFormat1Point1WithSectionsOfRegionsIsRead) {
  rewriteHeader([](Header& header) {
    header.minorVersion = 1;
    for (const std::uint32_t kind : {6, 7}) {
      header.sections[header.sectionCount] = header.sections[header.sectionCount - 1];
      header.sections[header.sectionCount++].kind = fvx::SectionKind(kind);
    }
  });
  read();
}

TEST_F(FvxDamage, TwoHundredTruncationsAreRefused) {
  for (std::size_t i = 0; i < 200; ++i) {
    std::filesystem::resize_file(file_, bytes_.size() * (199 - i) / 200);
    test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx"});
  }
  test::writeBytes(file_, bytes_ + "x");
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx", "damaged"});
}

TEST_F(FvxDamage, AHigherMajorVersionIsRefusedWithBothNumbers) {
  rewriteHeader([](Header& header) { header.majorVersion = 3, header.minorVersion = 4; });
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"3.4", "format 1"});
}

TEST_F(FvxDamage, AHigherMinorVersionIsRead) {
  rewriteHeader([](Header& header) { header.minorVersion = 9; });
  read();
}

TEST_F(FvxDamage, UnknownSectionsAreSkipped) {
  rewriteHeader([](Header& header) {
    header.sections[header.sectionCount] = header.sections[0];
    header.sections[header.sectionCount++].kind = fvx::SectionKind(99);
  });
  read();
}

TEST_F(FvxDamage, OtherByteOrderIsSaid) {
  rewriteHeader([](Header& header) { header.byteOrderMark = fvx::kOtherByteOrderMark; });
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"byte order"});
}

TEST_F(FvxDamage, ForeignMissingAndEmptyFilesAreSaid) {
  test::writeBytes(file_, "This is no volume, although it is long enough to be mistaken for one.");
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"is no baked volume"});
  test::writeBytes(file_, "");
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"is empty"});
  std::filesystem::remove(file_);
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"No such file"});
}

TEST_F(FvxDamage, ATransferAsTextIsNoticed) {
  std::string text = bytes_;
  for (std::size_t at = 0; (at = text.find("\r\n", at)) != std::string::npos;) text.erase(at, 1);
  test::writeBytes(file_, text);
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"is no baked volume"});
}

TEST_F(FvxDamage, SectionsBeyondTheFileAreRefusedWhateverTheChecksumSays) {
  for (const std::uint64_t offset : {std::uint64_t(1) << 40, ~std::uint64_t(4095), std::uint64_t(100)}) {
    rewriteHeader([&](Header& header) { header.sections[0].offset = offset; });
    test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx", "damaged"});
  }
  rewriteHeader([](Header& header) { header.sectionCount = 1000; });
  test::expectRefusal([&] { FvxFile file(file_); }, ErrorKind::Input, {"a.fvx", "damaged"});
}

TEST_F(FvxDamage, FilesAreKnownByTheirFirstBytesOrTheirName) {
  EXPECT_TRUE(fvx::isFvx(file_));
  std::filesystem::rename(file_, folder_ / "a.bin");
  EXPECT_TRUE(fvx::isFvx(folder_ / "a.bin"));
  EXPECT_TRUE(fvx::isFvx(folder_ / "missing.fvx"));
  test::writeBytes(folder_ / "b.vdb", "something else");
  EXPECT_FALSE(fvx::isFvx(folder_ / "b.vdb"));
}

}  // namespace
}  // namespace freevoxels
