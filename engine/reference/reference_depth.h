#pragma once
// Optical depth between blocks and the eye, exclusive of the block, and its gradient across the lines of
// sight, in double precision: from the attenuation table (Subr et al. 2007, Section 3.3), or along the rays
// of a source.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/level_data.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/source_rays.h"
#include "engine/scene/table_settings.h"
#include "engine/volume/volume.h"

namespace freevoxels {

class ReferenceDepth {
 public:
  virtual ~ReferenceDepth() = default;

  /// The mean depth of the block's voxels.
  virtual double at(const Block& block) const = 0;
  /// The fraction of the transmittance whose stored depths change from layer to layer, because they are not
  /// at the end of their code.
  virtual double unsaturated(const Block&) const { return 1.0; }
  /// The change per voxel along an axis of the lattice layer, which is not the axis of the largest component
  /// of the line of sight.
  virtual double slope(const Block& block, int axis) const = 0;
  /// The world length of a layer of voxels in the stored depths, if it is `layerLength` in the line of sight.
  virtual double countedLength(double layerLength) const { return layerLength; }

  /// The gradient per voxel in index space: the slopes, and along the line of sight a decrease by
  /// `layerDepth`, the optical depth of one lattice layer. `toEye` may have any length.
  glm::dvec3 gradient(const Block& block, glm::dvec3 toEye, double layerDepth) const;
};

/// Extinction per world unit, 0 outside of the volume. `extinction` has a value for each voxel; `coarser` has
/// the levels above.
double extinctionOf(const Block& block, const Volume& volume, std::span<const double> extinction,
                    std::span<const LevelData> coarser);

/// Emission per world unit, 0 outside. `emission` has a value for each voxel, or is empty.
glm::dvec3 emissionOf(const Block& block, const Volume& volume, std::span<const glm::dvec3> emission,
                      std::span<const LevelData> coarser);

/// The direction from a position in index space towards the eye, of any length.
using ToEye = std::function<glm::dvec3(glm::dvec3 position)>;

/// -log of the mean of the four transmittances around the line of sight, or the nearest one's. With
/// path-length correction a stored depth is scaled by the world length of a lattice layer in the viewing
/// direction over that in the stored one. Slopes are differences between neighbours, one-sided where one of
/// them holds nothing. `table` holds bytes [direction][voxel], `coarser` the levels above the voxels; keeps
/// references.
///
/// With an eye inside the volume (index space), what a stored depth has beyond the eye is taken off: what a
/// voxel there would have, and half of its own layer.
std::unique_ptr<ReferenceDepth> tableDepth(const Volume& volume, std::span<const double> extinction,
                                           const std::vector<std::vector<std::uint8_t>>& table,
                                           std::span<const LevelData> coarser, const TableSettings& settings,
                                           AttenuationLookup lookup, ToEye toEye,
                                           std::optional<glm::dvec3> eyeInside,
                                           std::span<const glm::dvec3> emission = {});

/// Depths along the rays of a source (source_rays.h), interpolated with their slopes by Catmull-Rom splines.
/// A block whose centre lies between two planes has the mean of its line of sight's depths on both. Keeps a
/// reference to the volume.
std::unique_ptr<ReferenceDepth> rayDepth(const Volume& volume, const RaySource& source, RayCodes codes);

}  // namespace freevoxels
