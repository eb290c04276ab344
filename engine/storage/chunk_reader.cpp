#include "engine/storage/chunk_reader.h"

#include <algorithm>
#include <vector>

#include "engine/core/error.h"
#include "engine/storage/fvx_index.h"

namespace freevoxels::fvx {

namespace {

constexpr int kBrickEdge = ScalarBricks::kEdge;

/// Calls `visit(value)` for the voxels of a brick that are not among its first `inside` ones along each axis.
template <typename Visit>
void forVoxelsBeyond(glm::ivec3 inside, ScalarBricks::Brick& values, const Visit& visit) {
  if (inside == glm::ivec3(kBrickEdge)) return;
  for (glm::ivec3 v(0); v.z < kBrickEdge; ++v.z)
    for (v.y = 0; v.y < kBrickEdge; ++v.y) {
      const bool isBeyond = v.y >= inside.y || v.z >= inside.z;
      for (v.x = isBeyond ? 0 : inside.x; v.x < kBrickEdge; ++v.x) visit(values[ScalarBricks::indexInBrick(v)]);
    }
}

}  // namespace

ChunkReader::ChunkReader(const FvxFile& file, Channel channel, int level)
    : file_(file),
      channel_(channel),
      dimensions_(file.dimensions(level)),
      encoding_(*file.description().encodings[std::size_t(channel)]),
      components_(file.description().valuesPerVoxel(channel)),
      brickBytes_(kBrickVoxels * encoding_.bytesPerValue()),
      decoder_(encoding_) {}

void ChunkReader::readAll(const ChunkEntry& chunk, std::span<ScalarBricks::Brick> bricks) const {
  FV_CHECK_EQ(components_, std::size_t(1));
  FV_CHECK_EQ(bricks.size(), std::size_t(chunk.bricks()));
  if (encoding_.kind != EncodingKind::Float32 || chunk.codec != Codec::None)
    return read(chunk, [&](std::size_t number, std::size_t) { return &bricks[number]; });
  file_.read(chunk, std::as_writable_bytes(bricks));  // as they are
  std::size_t number = 0;
  for (int brick = 0; brick < kChunkBricks; ++brick) {
    if (!chunk.hasBrick(brick)) continue;
    checkValues(chunk, brick, areFinite(bricks[number]), bricks[number]);
    ++number;
  }
}

void ChunkReader::decode(const ChunkEntry& chunk, int brick, std::span<const std::byte> bytes, ScalarBricks::Brick& values) const {
  const bool finite = decoder_.decode(bytes, values);
  checkValues(chunk, brick, finite, values);
}

void ChunkReader::checkValues(const ChunkEntry& chunk, int brick, bool finite, ScalarBricks::Brick& values) const {
  if (!finite) file_.failDamaged(fmt::format("{} has a value that is NaN or infinite", nameOf(chunk)));
  const glm::ivec3 inside = glm::min(dimensions_ - chunk.brickCell(brick) * kBrickEdge, kBrickEdge);
  bool isEmpty = true;
  forVoxelsBeyond(inside, values, [&](float& value) {
    isEmpty = isEmpty && value == kInactiveVoxel;
    value = kInactiveVoxel;
  });
  // Version 0.1 stored albedos beyond the box, where the file it read had some.
  if (!isEmpty && channel_ != Channel::Albedo) file_.failDamaged(fmt::format("{} has a value beyond the volume's box", nameOf(chunk)));
  checkRange(chunk, values);
}

void ChunkReader::checkRange(const ChunkEntry& chunk, const ScalarBricks::Brick& values) const {
  const auto [least, most] = encoding_.decodedRange(chunk.minimum, chunk.maximum);
  int outside = 0;  // counted, as the compiler makes vector instructions of sums and not of a bool
  for (const float value : values) outside += (value != kInactiveVoxel) & ((value < least) | (value > most));
  if (outside > 0) failContradicts(chunk);
}

void ChunkReader::failContradicts(const ChunkEntry& chunk) const {
  file_.failDamaged(fmt::format("{} has other values than its entry in the index says", nameOf(chunk)));
}

void ChunkReader::check(const ChunkEntry& chunk) const {
  ScalarBricks::Bricks bricks(std::size_t(chunk.bricks()) * components_);
  read(chunk, [&](std::size_t number, std::size_t component) { return &bricks[number * components_ + component]; });
  std::size_t active = 0;
  for (std::size_t i = 0; i < bricks.size(); i += components_)
    active += std::size_t(std::ranges::count_if(bricks[i], [](float value) { return value != kInactiveVoxel; }));
  if (active != chunk.activeVoxels && channel_ != Channel::Albedo) failContradicts(chunk);  // see checkValues()
}

}  // namespace freevoxels::fvx
