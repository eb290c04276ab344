#pragma once
// Rays from an eye or a light through a volume, along which its optical depth is summed up exactly: Subr et
// al. 2007, Eq. 4, for one source instead of for the directions of a table.
//
// A ray belongs to the fan of its largest component, as a pixel to a face of a cube map. The rays of a fan
// meet the planes of voxels across its axis: there the extinction is interpolated bilinearly, and the depth
// so far is kept. They are half a voxel apart at the farthest plane and nearer to each other before. A depth
// is interpolated once, when a voxel looks up the rays around it; sweeps that interpolate from plane to plane
// blur it N times.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// Where the rays start, index space.
struct RaySource {
  glm::dvec3 place{0.0};    ///< a position, or at infinity the direction towards the source
  bool atInfinity = false;  ///< all rays are parallel
  bool operator==(const RaySource&) const = default;
};

/// Whether it is within the volume's box, faces included. Never at infinity.
bool isInside(const RaySource& source, glm::ivec3 dimensions);

/// Ray (i, j) meets the plane at coordinate z of `axis` at
///   origin + spacing (i, j) + (slope + spacing (i, j) convergence) (z - farthest)
/// of the other two axes, in the order of (axis + 1) % 3 and (axis + 2) % 3.
struct FaceRays {
  int axis = 0;
  int direction = 1;   ///< along the axis, away from the source: 1 or -1
  int firstPlane = 0;  ///< the nearest to the source
  int planeCount = 0;  ///< 0: no voxel's largest component is this one
  glm::ivec2 rayCount{0};
  glm::dvec2 origin{0.0}, slope{0.0};
  double convergence = 0.0;  ///< 0 where the rays are parallel
  double farthest = 0.0;     ///< coordinate of the last plane
  double spacing = 1.0;      ///< voxels, at the last plane

  std::uint64_t rays() const { return std::uint64_t(rayCount.x) * std::uint64_t(rayCount.y); }
};

/// In the order of fanIndex. Every voxel except one at the source itself lies between four rays of its fan.
/// A fan has at most about six rays for every line of voxels along its axis: where that is not enough, as for
/// a source near to the volume, they are further apart.
std::array<FaceRays, 6> faceRays(glm::ivec3 dimensions, const RaySource& source);

/// Of the depths along the rays, by fan: [plane][j][i], planes counted from the first. A code is the square
/// root of a depth's part of kOpaqueDepth, in 16 bits. Parallel rays have one fan, the others are empty.
using RayCodes = std::array<std::vector<std::uint16_t>, 6>;

/// The axis of the largest component, the first of several.
int majorAxis(glm::dvec3 direction);

/// Of the largest component of the direction in which a ray leaves the source.
int fanIndex(glm::dvec3 fromSource);

}  // namespace freevoxels
