#pragma once
// Optical depths along the ray fans of a source, on the device: a thread a ray. What is kept of the volume is
// expanded first, a slab of planes at a time: to look up a voxel's place among those that hold anything takes
// several times as long as its extinction, and four rays share it.

#include <cstdint>
#include <limits>

#include "engine/octree/device_volume.h"
#include "engine/octree/occupancy.h"
#include "engine/scene/source_rays.h"
#include "engine/vulkan/commands.h"
#include "shaders/interface.h"

namespace freevoxels {

/// On the device, of the rays of a source.
std::uint64_t rayBytes(glm::ivec3 dimensions, const RaySource& source);

/// COMPUTE expand_voxels.comp and ray_sweep.comp, a dispatch each for a fan's every slab.
class RaySweep {
 public:
  /// Its time is that of the pass `name`.
  explicit RaySweep(const Device& device, const char* name = "ray sweep");

  /// For the depths of this source, which may take no more than `mostBytes`: fails with
  /// ExitCode::OutOfMemory where there is none. No work may be under way on those of the last source.
  void makeRoom(glm::ivec3 dimensions, const RaySource& source,
                std::uint64_t mostBytes = std::numeric_limits<std::uint64_t>::max());
  /// Sweeps the volume for this source; the depths replace those of the last one. Makes room if need be. With `scalars` from
  /// the volume's scalars, classified after interpolation; depths then are those up to the planes of voxels, not those in
  /// front of their layers.
  void record(Commands& commands, const DeviceVolume& volume, const RaySource& source, bool scalars = false);
  /// Of the last source, for look-ups: index 2 axis + (direction > 0). Parallel rays have one fan, which is
  /// in all six places, so that no look-up has to choose it with the same rounding.
  const std::array<shader::FaceRays, 6>& fans() const { return fans_; }
  /// Sweeps, waits and copies to the host: for validation.
  RayCodes sweep(const DeviceVolume& volume, const RaySource& source);

 private:
  void recordFan(Commands& commands, const DeviceVolume& volume, const FaceRays& fan,
                 const shader::FaceRays& onDevice, bool scalars) const;
  void recordScalars(Commands& commands, const DeviceVolume& volume, glm::ivec3 first, glm::ivec3 extent) const;

  const Device& device_;
  const char* name_;
  ExpandPass expand_;
  std::array<Pipeline, 2> pipelines_;  ///< by whether of scalars
  Pipeline expandScalars_;
  Buffer slab_;  ///< float: extinction of its voxels
  TexelView slabTexels_;
  Buffer carried_;  ///< float, by ray: depth between slabs
  Buffer depths_;  ///< uint: codes of planes 2k and 2k + 1; by fan, k and ray
  std::array<shader::FaceRays, 6> fans_{};
};

}  // namespace freevoxels
