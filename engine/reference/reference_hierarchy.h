#pragma once
// The octree computed directly on the CPU in double precision: Subr et al. 2007, Section 3.2, Eq. 7.

#include <span>
#include <vector>

#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/level_data.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/table_settings.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Level 0: the voxels, with colours unless all have the albedo. `table` may be empty; `emission` is empty if
/// no voxel emits light.
LevelData referenceVoxelLevel(const Volume& volume, const Classification& classification,
                              std::vector<double> extinction, std::vector<std::vector<std::uint8_t>> table,
                              std::vector<glm::dvec3> emission = {});

/// Level `level` from the one below it. Extinction and emission are means over the block's voxels. Colour is
/// the mean of the children's, weighted by their voxels and by their opacity along an edge. Attenuation is
/// the mean that `settings.filter` names; a transmittance stored as 0 counts as half the smallest code.
LevelData referenceParents(const LevelData& children, int level, const Volume& volume,
                           const TableSettings& settings);

/// All levels above the voxels, each from the one below.
std::vector<LevelData> referenceLevels(const LevelData& voxels, const Volume& volume,
                                       const TableSettings& settings);

/// The occupied blocks that the rule of engine/visibility/detail_rule.h draws. `extinction` and `emission`
/// are those of the voxels.
std::vector<Block> referenceCut(const Volume& volume, std::span<const double> extinction,
                                const Camera& camera, const FrameSettings& settings,
                                std::span<const glm::dvec3> emission = {});

}  // namespace freevoxels
