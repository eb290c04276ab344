#pragma once
// Optical depths along the rays of a source, on the device, with a thread for each ray: Subr et al. 2007, Eq. 5, along rays that enter
// the volume through its faces, each face with a fan of them, instead of along lattice lines (Section 4.3). The volume is first
// expanded to a dense grid, a slab of planes at a time: finding a voxel's rank takes several times as long as
// reading its extinction, and four rays share each voxel.

#include <cstdint>
#include <optional>

#include "engine/core/parameter.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/occupancy.h"
#include "engine/octree/occupied_cells.h"
#include "engine/scene/source_rays.h"
#include "engine/vulkan/commands.h"
#include "shaders/interface.h"

namespace freevoxels {

/// A fan, the rays that enter through one face, as shaders have it, with the device address of their depths.
shader::FaceRays deviceFan(const FaceRays& fan, VkDeviceAddress depths);

/// Bytes of device memory for the rays of a source.
std::uint64_t rayBytes(glm::ivec3 dimensions, const RaySource& source);

/// Extinctions per world unit on the device, as single-precision texels, x fastest, with a border of one cell without extinction on all
/// sides.
struct DenseExtinction {
  glm::ivec3 dimensions;    ///< without the border
  glm::dmat3 indexToWorld;  ///< linear part
  const TexelView& texels;
};
/// Bytes of device memory for the rays of a source through a dense grid, without those of the grid.
std::uint64_t denseRayBytes(glm::ivec3 dimensions, const RaySource& source);

/// Bytes of device memory for the sweep of a source.
struct RayRoom {
  std::uint64_t depths = 0;   ///< for the depths of all faces
  std::uint64_t largest = 0;  ///< the largest part of `depths` that a single face has
  std::uint64_t slab = 0, carried = 0;

  std::uint64_t bytes() const { return depths + slab + carried; }
};

/// COMPUTE expand_voxels.comp and ray_sweep.comp: a dispatch of each for every slab of a face.
class RaySweep {
 public:
  /// `name` is the pass that its time is reported as.
  explicit RaySweep(const Device& device, const char* name = "ray sweep");

  /// Records the sweep for a source; its depths replace those of the last one, on which no work may be in progress. Allocates memory if
  /// necessary; fails with ErrorKind::OutOfMemory if there is not enough.
  /// With `scalars`, extinction is classified from the volume's scalars after interpolation, and the depths
  /// are those up to the planes of voxels instead of those in front of their layers.
  /// Where `cells` is given, rays do not look at the voxels of cells that are far from it, for the same bits in less time.
  void record(Commands& commands, const DeviceVolume& volume, const RaySource& source, bool scalars = false,
              const OccupiedCells* cells = nullptr);
  /// The same through a grid of extinctions.
  void record(Commands& commands, const DenseExtinction& grid, const RaySource& source);
  /// The rays of the last source, for look-ups, at index 2 axis + (direction > 0). Parallel rays have one
  /// face, which is stored in all six places, so that a look-up need not choose it with the same rounding.
  const std::array<shader::FaceRays, 6>& fans() const { return fans_; }
  /// The depths of all faces, and their texels if the device can view so many.
  const Buffer& depths() const { return depths_; }
  const std::optional<TexelView>& depthTexels() const { return depthTexels_; }
  /// Sweeps and copies the depths to the host, for validation. Blocks until the device is done.
  RayCodes sweep(const DeviceVolume& volume, const RaySource& source, bool scalars = false, const OccupiedCells* cells = nullptr);

 private:
  /// What the rays of a face march through: planes `begin` to `end` - 1 of the face, in a box that begins at voxel `first`.
  struct SweptBox {
    int begin, end;
    glm::ivec3 first, extent;
    glm::ivec3 dimensions;    ///< of the volume
    glm::dmat3 indexToWorld;  ///< linear part, times the unit of extinction
    const TexelView& extinction;
    const TexelView& table;      ///< of the transfer function
    const OccupiedCells* cells;  ///< null if it is not known
  };
  template <typename RecordFan>
  void recordFans(const std::array<FaceRays, 6>& fans, const RecordFan& recordFan);
  void makeRoom(const RayRoom& room, const char* needs, const Parameter& without);
  void recordFan(Commands& commands, const DeviceVolume& volume, const FaceRays& fan, const shader::FaceRays& onDevice, bool scalars,
                 const OccupiedCells* cells) const;
  void recordBox(Commands& commands, const shader::FaceRays& fan, const SweptBox& box, bool scalars) const;
  void recordScalars(Commands& commands, const DeviceVolume& volume, glm::ivec3 first, glm::ivec3 extent) const;

  const Device& device_;
  const char* name_;
  ExpandPass expand_;
  Buffer slab_;  ///< float: extinction of the voxels of a slab
  TexelView slabTexels_, slabQuads_;
  TexelView noTexels_;  ///< bound where shaders read none
  Buffer carried_;  ///< float, by ray: optical depth between slabs
  Buffer depths_;  ///< uint: codes of planes 2k and 2k + 1, by face, k and ray
  std::optional<TexelView> depthTexels_;
  std::array<shader::FaceRays, 6> fans_{};
};

}  // namespace freevoxels
