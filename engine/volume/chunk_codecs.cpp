#include "engine/volume/chunk_codecs.h"

#include <blosc.h>
#include <zlib.h>
#include <zstd.h>

#include <array>
#include <limits>
#include <new>

#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kChecksum = 4;

[[noreturn]] void failChunk(const std::string& chunk, std::string_view codec) {
  failDamaged(chunk, fmt::format("its {} values do not decode to those of a chunk", codec));
}

Bytes withoutBlosc(const Bytes& packed, std::uint64_t most, const std::string& chunk) {
  std::size_t bytes = 0;
  if (packed.size() < BLOSC_MIN_HEADER_LENGTH || blosc_cbuffer_validate(packed.data(), packed.size(), &bytes) != 0 || bytes > most)
    failChunk(chunk, "blosc");
  Bytes result(bytes);
  if (blosc_decompress_ctx(packed.data(), result.data(), bytes, 1) != int(bytes)) failChunk(chunk, "blosc");
  return result;
}

Bytes withoutZstd(const Bytes& packed, std::uint64_t most, const std::string& chunk) {
  const unsigned long long said = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (said == ZSTD_CONTENTSIZE_ERROR || (said != ZSTD_CONTENTSIZE_UNKNOWN && said > most)) failChunk(chunk, "zstd");
  Bytes result(most);
  const std::size_t bytes = ZSTD_decompress(result.data(), result.size(), packed.data(), packed.size());
  if (ZSTD_isError(bytes) != 0) failChunk(chunk, "zstd");
  result.resize(bytes);
  return result;
}

/// With the header of zlib or of gzip.
Bytes withoutZlib(Bytes& packed, std::uint64_t most, const std::string& chunk) {
  constexpr int kAnyHeader = 32;
  Bytes result(most);
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = uInt(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = uInt(result.size());
  if (inflateInit2(&stream, MAX_WBITS + kAnyHeader) != Z_OK) throw std::bad_alloc();
  const int status = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (status != Z_STREAM_END) failChunk(chunk, "zlib");
  result.resize(stream.total_out);
  return result;
}

Bytes withoutChecksum(Bytes packed, const std::string& chunk) {
  if (packed.size() < kChecksum) failDamaged(chunk, "it ends before its checksum");
  std::uint32_t checksum = 0;
  for (std::size_t i = 0; i < kChecksum; ++i) checksum |= std::uint32_t(packed[packed.size() - kChecksum + i]) << (8 * i);
  packed.resize(packed.size() - kChecksum);
  if (crc32cOf(packed) != checksum) failDamaged(chunk, "its checksum is wrong");
  return packed;
}

}  // namespace

ChunkCodec chunkCodec(const std::string& name, const std::string& array) {
  if (name == "blosc" || name == "numcodecs.blosc") return ChunkCodec::Blosc;
  if (name == "zstd" || name == "numcodecs.zstd") return ChunkCodec::Zstd;
  if (name == "gzip" || name == "zlib" || name == "numcodecs.gzip" || name == "numcodecs.zlib") return ChunkCodec::Zlib;
  if (name == "crc32c" || name == "numcodecs.crc32c") return ChunkCodec::Crc32c;
  fail(ErrorKind::Input, "'{}' has chunks of the codec '{}', and blosc, zstd, gzip, zlib and crc32c are read: write it with one of these",
       array, name);
}

std::vector<std::byte> decodedChunk(std::vector<std::byte> packed, std::span<const ChunkCodec> codecs, std::uint64_t bytes,
                                    const std::string& chunk) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();  // of zlib's counts
  FV_CHECK_LE(bytes, kMost);
  FV_CHECK_LE(packed.size(), kMost);
  for (std::size_t i = codecs.size(); i-- > 0;) {
    // What another codec was applied to may be longer than the values, but not by much.
    const std::uint64_t most = i == 0 ? bytes : bytes + bytes / 8 + 1024;
    switch (codecs[i]) {
      case ChunkCodec::Blosc:
        packed = withoutBlosc(packed, most, chunk);
        break;
      case ChunkCodec::Zstd:
        packed = withoutZstd(packed, most, chunk);
        break;
      case ChunkCodec::Zlib:
        packed = withoutZlib(packed, most, chunk);
        break;
      case ChunkCodec::Crc32c:
        packed = withoutChecksum(std::move(packed), chunk);
        break;
    }
  }
  if (packed.size() != bytes) failDamaged(chunk, fmt::format("it has {} bytes of values, and a chunk takes {}", packed.size(), bytes));
  return packed;
}

std::uint32_t crc32cOf(std::span<const std::byte> bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    constexpr std::uint32_t kPolynomial = 0x82f63b78;  // reflected
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < made.size(); ++i) {
      made[i] = i;
      for (int bit = 0; bit < 8; ++bit) made[i] = made[i] >> 1 ^ ((made[i] & 1) != 0 ? kPolynomial : 0);
    }
    return made;
  }();
  std::uint32_t crc = ~0u;
  for (const std::byte byte : bytes) crc = table[(crc ^ std::uint32_t(byte)) & 0xff] ^ crc >> 8;
  return ~crc;
}

}  // namespace freevoxels
