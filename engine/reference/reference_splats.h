#pragma once
// The picture as the plain sum over voxels, on the CPU in double precision: Subr et al. 2007, Section 4.1,
// Eq. 10 and the normalised resolve. Projects and adds every voxel by itself; shares no code with the
// shaders.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/level_data.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/source_rays.h"
#include "engine/scene/table_settings.h"
#include "engine/splatting/splat_sums.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// What the stages before the camera made.
struct SplatInputs {
  std::span<const double> extinction;                   ///< of every voxel: the classification only colours
  const std::vector<std::vector<std::uint8_t>>& table;  ///< bytes [direction][voxel]
  TableSettings tableSettings;
  std::span<const LevelData> coarser = {};    ///< levels above the voxels, as far as blocks of them are drawn
  std::span<const glm::dvec3> emission = {};  ///< of every voxel; empty where none sends out light
  const RayCodes* rays = nullptr;  ///< of the camera's eye, where they are looked up: none, made here
};

/// Sums over the voxels listed (indices into Volume::values), in that order.
std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          const SplatInputs& inputs, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels);

/// The same of blocks of the octree.
std::vector<SplatSums> referenceBlockSums(const Volume& volume, const Classification& classification,
                                          const SplatInputs& inputs, const Camera& camera,
                                          const FrameSettings& settings, std::span<const Block> blocks);

/// Indices of the voxels with extinction above 0 or light, ascending; `emission` may be empty.
std::vector<std::uint32_t> referenceVisibleVoxels(const std::vector<double>& extinction,
                                                  std::span<const glm::dvec3> emission = {});

Image referenceResolve(const std::vector<SplatSums>& sums, const FrameSettings& settings);

}  // namespace freevoxels
