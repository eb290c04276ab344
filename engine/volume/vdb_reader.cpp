#include "engine/volume/vdb_reader.h"

#include <cerrno>
#include <system_error>

namespace freevoxels {

namespace fs = std::filesystem;

VdbReader::VdbReader(const fs::path& file)
    : file_(file), size_(fs::file_size(file)), stream_(file, std::ios::binary) {
  if (stream_) return;
  const std::string reason = std::generic_category().message(errno);
  fail(ErrorKind::Input, "cannot open '{}': {}; check its permissions", file.string(), reason);
}

std::string VdbReader::readString() {
  constexpr std::uint32_t kLongest = 1 << 16;
  const auto length = read<std::uint32_t>();
  if (length > kLongest) failDamaged("a name in it is {} bytes long", length);
  std::string text(length, '\0');
  readBytes(text.data(), length);
  return text;
}

void VdbReader::readBytes(void* bytes, std::size_t count) {
  require(count);
  stream_.read(static_cast<char*>(bytes), std::streamsize(count));
  position_ += count;
  if (!stream_) fail(ErrorKind::Input, "cannot read '{}': the disk reports an error", file_.string());
}

void VdbReader::skip(std::uint64_t bytes) {
  constexpr std::uint64_t kSeekWorthwhile = 1 << 16;  // a seek drops what the stream has read ahead
  require(bytes);
  if (bytes >= kSeekWorthwhile) return seek(position_ + bytes);
  stream_.ignore(std::streamsize(bytes));
  position_ += bytes;
}

void VdbReader::seek(std::uint64_t position) {
  if (position > size_) failTruncated(position);
  stream_.seekg(std::streamoff(position));
  position_ = position;
}

void VdbReader::failTruncated(std::uint64_t needed) const {
  fail(ErrorKind::Input,
       "'{}' is incomplete: it has {} bytes, but at least {} are needed; copy or download it again",
       file_.string(), size_, needed);
}

void skipBlosc(VdbReader& reader, std::uint64_t packed, std::uint64_t unpacked) {
  struct Header {
    std::uint8_t version, innerVersion, flags, typeSize;
    std::uint32_t unpacked, block, packed;
  };
  static_assert(sizeof(Header) == 16);
  if (packed < sizeof(Header)) reader.failDamaged("a compressed block has {} bytes", packed);
  const auto header = reader.read<Header>();
  if (header.unpacked != unpacked || header.packed > packed)
    reader.failDamaged("a compressed block of {} bytes is said to hold {} bytes instead of {}", packed,
                       header.unpacked, unpacked);
  reader.skip(packed - sizeof(Header));
}

}  // namespace freevoxels
