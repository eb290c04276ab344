#pragma once
// The densities of planes of a level of a baked volume that is being written.

#include <cstddef>
#include <span>

#include "engine/storage/fvx_encoding.h"
#include "engine/storage/fvx_format.h"
#include "engine/core/spool.h"
#include "engine/volume/scalar_bricks.h"

namespace freevoxels::fvx {

class SpooledPlanes {
 public:
  /// Of a level with these dimensions, whose chunks of scalars are in the spool, which is flushed. `chunks` and `spool` must outlive this
  /// object.
  SpooledPlanes(glm::ivec3 dimensions, std::span<const ChunkEntry> chunks, const Spool& spool, const Encoding& encoding)
      : dimensions_(dimensions),
        chunks_(chunks),
        spool_(spool),
        bytesPerValue_(encoding.bytesPerValue()),
        decoder_(encoding) {}

  /// Reads a brick's edge of planes, the first of which is `first`, a multiple of that. Negative values and voxels without data are 0.
  /// Uses all threads.
  void read(int first, std::span<float> densities) const;

 private:
  void readChunk(const ChunkEntry& chunk, int first, std::span<float> densities) const;
  void place(const ScalarBricks::Brick& values, glm::ivec3 first, std::span<float> densities) const;

  glm::ivec3 dimensions_;
  std::span<const ChunkEntry> chunks_;
  const Spool& spool_;
  std::size_t bytesPerValue_;
  Decoder decoder_;
};

}  // namespace freevoxels::fvx
