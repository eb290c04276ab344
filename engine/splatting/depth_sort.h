#pragma once
// The order of the occupied voxels from back to front, for the sorted composite: Subr et al. 2007, Section
// 4.1.

#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/camera.h"
#include "engine/splatting/radix_sort.h"

namespace freevoxels {

/// COMPUTE depth_key.comp and the passes of RadixSort.
class DepthSort {
 public:
  DepthSort(const Device& device, const DeviceVolume& volume);

  /// Sorts by the distance of the voxel's centre in world space, the farthest first: from the eye, or for an
  /// orthographic camera along the viewing axis. Distances are 32-bit floats relative to that of the volume's
  /// middle. Voxels of equal distance keep the order of their indices.
  void record(Commands& commands, const DeviceVolume& volume, const BlockList& visible,
              const Camera& camera) const;
  /// uint: padded indices of all occupied voxels.
  const Buffer& voxels() const { return pairs_.values; }

 private:
  Pipeline keys_;
  RadixSort sort_;
  SortPairs pairs_;
};

}  // namespace freevoxels
