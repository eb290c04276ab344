#pragma once
// A volume in host memory: a box of scalars and its place in the world.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/scalar_bricks.h"

namespace freevoxels {

struct Classification;
struct Subject;
struct ValueSummary;
struct Outliers;

/// Temperatures, or light, in addition to a volume's scalars.
struct TemperatureGrid {
  std::string name;
  bool isRadiance = false;             ///< whether values are light that is sent out in `colors`, and no temperatures
  ScalarBricks values;                 ///< like Volume::scalars, for the same box, in any unit
  std::array<ScalarBricks, 3> colors;  ///< of light: red, green and blue, linear Rec.709 in 0..1; else without voxels
  std::uint64_t activeVoxels = 0, nanVoxels = 0;
  float minimum = 0.0f, maximum = 0.0f;  ///< of the active voxels
  std::uint64_t outlierVoxels = 0;       ///< as of a Volume
  bool isBurning = true;                 ///< false where the file has a grid of flames that is empty
  float farthestOutlier = 0.0f;
};

/// Albedos in addition to a volume's scalars, linear Rec.709 in 0..1.
struct AlbedoGrid {
  std::string name;
  std::array<ScalarBricks, 3> values;  ///< red, green and blue, each like Volume::scalars, for the same box
  std::uint64_t clippedVoxels = 0;     ///< voxels that were clamped to 0..1; NaN becomes 0
};

/// What scalars, albedos and light were made of, where they are no grids of a file: labels (labels.h) or channels (channels.h).
enum class MadeOf { Grids, Labels, Channels };

struct Volume {
  std::string source;  ///< file and grid, for messages and metadata: "cloud.vdb density[1]"
  glm::ivec3 dimensions{0};
  glm::ivec3 indexOrigin{0};  ///< position of voxel (0,0,0) in the file's own index space
  /// Affine. Maps the voxel (i,j,k) of this box, 0 <= i < dimensions.x, to the world position of its centre.
  glm::dmat4 indexToWorld{1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< up direction in the world, as far as the file says
  std::string upReason;          ///< why it is not +y, as a clause: "Blender wrote the file"
  std::string lengthUnit;        ///< of the world: "mm"; empty where the file does not say it
  std::string valueUnit;         ///< of the scalars: "HU"; empty where the file does not say it
  bool isSolid = false;          ///< whether the scalars are densities of solids: 1 inside of a level set, or where labels are (labels.h)
  ScalarBricks scalars;  ///< finite values, or kInactiveVoxel

  std::uint64_t activeVoxels = 0;
  std::uint64_t nanVoxels = 0;           ///< voxels that were NaN or infinite, and hold no data here
  std::uint64_t missingVoxels = 0;       ///< voxels of the file that hold no data by their value: NaN, or that of no data (scan.h)
  std::uint64_t overflownVoxels = 0;     ///< voxels of half floats that were infinite, and have the largest half here
  std::uint64_t negativeVoxels = 0;      ///< active voxels below 0; a density there counts as 0 (classification.h)
  float minimum = 0.0f, maximum = 0.0f;  ///< of the active voxels
  /// Few voxels whose values were more than a thousand times as large as all others (value_range.h). They have the largest of the other
  /// values here, so that they do not rule what is chosen by the range. `farthestOutlier` is the largest of them in the file.
  std::uint64_t outlierVoxels = 0;
  float farthestOutlier = 0.0f;
  std::optional<float> padding;  ///< of a scan: the value that was taken for no data (scan.h)
  bool isPart = false;           ///< whether what is beyond the clip box has not been read
  /// Whether the file says that the scalars are densities: it calls the grid a fog volume, and density or a usual name of it.
  bool isFog = false;

  std::optional<TemperatureGrid> temperature;
  std::optional<AlbedoGrid> albedo;
  MadeOf madeOf = MadeOf::Grids;

  /// What the user should know of how the file was read: sentences, in which parameters may be marked (core/parameter.h).
  std::vector<std::string> warnings;
  /// What was assumed of the file where it leaves that open: clauses, in which parameters are marked.
  std::vector<std::string> remarks;

  /// How the volume's file says that it is classified; null where the file leaves that to the user, as OpenVDB's do.
  std::shared_ptr<const Classification> classification;
  /// The values are as exact as `classification` needs them, and not exact enough for another one.
  bool classificationIsFixed = false;
  /// What is seen with `classification`, as the volume's file says, so that every level of detail is framed alike (subject.h); null
  /// where the voxels of this volume are to be asked.
  std::shared_ptr<const Subject> content;

  /// Voxels of the box; the largest number there is if it has more.
  std::size_t voxelCount() const {
    const double count = double(dimensions.x) * double(dimensions.y) * double(dimensions.z);
    if (count >= 0x1p63) return std::numeric_limits<std::size_t>::max();
    return std::size_t(dimensions.x) * std::size_t(dimensions.y) * std::size_t(dimensions.z);
  }
  float scalar(int x, int y, int z) const { return scalars.at({x, y, z}); }
  /// Index of a voxel among all voxels, x fastest.
  std::size_t at(int x, int y, int z) const {
    return std::size_t(x) +
           std::size_t(dimensions.x) * (std::size_t(y) + std::size_t(dimensions.y) * std::size_t(z));
  }
  /// Edge in world units of the cube with the volume of a voxel: the paper's Δ.
  double voxelSize() const;
};

/// Calls `apply` with each grid of a volume: scalars, temperatures or light, its colours, and albedos; and with the same grids of other
/// volumes that have them.
template <typename Apply, typename First, typename... Others>
void forEachGrid(const Apply& apply, First& first, Others&... others) {
  apply(first.scalars, others.scalars...);
  if (first.temperature) apply(first.temperature->values, others.temperature->values...);
  for (std::size_t c = 0; c < 3; ++c) {
    if (first.temperature && first.temperature->isRadiance) apply(first.temperature->colors[c], others.temperature->colors[c]...);
    if (first.albedo) apply(first.albedo->values[c], others.albedo->values[c]...);
  }
}

/// The scalars of all voxels, x fastest: for references and tests that look at every voxel.
std::vector<float> denseScalars(const Volume& volume);

/// Moves a volume near to the origin, and scales it, where its coordinates would leave double precision too few digits to tell its voxels
/// apart, or single precision's range when they are squared; warns of it, as cameras and densities then count in other units.
void normaliseWorld(Volume& volume);

/// Takes NaN, infinities and the value of no data for no data, limits outliers, and fills the counts of voxels, minimum and maximum. Voxels
/// that were taken for no data before are still counted.
void summariseValues(Volume& volume, std::optional<float> noData = {});
/// The same of a part of a volume, whose outliers are known.
void summariseValues(Volume& volume, const Outliers& outliers);
/// Fills the same fields for a volume whose values are not in memory.
void takeSummary(Volume& volume, const ValueSummary& summary, const Outliers& outliers);
/// Fills the same fields as another volume has them.
void takeCounts(Volume& volume, const Volume& other);
/// Does the same for temperatures.
void summariseValues(TemperatureGrid& grid);

/// Makes empty bricks of scalars wherever `grid` has bricks, so that voxels with emission alone are drawn
/// too.
void coverBricks(Volume& volume, const ScalarBricks& grid);

/// The box, place, counts and ranges of a volume, without its values and without what its file says of how it is drawn.
Volume outlineOf(const Volume& volume);

/// Removes the planes at the box's six sides that have no active voxel of scalars or temperatures. Every
/// voxel keeps its place in the world. A volume without active voxels stays as it is.
void cropToActive(Volume& volume);

}  // namespace freevoxels
