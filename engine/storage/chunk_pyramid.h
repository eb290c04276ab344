#pragma once
// The levels of the octree above the voxels while chunks of the voxels stream by in Hilbert order: the eight children of a chunk
// are consecutive in that order, so that one unfinished chunk of each level is all that has to be held.

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/storage/fvx_format.h"
#include "engine/volume/coarse_volume.h"

namespace freevoxels::fvx {

/// The values of kChunkEdge^3 voxels; kInactiveVoxel beyond the volume.
struct ChunkValues {
  glm::ivec3 cell{0};
  /// The values of each Channel: [component][brick][voxel of the brick], x fastest in the last two. Empty if no voxel has a
  /// value.
  std::array<std::vector<float>, kChannels> channels;

  /// The value of a component at a voxel of the chunk.
  static std::size_t index(glm::ivec3 voxel) {
    constexpr int n = ScalarBricks::kEdge, m = kChunkEdge / n;
    const glm::ivec3 brick = voxel / n;
    return std::size_t(brick.x + m * (brick.y + m * brick.z)) * kBrickVoxels + ScalarBricks::indexInBrick(voxel % n);
  }
  bool empty() const;
};

/// Dimensions of each level, level 0 first: halved and rounded up until one chunk holds all, or there are kMaxLevels.
std::vector<glm::ivec3> levelDimensions(glm::ivec3 dimensions);

/// From voxel indices of a level to the world: a voxel of level l is a cube of 2^l voxels of level 0.
glm::dmat4 levelToWorld(const glm::dmat4& indexToWorld, int level);

/// The means of each 2^3 voxels of a chunk, as the eighth of its parent chunk: kChunkEdge / 2 voxels along
/// each axis, x fastest. Voxels beyond `dimensions`, which are those of the chunk's level, do not count.
struct ChunkEighth {
  glm::ivec3 cell{0};  ///< of the chunk
  std::array<std::vector<float>, kChannels> channels;
};
ChunkEighth coarser(const ChunkValues& chunk, glm::ivec3 dimensions, WithoutData withoutData);

class ChunkPyramid {
 public:
  /// `emit` receives each chunk of the levels above 0 when it is complete, those of a level in Hilbert order.
  using Emit = std::function<void(int level, const ChunkValues&)>;
  ChunkPyramid(glm::ivec3 dimensions, WithoutData withoutData, Emit emit);

  /// Adds a chunk of level 0. Chunks must come in Hilbert order; empty ones may be left out.
  void add(const ChunkEighth& eighth) { add(eighth, 1); }
  /// To be called after the last chunk.
  void finish();

 private:
  void add(const ChunkEighth& eighth, std::size_t level);
  void complete(std::size_t level);

  std::vector<glm::ivec3> dimensions_;
  WithoutData withoutData_;
  Emit emit_;
  std::vector<std::optional<ChunkValues>> pending_;  ///< unfinished chunk of each level
};

}  // namespace freevoxels::fvx
