#pragma once
// The attenuation table computed directly on the CPU in double precision: Subr et al. 2007, Section 3.1, Eq.
// 5. Shares only the order of directions and the codes with the renderer.

#include <cstdint>
#include <vector>

#include "engine/scene/table_settings.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Extinction of every voxel of the volume, x fastest, per world unit.
std::vector<double> referenceExtinction(const Volume& volume, const Classification& classification);

/// Optical depth from half a layer beyond each voxel's centre to the outside, along a direction of the set,
/// without the voxel itself.
std::vector<double> referenceOpticalDepth(const Volume& volume, const std::vector<double>& extinction,
                                          DirectionSet set, int direction, bool pathLengthCorrection);

/// The bytes of the table for all directions of the set, [direction][voxel].
std::vector<std::vector<std::uint8_t>> referenceTable(const Volume& volume,
                                                      const std::vector<double>& extinction,
                                                      const TableSettings& settings);

}  // namespace freevoxels
