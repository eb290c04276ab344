#pragma once
// The sweeps for the 72 directions that 98 have beyond the 26 of Subr et al. 2007, Section 3.1.

#include <map>
#include <utility>

#include "engine/attenuation/directions.h"
#include "engine/volume/device_volume.h"

namespace freevoxels {

struct AttenuationTable;

/// COMPUTE attenuation_sweep_half.comp: a dispatch a direction, none of which waits for another.
class HalfSweep {
 public:
  HalfSweep(const Device& device, AttenuationCode code, int voxelsPerThread);
  /// Of a table with 98 directions, from the extinction of all voxels.
  void record(Commands& commands, const DeviceVolume& volume, const TexelView& extinction,
              const AttenuationTable& table) const;

 private:
  int voxelsPerThread_;
  std::map<std::pair<int, int>, Pipeline> pipelines_;  ///< by the march's step in x and the rows half-way
};

}  // namespace freevoxels
