#pragma once
// A baked volume that is open for reading. What describes it is in memory; chunks are read from the disk when they are used, and
// no map of the file exists that another process could cut.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/random_access_file.h"
#include "engine/storage/fvx_description.h"
#include "engine/volume/subject.h"

namespace freevoxels::fvx {

/// Whether a file is a baked volume, by its name or by its first bytes.
bool isFvx(const std::filesystem::path& file);

/// XXH3-64 of all bytes of a file. Fails with ErrorKind::Input if it cannot be read.
std::uint64_t hashOfFile(const std::filesystem::path& file);

/// Memory for what is read of a file: reading the next chunk needs no other.
struct ReadBuffers {
  std::vector<std::byte> stored, planes, unpacked;
};

/// Several threads may read at the same time. All that read fail with ErrorKind::Input and one sentence also if the file was cut or changed
/// since it was opened, or if the disk fails.
class FvxFile {
 public:
  /// Opens a file and checks header, description and the indices, every number against the others. Fails with ErrorKind::Input and
  /// one sentence if the file is not a baked volume, of a later major version, incomplete or damaged.
  explicit FvxFile(const std::filesystem::path& file);
  FvxFile(const FvxFile&) = delete;
  FvxFile& operator=(const FvxFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const Header& header() const { return header_; }
  std::span<const Section> sections() const { return std::span(header_.sections).first(header_.sectionCount); }
  const Description& description() const { return description_; }
  /// JSON by the format, nested at most kDeepestJson deep; any text where another program wrote it.
  std::string_view provenance() const { return provenance_; }
  bool hasChannel(Channel channel) const { return description_.encodings[std::size_t(channel)].has_value(); }

  /// Number of levels of the octree; level 0 are the voxels.
  int levels() const { return int(dimensions_.size()); }
  glm::ivec3 dimensions(int level) const { return dimensions_[std::size_t(level)]; }
  /// The chunks of a level in Hilbert order; none for a channel that the file does not have.
  std::span<const ChunkEntry> chunks(Channel channel, int level) const {
    return chunks_[std::size_t(channel)][std::size_t(level)];
  }
  /// The stored bricks of a chunk, in the order of the bits of its mask, as long as `buffers` are not used again. Fails with
  /// ErrorKind::Input if the chunk is damaged. The values may be any (chunk_reader.h).
  std::span<const std::byte> read(Channel channel, const ChunkEntry& chunk, ReadBuffers& buffers) const;
  /// The stored bricks of a chunk that is not compressed, as many bytes as they are.
  void read(const ChunkEntry& chunk, std::span<std::byte> bytes) const;
  /// A chunk of a level; null if it has no data.
  const ChunkEntry* find(Channel channel, int level, glm::ivec3 cell) const;
  /// Reads the whole file and fails with ErrorKind::Input if any part is damaged, or if any value is not as the index says.
  void checkAll() const;

  /// `what` is a clause.
  [[noreturn]] void failDamaged(const std::string& what) const;

 private:
  /// Fills `bytes`.
  void readBytes(std::uint64_t offset, std::span<std::byte> bytes) const;
  void readHeader();
  void checkHeader() const;
  void checkSections() const;
  const Section* find(SectionKind kind, Channel channel = {}, int level = 0) const;
  [[noreturn]] void failSectionHash(const Section& section) const;
  void checkHash(const Section& section) const;
  /// The bytes of a section as values.
  template <typename Value>
  std::vector<Value> valuesOf(const Section& section) const;
  std::vector<char> required(SectionKind kind, const char* name) const;
  ContentCells readContent() const;
  void readChannel(Channel channel);

  std::filesystem::path path_;
  RandomAccessFile file_;
  Header header_;
  Description description_;
  std::string provenance_;
  std::vector<glm::ivec3> dimensions_;
  std::array<std::vector<std::vector<ChunkEntry>>, kChannels> chunks_;  ///< by level
};

}  // namespace freevoxels::fvx
