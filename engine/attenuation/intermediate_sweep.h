#pragma once
// The sweeps for the 72 directions that 98 have beyond the 26 of Subr et al. 2007, Section 3.1.

#include <map>
#include <utility>

#include "engine/attenuation/slab_sweep.h"
#include "engine/scene/directions.h"

namespace freevoxels {

/// COMPUTE attenuation_sweep_half.comp: a dispatch a direction and slab.
class IntermediateSweep {
 public:
  IntermediateSweep(const Device& device, AttenuationCode code, int voxelsPerThread);
  /// Records the directions whose march goes the slab's way. Directions that march within planes are recorded
  /// with upward slabs.
  void record(SlabSweep& sweep) const;

 private:
  int voxelsPerThread_;
  std::map<std::pair<int, int>, Pipeline> pipelines_;  ///< by the step of the march along x and the number of rows half-way
};

}  // namespace freevoxels
