#pragma once
// The attenuation table computed the plain way, on the CPU in double precision: Subr et al. 2007,
// Section 3.1, Eq. 5. Shares nothing with the shaders but the direction order and the codes.

#include <cstdint>
#include <vector>

#include "engine/attenuation/directions.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Extinction of every voxel of the volume, x fastest, per world unit.
std::vector<double> referenceExtinction(const Volume& volume, const Classification& classification);

/// Optical depth from each voxel's neighbour along `directionAt(direction)` to the outside: exclusive of the
/// voxel.
std::vector<double> referenceOpticalDepth(const Volume& volume, const std::vector<double>& extinction,
                                          int direction, bool pathLengthCorrection);

/// The bytes of the table for all 26 directions, [direction][voxel].
std::vector<std::vector<std::uint8_t>> referenceTable(const Volume& volume,
                                                      const std::vector<double>& extinction,
                                                      AttenuationCode code, bool pathLengthCorrection);

}  // namespace freevoxels
