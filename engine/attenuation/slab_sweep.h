#pragma once
// What the sweeps of one slab of a volume share.

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
  const TexelView& extinction;  ///< of the slab's voxels
  const Buffer& carriedDepths;
  int firstQuad = 0;       ///< of `extinction`, among all quads of voxels
  std::uint32_t kept = 0;  ///< depths that the sweeps so far keep of their lines

  /// A march along z, of which `floats` depths are kept for the next slab.
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
  /// The first voxel's, among all with the padding.
  int firstVoxel() const {
    const glm::ivec3 extent = volume.layout.dimensions;
    return slab.lowest(extent.z) * extent.y * volume.layout.rowPitch;
  }
};

}  // namespace freevoxels
