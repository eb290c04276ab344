#pragma once
// Internal to the reader of Zarr: what the bytes of a chunk are compressed by.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace freevoxels {

enum class ChunkCodec { Blosc, Zstd, Zlib, Crc32c };

/// The codec that has this name in Zarr 2 and 3. Fails with ErrorKind::Input for others; `array` is what the sentence calls the array.
ChunkCodec chunkCodec(const std::string& name, const std::string& array);

/// Undoes the codecs, which were applied in their order. The result has `bytes` bytes: more are never allocated, whatever the chunk says
/// of itself. Fails with ErrorKind::Input; `chunk` is what the sentence calls the chunk.
std::vector<std::byte> decodedChunk(std::vector<std::byte> packed, std::span<const ChunkCodec> codecs, std::uint64_t bytes,
                                    const std::string& chunk);

/// CRC-32C, of which Zarr writes the checksums.
std::uint32_t crc32cOf(std::span<const std::byte> bytes);

}  // namespace freevoxels
