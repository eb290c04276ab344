#pragma once
// Volumes with fewer voxels: means of blocks, for quick images, and parts.

#include "engine/volume/volume.h"

namespace freevoxels {

/// How voxels without data count in a mean.
enum class WithoutData {
  Zero,     ///< as 0, like values below 0: for densities, where no data means empty space
  Ignored,  ///< not at all: for values that are classified
};

/// A volume whose voxels are the means of blocks of factor³ voxels, at the same place in the world.
/// Temperatures and albedos are means of the voxels that have data.
Volume coarseVolume(const Volume& volume, int factor, WithoutData withoutData);

/// Voxels from `first` to `last`, inclusive.
struct VoxelBox {
  glm::ivec3 first{0}, last{0};

  bool operator==(const VoxelBox&) const = default;
};

/// The part of a volume in a box, which is cut to the volume's box and must then have at least one voxel. Every voxel keeps its
/// value and its place in the world; outside of the box there is no data. `minimum` and `maximum` stay those of the whole volume,
/// so that a transfer function without a range means the same.
Volume clippedVolume(const Volume& volume, const VoxelBox& box);

/// A plane in the world. What lies on the side to which `normal` points is clipped; its length, which is not 0, means nothing.
struct ClipPlane {
  glm::dvec3 point{0.0}, normal{1.0, 0.0, 0.0};

  bool operator==(const ClipPlane&) const = default;
};

/// The volume without the voxels whose centres lie on the clipped side of a plane. The box and everything else stay as they are,
/// `minimum` and `maximum` too. There may be no voxel left.
Volume clippedVolume(const Volume& volume, const ClipPlane& plane);

}  // namespace freevoxels
