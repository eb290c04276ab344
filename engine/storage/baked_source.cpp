#include "engine/storage/baked_source.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/storage/baked_volume.h"
#include "engine/storage/chunk_reader.h"

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

std::vector<ChunkPart> chunksOf(const FvxFile& file, Channel channel, int level, const VoxelRange& box) {
  constexpr int n = ScalarBricks::kEdge;
  std::vector<ChunkPart> chunks;
  const glm::ivec3 firstChunk = box.first / fvx::kChunkEdge, endChunk = (box.end + fvx::kChunkEdge - 1) / fvx::kChunkEdge;
  for (glm::ivec3 cell = firstChunk; cell.z < endChunk.z; ++cell.z)
    for (cell.y = firstChunk.y; cell.y < endChunk.y; ++cell.y)
      for (cell.x = firstChunk.x; cell.x < endChunk.x; ++cell.x) {
        ChunkPart stored{.chunk = file.find(channel, level, cell), .bricks = {}};
        if (stored.chunk == nullptr) continue;
        std::size_t number = 0;
        for (int brick = 0; brick < fvx::kChunkBricks; ++brick) {
          if (!stored.chunk->hasBrick(brick)) continue;
          const glm::ivec3 first = n * stored.chunk->brickCell(brick);
          if (glm::all(glm::greaterThanEqual(first, box.first)) && glm::all(glm::lessThan(first, box.end)))
            stored.bricks.emplace_back(number, (first - box.first) / n);
          ++number;
        }
        if (!stored.bricks.empty()) chunks.push_back(std::move(stored));
      }
  return chunks;
}

/// One set of bricks for each value of a voxel.
std::vector<ScalarBricks> readChannel(const FvxFile& file, Channel channel, int level, const VoxelRange& box) {
  const std::vector<ChunkPart> chunks = chunksOf(file, channel, level, box);
  std::size_t count = 0;
  for (const ChunkPart& part : chunks) count += part.bricks.size();
  std::vector<ScalarBricks> result(file.description().valuesPerVoxel(channel), ScalarBricks(box.extent()));
  for (ScalarBricks& values : result) {
    values.reserve(count);
    for (const ChunkPart& stored : chunks)
      for (const auto& [number, cell] : stored.bricks) values.makeBrick(cell);
  }
  const fvx::ChunkReader reader(file, channel, level);
  tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t i) {
    const auto& wanted = chunks[i].bricks;
    std::size_t next = 0;  // of the wanted ones, which are in the order in which bricks are read
    reader.read(*chunks[i].chunk, [&](std::size_t number, std::size_t component) -> ScalarBricks::Brick* {
      while (next < wanted.size() && wanted[next].first < number) ++next;
      return next < wanted.size() && wanted[next].first == number ? &result[component].makeBrick(wanted[next].second) : nullptr;
    });
  });
  return result;
}

void checkFitsInMemory(const FvxFile& file, std::uint64_t bricks, const char* remedy) {
  if (const std::uint64_t bytes = bricks * sizeof(ScalarBricks::Brick); bytes > machineMemoryBytes() / 4 * 3)
    fail(ErrorKind::OutOfMemory, "'{}' takes {} MiB in memory, and this machine has {} MiB: {}", file.path().string(), bytes >> 20,
         machineMemoryBytes() >> 20, remedy);
}

}  // namespace

BakedSource::BakedSource(std::shared_ptr<const FvxFile> file, int finest) : file_(std::move(file)), finest_(finest) {
  FV_CHECK_LT(finest, file_->levels());
  for (int level = finest; level < file_->levels(); ++level) outlines_.push_back(bakedOutline(*file_, level));
}

std::string BakedSource::checksum() const {
  return fmt::format("{:016x}", file_->header().hash);
}

SparseGrid<std::uint8_t> BakedSource::bricks(int level) const {
  SparseGrid<std::uint8_t> cells((outline(level).dimensions + ScalarBricks::kEdge - 1) / ScalarBricks::kEdge);
  for (const ChunkEntry& chunk : file_->chunks(Channel::Scalars, finest_ + level))
    for (int brick = 0; brick < fvx::kChunkBricks; ++brick)
      if (chunk.hasBrick(brick)) cells[chunk.brickCell(brick)] = 1;
  return cells;
}

Volume BakedSource::read(int level, const VoxelRange& box) const {
  Volume volume = outline(level);
  volume.dimensions = box.extent();
  volume.indexToWorld = glm::translate(volume.indexToWorld, glm::dvec3(box.first));
  const int stored = finest_ + level;
  fvx::forEachChannel(volume, [&](Channel channel, const auto& components) {
    std::vector<ScalarBricks> read = readChannel(*file_, channel, stored, box);
    for (std::size_t i = 0; i < read.size(); ++i) *components[i] = std::move(read[i]);
  });
  return volume;
}

std::shared_ptr<const Volume> BakedSource::whole(const Progress& progress) const {
  return std::make_shared<const Volume>(readBaked(file_, finest_, progress));
}

std::shared_ptr<const VolumeSource> bakedSource(const std::shared_ptr<const FvxFile>& file, int finest, bool reads,
                                                const Progress& progress) {
  if (!reads) return std::make_shared<const BakedSource>(file, finest);
  std::uint64_t bricks = 0;
  for (const ChunkEntry& chunk : file->chunks(Channel::Scalars, finest)) bricks += std::uint64_t(chunk.bricks());
  checkFitsInMemory(*file, bricks, "draw it as it was baked, which reads parts of it");
  return std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(readBaked(file, finest, progress)));
}

Volume readBakedPart(const std::shared_ptr<const FvxFile>& file, const VoxelBox& box) {
  constexpr int n = ScalarBricks::kEdge;
  const BakedSource source(file);
  const glm::ivec3 size = source.outline(0).dimensions;
  const VoxelBox part{glm::max(box.first, 0), glm::min(box.last, size - 1)};
  const VoxelRange bricks{part.first / n * n, glm::min((part.last / n + 1) * n, size)};
  std::uint64_t count = 0;
  for (const ChunkPart& chunk : chunksOf(*file, Channel::Scalars, 0, bricks)) count += chunk.bricks.size();
  checkFitsInMemory(*file, count, "draw a smaller part of it");
  Volume volume = source.read(0, bricks);
  volume.indexOrigin += bricks.first;
  return clippedVolume(volume, VoxelBox{part.first - bricks.first, part.last - bricks.first});
}

}  // namespace freevoxels
