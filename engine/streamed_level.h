#pragma once
// A level of a baked volume that is drawn cube by cube: which cubes hold data, and the light that reaches them, which is swept through the
// whole level.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/attenuation/plane_sweep.h"
#include "engine/lighting/ambient_pass.h"
#include "engine/octree/device_volume.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

/// Voxels along a cube's edge.
inline constexpr int kStreamedCubeEdge = 64;
static_assert(kStreamedCubeEdge % fvx::kChunkEdge == 0);

/// The voxels of the cube with this number along each axis.
inline fvx::VoxelBox cubeVoxels(glm::ivec3 cell, glm::ivec3 dimensions) {
  return {cell * kStreamedCubeEdge, glm::min((cell + 1) * kStreamedCubeEdge, dimensions)};
}

/// A level of the file as frames read it.
struct StreamedLevel {
  BakedLevel baked;
  Volume outline;
  DeviceVolume onDevice;
  std::vector<glm::ivec3> cubes;  ///< in and beside which there are voxels with data
  std::optional<AmbientPass> ambient;
  std::vector<std::unique_ptr<SweptLight>> lights;  ///< of all lights of the last frame

  StreamedLevel(std::shared_ptr<const fvx::FvxFile> file, int level, const Classification& classification);

  /// Sweeps `wanted` lights; keeps what was swept for those that stand. Fails with ErrorKind::OutOfMemory.
  void prepareLights(const Device& device, std::span<const Light> wanted, std::vector<StageTime>& times, const Progress& progress);
  /// Sweeps ambient light if it or, with a phase function, the eye is another than before.
  void prepareAmbient(const Device& device, const Lighting& lighting, const RaySource& eye, std::vector<StageTime>& times,
                      const Progress& progress);
};

}  // namespace freevoxels
