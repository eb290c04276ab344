#pragma once
// A level of a volume that is drawn piece by piece: the pieces that hold data, and the light that reaches them, which is swept through the
// whole level.

#include <memory>
#include <span>
#include <vector>

#include "engine/attenuation/plane_sweep.h"
#include "engine/octree/device_volume.h"
#include "engine/piece_tree.h"
#include "engine/scene/lighting.h"

namespace freevoxels {

/// A level of a volume as frames read it.
struct CubeLevel {
  SourceLevel source;
  DeviceVolume onDevice;
  PieceTree cubes;                                  ///< in and beside which there are voxels with data
  std::vector<std::unique_ptr<SweptLight>> lights;  ///< of all lights of the last frame

  CubeLevel(std::shared_ptr<const VolumeSource> source, int level, const Classification& classification);
  const Volume& outline() const { return source.outline(); }
  Volume read(const VoxelRange& box) const { return source.source->read(source.level, box); }

  /// Sweeps `wanted` lights; keeps what was swept for those that stand. Fails with ErrorKind::OutOfMemory.
  void prepareLights(const Device& device, std::span<const Light> wanted, std::vector<StageTime>& times, const Progress& progress);
};

}  // namespace freevoxels
