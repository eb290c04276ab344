// File layout: OpenVDB's io/Archive.cc and io/GridDescriptor.cc, format versions 222 (2013) and later.
#include "engine/volume/vdb_header.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMagic = 0x56444220;  // "VDB "
constexpr std::uint32_t kOldestFormat = 222;
constexpr std::size_t kUuidLength = 36;
constexpr std::uint32_t kLongestString = 1 << 16;  // longer names and types are damage, not names

/// Reads little-endian values and fails at the end of the file instead of reading past it.
class Reader {
 public:
  explicit Reader(const fs::path& file)
      : file_(file), size_(fs::file_size(file)), stream_(file, std::ios::binary) {
    if (!stream_) {
      const std::string reason = std::generic_category().message(errno);
      fail(ExitCode::Input, "cannot open '{}': {}; check its permissions", file.string(), reason);
    }
  }

  template <typename Value>
  Value read() {
    Value value{};
    readBytes(&value, sizeof(Value));
    return value;
  }
  std::string readString() {
    const auto length = read<std::uint32_t>();
    if (length > kLongestString) failDamaged("a name in its header is {} bytes long", length);
    std::string text(length, '\0');
    readBytes(text.data(), length);
    return text;
  }
  void skip(std::uint64_t bytes) { seek(position() + bytes); }
  void seek(std::uint64_t position) {
    if (position > size_) failTruncated(position);
    stream_.seekg(std::streamoff(position));
  }
  std::uint64_t position() { return std::uint64_t(stream_.tellg()); }
  std::uint64_t size() const { return size_; }

  [[noreturn]] void failTruncated(std::uint64_t needed) const {
    fail(ExitCode::Input,
         "'{}' is incomplete: it has {} bytes, but at least {} are needed; copy or download it again",
         file_.string(), size_, needed);
  }
  template <typename... Args>
  [[noreturn]] void failDamaged(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ExitCode::Input, "'{}' is damaged: {}; copy or download it again", file_.string(),
         fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  void readBytes(void* bytes, std::size_t count) {
    const std::uint64_t end = position() + count;
    if (end > size_) failTruncated(end);
    stream_.read(static_cast<char*>(bytes), std::streamsize(count));
    if (!stream_) fail(ExitCode::Input, "cannot read '{}': the disk reports an error", file_.string());
  }

  const fs::path& file_;
  std::uint64_t size_;
  std::ifstream stream_;
};

void checkRegularFile(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    if (status.type() == fs::file_type::none)
      fail(ExitCode::Input, "cannot open '{}': {}; check its path and permissions", file.string(),
           error.message());
    fail(ExitCode::Input, "there is no file '{}'; check the name", file.string());
  }
  if (fs::is_directory(status))
    fail(ExitCode::Input, "'{}' is a folder; name an OpenVDB file in it", file.string());
  if (!fs::is_regular_file(status))
    fail(ExitCode::Input, "'{}' is not a regular file; copy its contents into a .vdb file first",
         file.string());
}

/// What a file that is not an OpenVDB file seems to be.
std::string_view guessKind(const fs::path& file) {
  char bytes[512];
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes, sizeof(bytes));
  const std::string_view head(bytes, std::size_t(stream.gcount()));
  if (head.empty()) return "it is empty";
  const bool isText = std::none_of(head.begin(), head.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == 127 || (byte < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f');
  });
  return isText ? "it is text" : "it does not begin with OpenVDB's signature";
}

void checkSignature(const fs::path& file, Reader& reader) {
  if (reader.size() < sizeof(kMagic) || reader.read<std::int64_t>() != kMagic)
    fail(ExitCode::Input, "'{}' is not an OpenVDB file: {}; give a .vdb file that OpenVDB has written",
         file.string(), guessKind(file));
}

void skipMetadata(Reader& reader) {
  const auto count = reader.read<std::int32_t>();
  if (count < 0) reader.failDamaged("its header counts {} metadata entries", count);
  for (std::int32_t i = 0; i < count; ++i) {
    reader.readString();  // name
    reader.readString();  // type
    reader.skip(reader.read<std::uint32_t>());
  }
}

VdbHeader::Grid readGridEntry(Reader& reader) {
  constexpr std::string_view kHalfSuffix = "_HalfFloat";
  VdbHeader::Grid grid;
  grid.uniqueName = reader.readString();
  grid.type = reader.readString();
  if (grid.type.ends_with(kHalfSuffix)) {
    grid.type.resize(grid.type.size() - kHalfSuffix.size());
    grid.savedAsHalf = true;
  }
  reader.readString();  // the grid whose tree this one shares
  const auto gridStart = reader.read<std::int64_t>();
  const auto blockStart = reader.read<std::int64_t>();
  const auto end = reader.read<std::int64_t>();
  if (gridStart < std::int64_t(reader.position()) || blockStart < gridStart || end < blockStart)
    reader.failDamaged("its grids are not where its header says");
  reader.seek(std::uint64_t(end));
  return grid;
}

}  // namespace

VdbHeader readVdbHeader(const std::filesystem::path& file) {
  checkRegularFile(file);
  Reader reader(file);
  checkSignature(file, reader);
  VdbHeader header;
  header.formatVersion = reader.read<std::uint32_t>();
  if (header.formatVersion < kOldestFormat)
    fail(ExitCode::Input,
         "'{}' has OpenVDB's file format {}, and the oldest supported is {}; save it again with a newer "
         "OpenVDB",
         file.string(), header.formatVersion, kOldestFormat);
  reader.skip(2 * sizeof(std::uint32_t));  // library version
  header.hasOffsets = reader.read<char>() != 0;
  reader.skip(kUuidLength);
  skipMetadata(reader);
  const auto gridCount = reader.read<std::int32_t>();
  if (gridCount < 0) reader.failDamaged("its header counts {} grids", gridCount);
  if (!header.hasOffsets) return header;
  for (std::int32_t i = 0; i < gridCount; ++i) header.grids.push_back(readGridEntry(reader));
  return header;
}

}  // namespace freevoxels
