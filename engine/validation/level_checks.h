#pragma once
// Checks of the octree and its cuts (Subr et al. 2007, Section 3.2) against the double-precision version on
// the CPU.

#include <span>
#include <vector>

#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/level_data.h"
#include "engine/scene/table_settings.h"
#include "engine/validation/report.h"
#include "engine/validation/validation_scene.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Checks every level, given the one below it (`voxels` for the first): extinction and colours, conservation
/// of the optical depth, the table.
std::vector<Check> compareLevels(const Volume& volume, const LevelData& voxels,
                                 std::span<const LevelData> levels, const TableSettings& settings,
                                 const char* name);

/// The occupied voxels that are not in exactly one of the blocks.
std::size_t coverageErrors(const Volume& volume, std::span<const double> extinction,
                           std::span<const Block> blocks, std::span<const glm::dvec3> emission = {});

/// Checks levels, coverage by the cuts of random cameras, and the sums of a cut of several levels.
ReportSection levelChecks(const Device& device, const ValidationScene& scene, glm::ivec2 size);

}  // namespace freevoxels
