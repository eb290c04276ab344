#pragma once
// A baked volume that is open for reading. The file is mapped into memory, so that only what is used is read
// from the disk.

#include <boost/iostreams/device/mapped_file.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/storage/regions.h"
#include "engine/storage/fvx_description.h"
#include "engine/volume/subject.h"

namespace freevoxels::fvx {

/// Whether a file is a baked volume, by its name or by its first bytes.
bool isFvx(const std::filesystem::path& file);

/// XXH3-64 of all bytes of a file. Fails with ErrorKind::Input if it cannot be read.
std::uint64_t hashOfFile(const std::filesystem::path& file);

class FvxFile {
 public:
  /// Opens a file and checks header, description and the index of the chunks. Fails with ErrorKind::Input and
  /// one sentence if the file is not a baked volume, of a later major version, incomplete or damaged.
  explicit FvxFile(const std::filesystem::path& file);
  FvxFile(const FvxFile&) = delete;
  FvxFile& operator=(const FvxFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const Header& header() const { return *reinterpret_cast<const Header*>(map_.data()); }
  std::span<const Section> sections() const { return std::span(header().sections).first(header().sectionCount); }
  const Description& description() const { return description_; }
  std::string_view provenance() const { return provenance_; }
  bool hasChannel(Channel channel) const { return description_.encodings[std::size_t(channel)].has_value(); }

  /// Number of levels of the octree; level 0 are the voxels.
  int levels() const { return int(dimensions_.size()); }
  glm::ivec3 dimensions(int level) const { return dimensions_[std::size_t(level)]; }
  /// The chunks of a level in Hilbert order; none for a channel that the file does not have.
  std::span<const ChunkEntry> chunks(Channel channel, int level) const {
    return chunks_[std::size_t(level)][std::size_t(channel)];
  }
  /// The stored bricks of a chunk, in the order of the bits of its mask. Compressed ones are written to
  /// `unpacked`; others lie in the mapped file, which exists as long as this object. Fails with
  /// ErrorKind::Input if the chunk is damaged.
  std::span<const std::byte> read(Channel channel, const ChunkEntry& chunk, std::vector<std::byte>& unpacked) const;
  /// A chunk of a level; null if it has no data.
  const ChunkEntry* find(Channel channel, int level, glm::ivec3 cell) const;
  /// Whether the file has what regions need to be drawn on their own (regions.h).
  bool hasRegions() const { return find(SectionKind::RegionIndex) != nullptr; }
  /// The regions of a level that have chunks of scalars, in Hilbert order; none if the file has no regions.
  std::span<const RegionEntry> regions(int level) const { return regions_[std::size_t(level)]; }
  /// What drawing a region reads of the file: its chunks of every channel, and what it has beside them.
  std::uint64_t bytesToRead(const RegionEntry& region) const;
  /// Fails with ErrorKind::Input if what is stored of the region is damaged.
  RegionSurroundings readRegion(const RegionEntry& region) const;
  /// Reads the whole file and fails with ErrorKind::Input if any part is damaged.
  void checkAll() const;

 private:
  /// Bytes of the file, which are all going to be read.
  std::span<const std::byte> bytes(std::uint64_t offset, std::uint64_t count) const;
  void checkHeader() const;
  const Section* find(SectionKind kind, Channel channel = {}, int level = 0) const;
  std::span<const std::byte> checked(const Section& section) const;
  std::span<const std::byte> required(SectionKind kind, const char* name) const;
  ContentCells readContent() const;
  std::span<const ChunkEntry> readIndex(Channel channel, int level) const;
  void checkEntry(const ChunkEntry& entry, const Section& chunks, Channel channel, int level) const;
  void readRegions();
  void checkEntry(const RegionEntry& entry, const Section& regions) const;
  /// What an entry of an index refers to, unpacked: in the mapped file, or in `unpacked`. `what` begins the sentence.
  std::span<const std::byte> unpack(std::uint64_t offset, std::uint64_t storedBytes, std::uint64_t bytes, std::uint64_t hash,
                                    Codec codec, std::size_t bytesPerValue, std::vector<std::byte>& unpacked,
                                    const std::string& what) const;
  [[noreturn]] void failDamaged(const std::string& what) const;

  std::filesystem::path path_;
  boost::iostreams::mapped_file_source map_;
  Description description_;
  std::string_view provenance_;
  std::vector<glm::ivec3> dimensions_;
  std::vector<std::array<std::span<const ChunkEntry>, kChannels>> chunks_;
  std::vector<std::span<const RegionEntry>> regions_;  ///< by level
};

}  // namespace freevoxels::fvx
