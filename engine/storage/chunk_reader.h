#pragma once
// The values of chunks of a baked volume, none of which is handed out before it was checked.

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <span>

#include "engine/storage/fvx_encoding.h"
#include "engine/storage/fvx_file.h"
#include "engine/volume/scalar_bricks.h"

namespace freevoxels::fvx {

/// Reads the chunks of one level of a channel. Several threads may read at the same time. The file must outlive it.
class ChunkReader {
 public:
  ChunkReader(const FvxFile& file, Channel channel, int level);

  /// Decodes the bricks of a chunk, in the order of the bits of its mask, for each of them the values of a voxel one after the other.
  /// `brickOf(number, component)` is the memory of one, which is to be filled, or null. Fails with ErrorKind::Input if the chunk is damaged
  /// or a value is none that can be stored: NaN, infinite, beyond the volume's box, or beyond the chunk's range.
  template <typename BrickOf>
  void read(const ChunkEntry& chunk, const BrickOf& brickOf) const {
    std::span<const std::byte> bytes = file_.read(channel_, chunk, buffers_.local());
    std::size_t number = 0;
    for (int brick = 0; brick < kChunkBricks; ++brick) {
      if (!chunk.hasBrick(brick)) continue;
      for (std::size_t component = 0; component < components_; ++component, bytes = bytes.subspan(brickBytes_))
        if (ScalarBricks::Brick* const values = brickOf(number, component)) decode(chunk, brick, bytes.first(brickBytes_), *values);
      ++number;
    }
  }
  /// The same for all bricks, of a channel with one value for each voxel.
  void readAll(const ChunkEntry& chunk, std::span<ScalarBricks::Brick> bricks) const;
  /// Fails with ErrorKind::Input if anything of a chunk is damaged, or if its values are not as its entry says.
  void check(const ChunkEntry& chunk) const;

 private:
  void decode(const ChunkEntry& chunk, int brick, std::span<const std::byte> bytes, ScalarBricks::Brick& values) const;
  void checkValues(const ChunkEntry& chunk, int brick, bool finite, ScalarBricks::Brick& values) const;
  void checkRange(const ChunkEntry& chunk, const ScalarBricks::Brick& values) const;
  [[noreturn]] void failContradicts(const ChunkEntry& chunk) const;

  const FvxFile& file_;
  const Channel channel_;
  const glm::ivec3 dimensions_;
  const Encoding& encoding_;
  const std::size_t components_, brickBytes_;
  const Decoder decoder_;
  mutable tbb::enumerable_thread_specific<ReadBuffers> buffers_;
};

}  // namespace freevoxels::fvx
