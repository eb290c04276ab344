#pragma once
// What the islands of a volume, which lights are swept through one by one, have between them and the lights.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/source_rays.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

/// The rays of a light through an island, in the island's own index space, and the optical depth of the whole island along each of them.
struct IslandRays {
  VoxelRange box;
  std::array<FaceRays, 6> fans;
  std::array<std::vector<float>, 6> depths = {};  ///< by face and ray
};

/// The islands are disjoint. `source` is in the index space of the volume.
class IslandShadows {
 public:
  IslandShadows(const RaySource& source, const std::vector<IslandRays>& islands) : source_(source), islands_(islands) {}

  /// The optical depth of all other islands along each ray of a face of an island, up to the island; empty if none is in the way.
  std::vector<float> before(std::size_t island, int face) const;

 private:
  /// A ray: origin + t * direction, with the light at -infinity, or at t = 0.
  struct Line {
    glm::dvec3 origin, direction;
  };
  Line lineOf(const IslandRays& island, const FaceRays& fan, std::uint64_t ray) const;
  bool mayShadow(const IslandRays& other, const IslandRays& island) const;
  double depthAlong(const IslandRays& other, const Line& line) const;

  const RaySource& source_;
  const std::vector<IslandRays>& islands_;
};

}  // namespace freevoxels
