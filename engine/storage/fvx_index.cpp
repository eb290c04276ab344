#include "engine/storage/fvx_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/octree/hilbert.h"

namespace freevoxels::fvx {

namespace {

bool isIn(glm::ivec3 cell, glm::ivec3 cells) {
  return glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) && glm::all(glm::lessThan(cell, cells));
}

/// Whether what an entry refers to lies in its section.
bool isStored(const ChunkEntry& entry, const Section& section) {
  const bool inside = entry.offset >= section.offset && entry.offset - section.offset <= section.bytes &&
                      entry.storedBytes <= section.bytes - (entry.offset - section.offset) && entry.offset % kChunkAlignment == 0;
  const bool codec = entry.codec == Codec::None ? entry.storedBytes == entry.bytes : entry.codec == Codec::PlanesZstd;
  return inside && codec;
}

bool isRange(float low, float high) {
  return std::isfinite(low) && std::isfinite(high) && low <= high;
}

/// Nothing if the entry can be.
const char* whyNot(const ChunkEntry& entry, const IndexedLevel& level) {
  if (!isIn(entry.cell, chunkCells(level.dimensions))) return "it is beyond the volume's box";
  if (entry.brickMask == 0) return "it has no bricks";
  for (int brick = 0; brick < kChunkBricks; ++brick)
    if (entry.hasBrick(brick) && !isIn(entry.brickCell(brick) * ScalarBricks::kEdge, level.dimensions))
      return "a brick of it is beyond the volume's box";
  if (!isStored(entry, level.chunks)) return "it is not stored where it should be";
  if (entry.bytes != std::uint64_t(entry.bricks()) * level.brickBytes) return "its size is not that of its bricks";
  if (entry.activeVoxels > std::uint32_t(entry.bricks() * kBrickVoxels)) return "it counts more voxels than it has";
  if (!isRange(entry.minimum, entry.maximum) || !isRange(entry.leastExtinction, entry.mostExtinction) || entry.leastExtinction < 0.0f)
    return "a range of it is none";
  const bool hasRange = entry.activeVoxels > 0 && level.range[0] <= level.range[1];
  if (hasRange && (entry.minimum < level.range[0] || entry.maximum > level.range[1])) return "its values exceed the range of the volume's";
  return nullptr;
}

}  // namespace

std::string nameOf(const ChunkEntry& chunk) {
  return fmt::format("chunk {},{},{}", chunk.cell.x, chunk.cell.y, chunk.cell.z);
}

std::string whyNotChunks(std::span<const ChunkEntry> entries, const IndexedLevel& level) {
  const int bits = hilbertBits(chunkCells(level.dimensions));
  std::uint64_t next = 0;  // position along the curve that the following entry may have at least
  for (const ChunkEntry& entry : entries) {
    const auto named = [&](const char* what) {
      return fmt::format("the entry of {} is impossible: {}", nameOf(entry), what);
    };
    if (const char* const what = whyNot(entry, level)) return named(what);
    const std::uint64_t position = hilbertIndex(glm::uvec3(entry.cell), bits);
    if (position < next) return named("it is not in the order of chunks, or there are two of it");
    next = position + 1;
  }
  return {};
}

std::string whyNotLevels(std::span<const ChunkEntry> fine, std::span<const ChunkEntry> coarse) {
  std::size_t found = 0;
  for (const ChunkEntry& chunk : fine)
    if (found < coarse.size() && coarse[found].cell == chunk.cell / 2) ++found;
  if (found == coarse.size()) return {};
  return fmt::format("{} is the mean of nothing", nameOf(coarse[found]));
}

}  // namespace freevoxels::fvx
