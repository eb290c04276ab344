#pragma once
// Parts of a level that can be drawn on their own: Subr et al. 2007, Section 5.
//
// A region is a cube of kRegionEdge^3 voxels. Beside its voxels it has a halo of kRegionHalo voxels on each side, as far as the volume
// reaches, which gradients and the mean over a kernel read; and the optical depths where lattice lines enter it, from which its
// attenuation table is swept without the rest of the volume (Section 3.1, Eq. 5).

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/storage/fvx_encoding.h"
#include "engine/storage/fvx_format.h"

namespace freevoxels::fvx {

/// The voxels `first` to `end` - 1 of a level.
struct VoxelBox {
  glm::ivec3 first{0}, end{0};
  glm::ivec3 extent() const { return end - first; }
  std::uint64_t voxels() const { return std::uint64_t(extent().x) * std::uint64_t(extent().y) * std::uint64_t(extent().z); }
};

/// The box of a region without its halo, and with it. `dimensions` are those of the level.
VoxelBox regionVoxels(glm::ivec3 cell, glm::ivec3 dimensions);
VoxelBox regionWithHalo(glm::ivec3 cell, glm::ivec3 dimensions);

/// Number of regions of a level along the axes.
inline glm::ivec3 regionCells(glm::ivec3 dimensions) {
  return (dimensions + kRegionEdge - 1) / kRegionEdge;
}

/// The side of a region through which lines towards `direction` leave it; a sweep against the direction enters there. The side has
/// the voxels of the box whose coordinate along `axis` is the largest where direction[axis] > 0, else the least.
struct EntryFace {
  glm::ivec3 direction{0};  ///< of the 26 of directions.h, from the voxel towards the outside
  int axis = 0;             ///< direction[axis] is not 0
};

/// In the order of the file: directions in the order of directions.h, the faces of each by axis.
const std::array<EntryFace, kEntryFaces>& entryFaces();

/// Number of voxels of a face of a box. They are ordered by the other two axes, the lower one fastest.
std::size_t faceVoxels(glm::ivec3 extent, int axis);

/// Calls `use(first, end, index)` for each row of voxels of the halo, whose voxels have the x from `first.x` to `end` - 1, in the order in which the halo
/// is stored: x fastest, then y, then z. `index` counts the halo's voxels before the row.
template <typename Use>
void forHaloRows(glm::ivec3 cell, glm::ivec3 dimensions, const Use& use) {
  const VoxelBox own = regionVoxels(cell, dimensions), box = regionWithHalo(cell, dimensions);
  std::size_t index = 0;
  const auto row = [&](int first, int end, int y, int z) {
    if (first >= end) return;
    use(glm::ivec3(first, y, z), end, index);
    index += std::size_t(end - first);
  };
  for (int z = box.first.z; z < box.end.z; ++z)
    for (int y = box.first.y; y < box.end.y; ++y) {
      const bool beside = y < own.first.y || y >= own.end.y || z < own.first.z || z >= own.end.z;
      row(box.first.x, beside ? box.end.x : own.first.x, y, z);
      if (!beside) row(own.end.x, box.end.x, y, z);
    }
}
inline std::size_t haloVoxels(glm::ivec3 cell, glm::ivec3 dimensions) {
  return std::size_t(regionWithHalo(cell, dimensions).voxels() - regionVoxels(cell, dimensions).voxels());
}

/// The depth of each voxel of a region's faces, without the voxel itself: 0 of faces that are not stored.
struct EntryDepths {
  std::array<std::size_t, kEntryFaces> first{};  ///< of each face in `values`
  std::vector<float> values;
};

/// What a region has beside its own voxels.
struct RegionSurroundings {
  EntryDepths depths;
  std::vector<float> halo;  ///< scalars, 0 where there are none; empty if all are
};

/// Bits of RegionEntry::parts: a bit for each of entryFaces(), and one for the halo.
inline constexpr std::uint64_t kHaloPart = std::uint64_t(1) << kEntryFaces;

/// Bytes of the stored parts of a region: the faces, then the halo in the encoding of the scalars.
std::uint64_t regionBytes(glm::ivec3 cell, glm::ivec3 dimensions, std::uint64_t parts, const Encoding& encoding);
/// Nothing if a value is NaN or infinite.
std::optional<RegionSurroundings> decodeRegion(glm::ivec3 cell, glm::ivec3 dimensions, std::uint64_t parts, const Encoding& encoding,
                                               std::span<const std::byte> bytes);

/// round(65535 sqrt(min(depth, 16) / 16)): what the table's own bytes cannot tell apart from 16 needs no more.
std::uint16_t encodeEntryDepth(float depth);
float decodeEntryDepth(std::uint16_t code);

}  // namespace freevoxels::fvx
