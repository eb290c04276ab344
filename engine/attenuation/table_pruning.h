#pragma once
// Pruning of the attenuation table: removes the codes of blocks from which no light leaves in any direction.

#include <cstdint>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/stages.h"

namespace freevoxels {

/// Removes from a table with levels all runs of kRunBlocks blocks (in the order of their ranks, then of their
/// bounds) of which every code is the maxCodePerDirection code. Look-ups return that code for removed runs,
/// so their results do not change by a bit. Does nothing if less than a quarter would be removed, or if the
/// device lacks memory for one more direction. Blocks until the device is done.
void pruneOpaqueRuns(const Device& device, AttenuationTable& table, std::vector<StageTime>& times);

/// For each run, the offset in a plane of its kept codes. Empty if the table is not pruned.
using SeenRuns = std::vector<std::uint64_t>;
SeenRuns downloadSeenRuns(const Device& device, const AttenuationTable& table);

/// The codes of a plane for `count` blocks, starting at rank `first`. Reads back.
std::vector<std::uint8_t> downloadCodes(const Device& device, const Buffer& plane, const SeenRuns& runs,
                                        std::uint64_t first, std::uint64_t count);

}  // namespace freevoxels
