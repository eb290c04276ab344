#pragma once
// A table without the codes of what cannot be seen from any of its directions.

#include <cstdint>
#include <vector>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/stages.h"

namespace freevoxels {

/// Of a table that has its levels, keeps the codes of runs of kRunBlocks blocks (in the order of their ranks,
/// then of their bounds) of which any code says that light comes through. All others are the maxCodePerDirection code, as
/// they were: what look-ups find does not change by a bit. Leaves the table alone where less than a quarter
/// would go, or where the device lacks the memory of one more direction. Waits.
void pruneOpaqueRuns(const Device& device, AttenuationTable& table, std::vector<StageTime>& times);

/// By run, where the kept codes are: the first byte in a plane. Empty: everything is where it was.
using SeenRuns = std::vector<std::uint64_t>;
SeenRuns downloadSeenRuns(const Device& device, const AttenuationTable& table);

/// Of a plane, the codes of `count` blocks from that of rank `first` on. Waits.
std::vector<std::uint8_t> downloadCodes(const Device& device, const Buffer& plane, const SeenRuns& runs,
                                        std::uint64_t first, std::uint64_t count);

}  // namespace freevoxels
