#pragma once
// A classified volume on the device: which blocks of its octree are occupied, and the medium of those.

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

/// The gather stores extinction in this unit: 1 is an optical depth of 1 / 64 a voxel, so that half floats
/// hold optical depths from 1e-9 to 1000.
inline constexpr double kStoredDepth = 64.0;

/// A block is occupied if its extinction is above 0 or it emits light. Only occupied blocks are stored, at
/// their ranks: in the order of HierarchyLayout, level by level.
struct DeviceVolume {
  GridLayout layout;
  HierarchyLayout hierarchy;  ///< its level 0 is `layout`
  Buffer occupancy;           ///< shader::OccupancyWord for 32 blocks each, of all levels
  TexelView occupancyTexels;
  std::vector<std::uint64_t> stored;  ///< number of occupied blocks of each level; empty until the blocks are built
  Buffer extinction;                  ///< float, per world unit, of all levels
  TexelView extinctionQuads;          ///< `extinction` with four values a texel
  Buffer emission;                    ///< packed_light.h, of all levels; does not exist without emission
  Buffer colors;  ///< packed_light.h, of the voxels; does not exist if all have the albedo
  Buffer
      blockColors;  ///< four halves, of the levels above the voxels; does not exist if all have the albedo
  glm::dmat4 indexToWorld{1.0};
  glm::vec3 albedo{0.0f};
  bool hasColors = false;     ///< whether voxels have their own colours, from a transfer function or a grid
  double emissionUnit = 0.0;  ///< radiance per world unit of a stored 1; 0 if no voxel emits light
  double voxelSize = 0.0;

  /// Exists if samples are classified after interpolation and there is enough memory.
  std::optional<DeviceScalars> scalarBricks;
  bool lacksScalarBricks = false;  ///< whether scalarBricks is missing for lack of memory

  bool hasEmission() const { return emissionUnit > 0.0; }
  /// Number of occupied blocks of all levels.
  std::uint64_t storedBlocks() const;
  /// Rank of a level's first occupied block.
  std::uint32_t firstRank(int level) const;
  /// Number of occupied blocks above the voxels.
  std::uint64_t coarseBlocks() const { return storedBlocks() - stored.front(); }
  /// Offset in bytes at which a level's bounds begin in the plane of a direction of the attenuation table.
  /// Bounds follow the codes of all blocks: a byte for kBoundBlocks blocks above the voxels. A bound is what
  /// half a byte keeps of the code of the block's most transparent occupied voxel.
  std::uint32_t firstBound(int level) const;
  /// Bytes of the plane of one direction of the attenuation table.
  std::uint64_t planeBytes() const { return firstBound(int(stored.size())); }
  shader::BlockLevel onDevice(int level) const;
  shader::BlockStores stores() const;
};

/// Bytes of the extinctions of `storedBlocks` occupied blocks, in texels of four. There are two texels beyond
/// the last whole one, since expand_voxels.comp reads a texel and the next.
inline std::uint64_t extinctionBytes(std::uint64_t storedBlocks) {
  return (storedBlocks / 4 + 2) * sizeof(glm::vec4);
}

/// The volume's box, transform and colours, with nothing on a device.
DeviceVolume outlineOnDevice(const Volume& volume, const Classification& classification);

/// Makes the volume without the medium of its blocks.
DeviceVolume makeDeviceVolume(const Device& device, const Volume& volume,
                              const Classification& classification);

}  // namespace freevoxels
