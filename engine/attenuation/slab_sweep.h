#pragma once
// The data that all sweeps of a slab share.

#include <array>
#include <cstdint>

#include "engine/attenuation/slabs.h"
#include "engine/octree/device_volume.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

struct AttenuationTable;

struct SlabSweep {
  Commands& commands;
  const DeviceVolume& volume;
  const AttenuationTable& table;
  Slab slab;
  const TexelView& extinction;  ///< extinction of the slab's voxels
  const Buffer& carriedDepths;
  int firstQuad = 0;       ///< index of the first quad of `extinction` among all quads of voxels
  std::uint32_t kept = 0;  ///< number of depths that the sweeps recorded so far carry between slabs

  /// A march along z that carries `floats` depths to the next slab.
  shader::SweepSlab marchAlongZ(std::uint64_t floats) {
    const shader::SweepSlab result{
        .firstPlane = slab.first, .endPlane = slab.end, .firstQuad = firstQuad, .firstDepth = kept};
    kept += std::uint32_t(floats);
    return result;
  }
  /// A march of `steps` within each of the slab's planes.
  shader::SweepSlab marchWithinPlanes(int steps) const {
    return {.firstPlane = 0, .endPlane = steps, .firstQuad = firstQuad, .firstDepth = 0};
  }
  std::array<Binding, 4> bindings(const Buffer& plane) const {
    return {&extinction, &plane, &volume.occupancyTexels, &carriedDepths};
  }
  /// Padded index of the slab's first voxel.
  int firstVoxel() const {
    const glm::ivec3 extent = volume.layout.dimensions;
    return slab.lowest(extent.z) * extent.y * volume.layout.rowPitch;
  }
};

}  // namespace freevoxels
