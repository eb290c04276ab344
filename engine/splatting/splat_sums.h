#pragma once
// The sums of a frame before the resolve, on the host: Subr et al. 2007, Section 4.1, Eq. 10. Sums of any
// parts of a volume are added and resolved once.

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/splatting/splat_pass.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

/// The sums of one pixel; lengths are of the world. Additive over any partition of the voxels.
struct SplatSums {
  glm::dvec3 color{0.0};  ///< C
  double energy = 0.0;    ///< E
  double depth = 0.0;     ///< T, optical depth along the pixel's ray
  double distance = 0.0;  ///< sum of e_v times the voxel's distance along the viewing axis

  SplatSums& operator+=(const SplatSums& other);
};

/// Copies a frame's sums to the host: recorded after SplatPass in place of the resolve, read when the
/// commands are done.
class SumsReadback {
 public:
  SumsReadback(const Device& device, Commands& commands, const SplatTargets& targets);
  /// One a pixel, row 0 is the top. `distance` stays 0 where the targets have none.
  std::vector<SplatSums> read(const FrameConstants& frame) const;

 private:
  TargetReadback colorEnergy_, opticalDepth_;
  std::optional<TargetReadback> distance_;
};

}  // namespace freevoxels
