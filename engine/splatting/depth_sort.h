#pragma once
// The visible voxels back to front, for the sorted composite: Subr et al. 2007, Section 4.1.

#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/camera.h"
#include "engine/splatting/radix_sort.h"

namespace freevoxels {

/// COMPUTE depth_key.comp and those of RadixSort
class DepthSort {
 public:
  DepthSort(const Device& device, const DeviceVolume& volume);

  /// Farthest first by the distance of the voxel's centre in world space: from the eye, or for an
  /// orthographic camera along the viewing axis. Distances are 32-bit floats relative to that of the volume's
  /// middle; where they are equal, voxels keep the order of their indices.
  void record(Commands& commands, const DeviceVolume& volume, const BlockList& visible,
              const Camera& camera) const;
  /// uint: padded voxel indices, as many as there are visible voxels.
  const Buffer& voxels() const { return pairs_.values; }

 private:
  Pipeline keys_;
  RadixSort sort_;
  SortPairs pairs_;
};

}  // namespace freevoxels
