#pragma once
// Parts of a gathered frame are rows of its samples. Every sample belongs to one part, and is that of the undivided frame, to the same
// bits. The sums of all parts, which are added in fixed point, have the same bits, however many parts there are: Subr et al. 2007,
// Section 4.4, for samples of the image instead of blocks of the volume.

#include <glm/glm.hpp>
#include <vector>

#include "engine/gathering/gather_stages.h"
#include "engine/image/fixed_sums.h"
#include "engine/splatting/shares.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// The first and the end of a part's rows of the lattice; none where there are more parts than rows. Whole cells (gather_adaptive.glsl), so
/// that a part can be refined.
glm::ivec2 rowsOfPart(const shader::GatherFrame& frame, const SharePart& part);

/// The frame in which these rows are marched, with as many coarse samples around them as their interpolation reads.
shader::GatherFrame frameOfRows(const shader::GatherFrame& frame, glm::ivec2 rows);

/// The sums of the samples that are seen, all 0. `layout` describes the sums of the frame's pixels, of which those of samples take the
/// digits.
FixedSums sumsOfSamples(const shader::GatherFrame& frame, bool scalars, FixedSums layout);

/// Adds the samples of some rows of the lattice, which `samples` has alone; `lightAlone` where the same samples were added with other
/// lights.
void addSamples(FixedSums& sums, const std::vector<GatherSums>& samples, glm::ivec2 rows, bool lightAlone = false);

}  // namespace freevoxels
