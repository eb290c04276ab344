#pragma once
// A classified volume on the device: which blocks of its octree hold anything, and what is kept of those.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/octree/device_scalars.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/volume/classification.h"
#include "engine/volume/grid_layout.h"
#include "engine/volume/volume.h"
#include "engine/vulkan/buffer.h"

namespace freevoxels {

/// What a gathered extinction of 1 is: an optical depth of 1 / 64 a voxel, so that halves hold depths of 1e-9 to 1000.
inline constexpr double kStoredDepth = 64.0;

/// A block holds something where its extinction is above 0 or it sends out light. What is kept of such blocks
/// is kept at their ranks: in the order of HierarchyLayout, level by level.
struct DeviceVolume {
  GridLayout layout;
  HierarchyLayout hierarchy;  ///< its level 0 is `layout`
  Buffer occupancy;           ///< shader::OccupancyWord, of all levels
  TexelView occupancyTexels;
  std::vector<std::uint64_t> stored;  ///< blocks of each level that hold anything
  Buffer extinction;                  ///< float, per world unit, of all levels
  TexelView extinctionQuads;          ///< four of them a texel
  Buffer emission;                    ///< packed_light.h, of all levels; does not exist where there is none
  Buffer colors;  ///< packed_light.h, of the voxels; does not exist where there is one colour
  Buffer
      blockColors;  ///< four halves, of the levels above the voxels; does not exist where there is one colour
  glm::dmat4 indexToWorld{1.0};
  glm::vec3 albedo{0.0f};
  bool hasColors = false;     ///< voxels have colours of their own: a transfer function's or a grid's
  double emissionUnit = 0.0;  ///< radiance per world unit that a stored 1 is; 0: no voxel sends out light
  double voxelSize = 0.0;

  /// Where samples are classified after interpolation, and there is memory for it.
  std::optional<DeviceScalars> scalarBricks;
  bool lacksScalarBricks = false;  ///< for want of memory

  bool hasEmission() const { return emissionUnit > 0.0; }
  /// Of all levels that hold anything.
  std::uint64_t storedBlocks() const;
  /// Of a level's first block that holds anything.
  std::uint32_t firstRank(int level) const;
  /// Of the levels above the voxels.
  std::uint64_t coarseBlocks() const { return storedBlocks() - stored.front(); }
  /// Where in a direction of the attenuation table a level's bounds begin: behind the codes of all blocks, a
  /// byte for kBoundBlocks blocks above the voxels: what half a byte keeps of the code of the most
  /// transparent of a block's voxels that hold anything.
  std::uint32_t firstBound(int level) const;
  /// Of a direction of the table.
  std::uint64_t planeBytes() const { return firstBound(int(stored.size())); }
  shader::BlockLevel onDevice(int level) const;
  shader::BlockStores stores() const;
};

/// Of so many blocks that hold anything, in texels of four, and two beyond the last whole one:
/// expand_voxels.comp looks at a texel and the next.
inline std::uint64_t extinctionBytes(std::uint64_t storedBlocks) {
  return (storedBlocks / 4 + 2) * sizeof(glm::vec4);
}

/// Everything but what is kept of the blocks.
DeviceVolume makeDeviceVolume(const Device& device, const Volume& volume,
                              const Classification& classification);

}  // namespace freevoxels
