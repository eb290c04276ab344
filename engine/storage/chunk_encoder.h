#pragma once
// Encodes the chunks of a baked volume.

#include <cstddef>
#include <span>
#include <vector>

#include "engine/storage/chunk_pyramid.h"
#include "engine/storage/fvx_description.h"
#include "engine/storage/fvx_format.h"

namespace freevoxels::fvx {

struct WriteSettings {
  glm::ivec3 dimensions{0};
  Encodings encodings;
  WithoutData withoutData = WithoutData::Zero;  ///< how voxels without data count in means of scalars
  /// Whether to leave out bricks of scalars of which none is above 0, in addition to those without data.
  bool leaveOutZeros = false;
  bool compress = false;
};

struct EncodedChunk {
  ChunkEntry entry;              ///< without offset and extinctions
  std::vector<std::byte> bytes;  ///< stored bytes; empty if there is nothing to store
};

/// Encodes a chunk's values of a channel that has an encoding.
EncodedChunk encodeChunk(const WriteSettings& settings, const ChunkValues& chunk, Channel channel);

/// Encodes chunks of level 0, with the means that the levels above need of them, for FvxWriter::add, which may be in another process.
/// Uses all threads.
std::vector<std::byte> encodeChunks(const WriteSettings& settings, std::span<const ChunkValues> chunks);

}  // namespace freevoxels::fvx
