#include "engine/storage/chunk_encoder.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <limits>

#include "engine/storage/packed_bytes.h"
#include "engine/storage/plane_codec.h"

namespace freevoxels::fvx {

namespace {

/// The mask of the bricks (ChunkEntry::brickMask) of which any value satisfies `holds(value)`.
template <typename Holds>
std::uint64_t bricksThat(const std::vector<float>& values, const Holds& holds) {
  std::uint64_t mask = 0;
  for (std::size_t first = 0; first < values.size(); first += kBrickVoxels)
    if (std::any_of(values.begin() + std::ptrdiff_t(first), values.begin() + std::ptrdiff_t(first + kBrickVoxels), holds))
      mask |= std::uint64_t(1) << first / kBrickVoxels % kChunkBricks;
  return mask;
}

/// Bricks of scalars exist wherever there are temperatures, because voxels with emission alone are drawn too.
std::uint64_t brickMask(const WriteSettings& settings, const ChunkValues& chunk, Channel channel) {
  const auto isActive = [](float value) { return value != kInactiveVoxel; };
  const std::vector<float>& values = chunk.channels[std::size_t(channel)];
  if (channel != Channel::Scalars) return bricksThat(values, isActive);
  const std::uint64_t temperatures = bricksThat(chunk.channels[std::size_t(Channel::Temperature)], isActive);
  if (!settings.leaveOutZeros) return temperatures | bricksThat(values, isActive);
  return temperatures | bricksThat(values, [](float value) { return value > 0.0f; });
}

/// Extends the entry's range by values, and counts the active ones where they are of a voxel's first component.
void summarise(std::span<const float> values, bool count, ChunkEntry& entry) {
  for (const float value : values) {
    if (value == kInactiveVoxel) continue;
    if (count) ++entry.activeVoxels;
    entry.minimum = std::min(entry.minimum, value);
    entry.maximum = std::max(entry.maximum, value);
  }
}

}  // namespace

EncodedChunk encodeChunk(const WriteSettings& settings, const ChunkValues& chunk, Channel channel) {
  const std::vector<float>& values = chunk.channels[std::size_t(channel)];
  EncodedChunk result{.entry = {.cell = chunk.cell, .brickMask = brickMask(settings, chunk, channel)}, .bytes = {}};
  ChunkEntry& entry = result.entry;
  if (entry.brickMask == 0) return result;
  const Encoding& encoding = *settings.encodings[std::size_t(channel)];
  const std::size_t components = std::max(values.size() / kChunkVoxels, std::size_t(1));
  const std::size_t brickBytes = kBrickVoxels * encoding.bytesPerValue();
  const std::vector<float> nothing(kBrickVoxels, kInactiveVoxel);
  entry.bytes = std::uint64_t(entry.bricks()) * components * brickBytes;
  result.bytes.resize(entry.bytes);
  entry.minimum = std::numeric_limits<float>::max();
  entry.maximum = -entry.minimum;
  std::span<std::byte> rest(result.bytes);
  for (int brick = 0; brick < kChunkBricks; ++brick) {
    if (!entry.hasBrick(brick)) continue;
    for (std::size_t component = 0; component < components; ++component) {
      const std::size_t first = (component * kChunkBricks + std::size_t(brick)) * kBrickVoxels;
      const std::span<const float> from =
          values.empty() ? std::span<const float>(nothing) : std::span(values).subspan(first, kBrickVoxels);
      encode(encoding, from, rest.first(brickBytes));
      rest = rest.subspan(brickBytes);
      summarise(from, component == 0, entry);
    }
  }
  if (entry.activeVoxels == 0) entry.minimum = entry.maximum = 0.0f;
  if (settings.compress) entry.codec = compressPlanes(encoding.bytesPerValue(), result.bytes);
  entry.storedBytes = result.bytes.size();
  entry.hash = XXH3_64bits(result.bytes.data(), result.bytes.size());
  return result;
}

std::vector<std::byte> encodeChunks(const WriteSettings& settings, std::span<const ChunkValues> chunks) {
  std::vector<std::array<EncodedChunk, kChannels>> encoded(chunks.size());
  std::vector<ChunkEighth> eighths(chunks.size());
  tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t i) {
    if (chunks[i].empty()) return;
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      if (settings.encodings[channel]) encoded[i][channel] = encodeChunk(settings, chunks[i], Channel(channel));
    eighths[i] = coarser(chunks[i], settings.dimensions, settings.withoutData);
  });
  BytePacker bytes;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (chunks[i].empty()) continue;
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      if (!settings.encodings[channel]) continue;
      bytes.value(encoded[i][channel].entry);
      bytes.values(encoded[i][channel].bytes);
    }
    bytes.value(eighths[i].cell);
    for (const std::vector<float>& values : eighths[i].channels) bytes.values(values);
  }
  return bytes.take();
}

}  // namespace freevoxels::fvx
