#pragma once
// The lattice, the blocks and the sums of the samples of a gathered frame, compared with those of the reference.

#include <string>
#include <vector>

#include "engine/gathering/gather_stages.h"
#include "engine/reference/reference_gather.h"
#include "engine/validation/report.h"
#include "engine/validation/validation_scene.h"

namespace freevoxels {

/// An error in a sample or in a pixel's distance counts relative to that, but to no less than this part of the largest.
constexpr double kErrorFloor = 5e-2;
constexpr double kMinComparedEnergy = 1e-3;  ///< of samples and pixels whose distance is compared

Check checkLattice(const GatherLattice& lattice, const GatherLattice& reference, const char* frame);

/// "block (1, 2, 3) of level 0", for an index among a level's `n` blocks.
std::string blockText(glm::ivec3 n, std::size_t i, std::size_t level);
/// Adds checks of the blocks of all levels that the frame reads; `lit` says whether lights are evaluated at samples, so that emission is
/// kept apart.
void checkBlocks(const GatherStages& stages, const ValidationScene& scene, bool lit, const char* frame, std::vector<Check>& checks);

/// The place of sample `i` on a lattice of `samples`.
std::string sampleText(glm::ivec2 samples, std::size_t i);

/// The reference's samples, for comparison with the device's `stages` of an image of `size` pixels. A ray may be where its sums jump: where
/// it meets a slice on the border between quads, whose interpolation is continued for half a slice. Positions of 32 bits are then on either
/// side of it, so a sample may be that of a ray beside it, a hundred thousandth of the image's width away.
std::vector<GatherSums> comparedSamples(const ReferenceGather& reference, const GatherStages& stages, double tolerance, glm::ivec2 size);

/// Adds a check for each of C, E and the sum of e z, named after the stage and the frame.
void checkSums(const std::vector<GatherSums>& sums, const std::vector<GatherSums>& reference, glm::ivec2 samples, double tolerance,
               const char* stage, const char* frame, std::vector<Check>& checks);

}  // namespace freevoxels
