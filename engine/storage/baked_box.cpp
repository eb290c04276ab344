#include "engine/storage/baked_box.h"

#include <sys/mman.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "engine/storage/baked_volume.h"

namespace freevoxels {

namespace {

using fvx::Channel;
using fvx::ChunkEntry;
using fvx::FvxFile;

/// The bricks of a chunk that a box has.
struct ChunkPart {
  const ChunkEntry* chunk;
  std::vector<std::pair<std::size_t, glm::ivec3>> bricks;  ///< number among the chunk's, and cell in the box
};

std::vector<ChunkPart> chunksOf(const FvxFile& file, Channel channel, int level, const fvx::VoxelBox& box) {
  constexpr int n = ScalarBricks::kEdge, m = fvx::kChunkEdge / n;
  std::vector<ChunkPart> chunks;
  const glm::ivec3 firstChunk = box.first / fvx::kChunkEdge, endChunk = (box.end + fvx::kChunkEdge - 1) / fvx::kChunkEdge;
  for (glm::ivec3 cell = firstChunk; cell.z < endChunk.z; ++cell.z)
    for (cell.y = firstChunk.y; cell.y < endChunk.y; ++cell.y)
      for (cell.x = firstChunk.x; cell.x < endChunk.x; ++cell.x) {
        ChunkPart stored{.chunk = file.find(channel, level, cell), .bricks = {}};
        if (stored.chunk == nullptr) continue;
        std::size_t number = 0;
        for (int brick = 0; brick < fvx::kChunkBricks; ++brick) {
          if ((stored.chunk->brickMask >> brick & 1u) == 0) continue;
          const glm::ivec3 first = n * (cell * m + glm::ivec3(brick % m, brick / m % m, brick / (m * m)));
          if (glm::all(glm::greaterThanEqual(first, box.first)) && glm::all(glm::lessThan(first, box.end)))
            stored.bricks.emplace_back(number, (first - box.first) / n);
          ++number;
        }
        if (!stored.bricks.empty()) chunks.push_back(std::move(stored));
      }
  return chunks;
}

/// What was read of a chunk no longer counts as this process's memory. It stays in the system's cache, from which whoever reads the same
/// pages gets them again.
void release(const FvxFile& file, const ChunkEntry& chunk) {
  constexpr std::uintptr_t kAround = 1 << 16;  // Linux maps aligned pieces of this size around a page that is read
  const std::uintptr_t map = reinterpret_cast<std::uintptr_t>(&file.header()), begin = map + chunk.offset;
  const std::uintptr_t first = std::max(begin / kAround * kAround, map);
  const std::uintptr_t end = std::min((begin + chunk.storedBytes + kAround - 1) / kAround * kAround, map + file.header().fileBytes);
  madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
}

/// One set of bricks for each value of a voxel.
std::vector<ScalarBricks> readChannel(const FvxFile& file, Channel channel, int level, const fvx::VoxelBox& box) {
  const std::vector<ChunkPart> chunks = chunksOf(file, channel, level, box);
  std::size_t count = 0;
  for (const ChunkPart& part : chunks) count += part.bricks.size();
  std::vector<ScalarBricks> result(std::size_t(fvx::valuesPerVoxel(channel)), ScalarBricks(box.extent()));
  for (ScalarBricks& values : result) {
    values.reserve(count);
    for (const ChunkPart& stored : chunks)
      for (const auto& [number, cell] : stored.bricks) values.makeBrick(cell);
  }
  const fvx::Encoding& encoding = *file.description().encodings[std::size_t(channel)];
  const fvx::Decoder decoder(encoding);
  const std::size_t brickBytes = fvx::kBrickVoxels * encoding.bytesPerValue();
  tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t i) {
    std::vector<std::byte> unpacked;
    const std::span<const std::byte> bytes = file.read(channel, *chunks[i].chunk, unpacked);
    for (const auto& [number, cell] : chunks[i].bricks)
      for (std::size_t component = 0; component < result.size(); ++component)
        decoder.decode(bytes.subspan((number * result.size() + component) * brickBytes, brickBytes), result[component].makeBrick(cell));
    release(file, *chunks[i].chunk);
  });
  return result;
}

}  // namespace

Volume readBakedBox(const FvxFile& file, int level, const fvx::VoxelBox& box) {
  Volume volume = bakedOutline(file, level);
  volume.dimensions = box.extent();
  volume.indexToWorld = glm::translate(volume.indexToWorld, glm::dvec3(box.first));
  volume.scalars = std::move(readChannel(file, Channel::Scalars, level, box).front());
  if (volume.temperature) volume.temperature->values = std::move(readChannel(file, Channel::Temperature, level, box).front());
  if (volume.albedo) std::ranges::move(readChannel(file, Channel::Albedo, level, box), volume.albedo->values.begin());
  return volume;
}

}  // namespace freevoxels
