#include "engine/storage/spooled_planes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "engine/core/error.h"
#include "engine/storage/plane_codec.h"

namespace freevoxels::fvx {

namespace {

constexpr int kEdge = ScalarBricks::kEdge, kBricks = kChunkEdge / kEdge;

}  // namespace

void SpooledPlanes::read(int first, std::span<float> densities) const {
  std::ranges::fill(densities, 0.0f);
  tbb::parallel_for(std::size_t(0), chunks_.size(), [&](std::size_t i) {
    if (chunks_[i].cell.z == first / kChunkEdge) readChunk(chunks_[i], first, densities);
  });
}

/// The bricks of the layer that begins at plane `first`, which are consecutive.
void SpooledPlanes::readChunk(const ChunkEntry& chunk, int first, std::span<float> densities) const {
  const int layer = first / kEdge % kBricks, number = layer * kBricks * kBricks;
  const std::size_t brickBytes = kBrickVoxels * bytesPerValue_;
  const auto before = std::size_t(std::popcount(chunk.brickMask & ((std::uint64_t(1) << number) - 1)));
  const std::uint64_t mask = chunk.brickMask >> number & 0xffff;
  if (mask == 0) return;
  std::vector<std::byte> bytes(std::size_t(std::popcount(mask)) * brickBytes);
  if (chunk.codec == Codec::None) {
    spool_.readAt(chunk.offset + before * brickBytes, bytes);
  } else {
    std::vector<std::byte> stored(chunk.storedBytes), planes, all(chunk.bytes);
    spool_.readAt(chunk.offset, stored);
    FV_CHECK_EQ(decompressPlanes(stored, bytesPerValue_, planes, all), true);
    std::ranges::copy(std::span(all).subspan(before * brickBytes, bytes.size()), bytes.begin());
  }
  std::span<const std::byte> rest(bytes);
  for (int brick = 0; brick < kBricks * kBricks; ++brick) {
    if ((mask >> brick & 1u) == 0) continue;
    ScalarBricks::Brick values;
    FV_CHECK_EQ(decoder_.decode(rest.first(brickBytes), values), true);
    rest = rest.subspan(brickBytes);
    place(values, chunk.cell * kChunkEdge + glm::ivec3(brick % kBricks, brick / kBricks, layer) * kEdge, densities);
  }
}

void SpooledPlanes::place(const ScalarBricks::Brick& values, glm::ivec3 first, std::span<float> densities) const {
  const glm::ivec3 end = glm::min(dimensions_ - first, kEdge);
  const std::size_t width = std::size_t(dimensions_.x), plane = width * std::size_t(dimensions_.y);
  for (glm::ivec3 v(0); v.z < end.z; ++v.z)
    for (v.y = 0; v.y < end.y; ++v.y) {
      float* const row = &densities[std::size_t(v.z) * plane + std::size_t(first.y + v.y) * width + std::size_t(first.x)];
      for (v.x = 0; v.x < end.x; ++v.x) row[v.x] = std::max(values[ScalarBricks::indexInBrick(v)], 0.0f);
    }
}

}  // namespace freevoxels::fvx
