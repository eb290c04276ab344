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
  /// Of a table with 98 directions, those that march the slab's way; within planes where it is upwards.
  void record(SlabSweep& sweep) const;

 private:
  int voxelsPerThread_;
  std::map<std::pair<int, int>, Pipeline> pipelines_;  ///< by the march's step in x and the rows half-way
};

}  // namespace freevoxels
