#pragma once
// Whether the indices of a baked volume can be: every number against the others, before anything that they refer to is read.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/storage/fvx_description.h"
#include "engine/storage/fvx_format.h"

namespace freevoxels::fvx {

/// A level of a channel, to which an index of chunks belongs.
struct IndexedLevel {
  glm::ivec3 dimensions{0};
  Section chunks;              ///< in which the chunks lie
  std::size_t brickBytes = 0;  ///< without compression
  /// No value lies outside of it, unless it is empty (low > high).
  glm::vec2 range{1.0f, 0.0f};
};

/// For messages: "chunk 1,0,2".
std::string nameOf(const ChunkEntry& chunk);

/// The cells of chunks along the axes of a level.
inline glm::ivec3 chunkCells(glm::ivec3 dimensions) {
  return (dimensions + kChunkEdge - 1) / kChunkEdge;
}

/// These return what is wrong as a clause, "the entry of chunk 1,0,0 is impossible: ..."; nothing if all is right.
std::string whyNotChunks(std::span<const ChunkEntry> entries, const IndexedLevel& level);
/// Chunks of a level and those of the next coarser one, of which each stands for some of the former.
std::string whyNotLevels(std::span<const ChunkEntry> fine, std::span<const ChunkEntry> coarse);
}  // namespace freevoxels::fvx
