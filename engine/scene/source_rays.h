#pragma once
// Rays from an eye or a light through a volume, along which the optical depth is summed up exactly: Subr et
// al. 2007, Eq. 4, for one source instead of for the directions of a table.
//
// Rays are grouped by the axis and sign of their largest component, like the pixels of a cube map by its
// faces. The rays of a face meet the planes of voxels across its axis: there the extinction is interpolated
// bilinearly and the optical depth so far is stored. At the farthest plane they are half a voxel apart,
// nearer to the source closer. A voxel interpolates between the rays around it once; a sweep that
// interpolates from plane to plane would blur the depths N times.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// The origin of the rays in index space.
struct RaySource {
  glm::dvec3 place{0.0};    ///< a position, or for a source at infinity the direction towards it
  bool atInfinity = false;  ///< the rays are parallel
  bool operator==(const RaySource&) const = default;
};

/// Whether the source is inside the volume's box, faces included. Always false at infinity.
bool isInside(const RaySource& source, glm::ivec3 dimensions);

/// Ray (i, j) meets the plane at coordinate z of `axis` at
///   origin + spacing (i, j) + (slope + spacing (i, j) convergence) (z - farthest)
/// of the other two axes, in the order of (axis + 1) % 3 and (axis + 2) % 3.
struct FaceRays {
  int axis = 0;
  int direction = 1;   ///< along the axis, away from the source: 1 or -1
  int firstPlane = 0;  ///< coordinate of the plane nearest to the source
  int planeCount = 0;  ///< 0 if no voxel lies on this face
  glm::ivec2 rayCount{0};
  glm::dvec2 origin{0.0}, slope{0.0};
  double convergence = 0.0;  ///< 0 if the rays are parallel
  double farthest = 0.0;     ///< coordinate of the last plane
  double spacing = 1.0;      ///< voxels, at the last plane

  std::uint64_t rays() const { return std::uint64_t(rayCount.x) * std::uint64_t(rayCount.y); }
};

/// The rays of all faces, in the order of fanIndex. Every voxel except one at the source itself lies between
/// four rays of its face. A face has at most about six rays for every line of voxels along its axis; if half
/// a voxel would need more, as for a source near the volume, the rays are farther apart.
std::array<FaceRays, 6> faceRays(glm::ivec3 dimensions, const RaySource& source);

/// The encoded depths of each face: [plane][j][i], planes counted from the first. A code is the square root
/// of depth / kOpaqueDepth in 16 bits. Parallel rays use one face; the others are empty.
using RayCodes = std::array<std::vector<std::uint16_t>, 6>;

/// The axis of the largest absolute component, the first one if there are several.
int majorAxis(glm::dvec3 direction);

/// The index of the face of a direction from the source: 2 axis + (component > 0).
int fanIndex(glm::dvec3 fromSource);

}  // namespace freevoxels
