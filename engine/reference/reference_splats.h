#pragma once
// The image as a plain sum over voxels, on the CPU in double precision: Subr et al. 2007, Section 4.1, Eq.
// 10, and the normalised resolve. Projects and adds every voxel on its own; shares no code with the shaders.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/level_data.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/scattered_field.h"
#include "engine/scene/table_settings.h"
#include "engine/splatting/splat_sums.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The results of the stages that do not depend on the camera.
struct SplatInputs {
  std::span<const double> extinction;                   ///< for every voxel; of the classification only the colours are used
  const std::vector<std::vector<std::uint8_t>>& table;  ///< bytes [direction][voxel]
  TableSettings tableSettings;
  std::span<const LevelData> coarser = {};    ///< levels above the voxels, up to the coarsest that is drawn
  std::span<const glm::dvec3> emission = {};  ///< for every voxel; empty if none emits light
  const ScatteredField* scattered = nullptr;  ///< null without such light
};

/// Sums over the listed voxels (indices, Volume::at), in that order.
std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          const SplatInputs& inputs, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels);

/// Sums over blocks of the octree.
std::vector<SplatSums> referenceBlockSums(const Volume& volume, const Classification& classification,
                                          const SplatInputs& inputs, const Camera& camera,
                                          const FrameSettings& settings, std::span<const Block> blocks);

/// Ascending indices of the voxels with extinction above 0 or emission. `emission` may be empty.
std::vector<std::uint32_t> referenceVisibleVoxels(const std::vector<double>& extinction,
                                                  std::span<const glm::dvec3> emission = {});

Image referenceResolve(const std::vector<SplatSums>& sums, const FrameSettings& settings);

}  // namespace freevoxels
