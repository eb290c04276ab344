#pragma once
// OpenVDB files in and out (OpenVDB 10 of Debian 12 and newer).

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct GridInfo {
  std::string name;       ///< unique within the file: "density", or "density[1]" where the name is shared
  std::string valueType;  ///< "float", "half", "vec3s", "point data", ...
  std::string gridClass;  ///< "fog volume", "level set", "staggered", "unknown"
  std::uint64_t activeVoxels = 0;                 ///< active tiles counted as voxels
  glm::i64vec3 dimensions{0};                     ///< of the active bounding box; 0 where the grid is empty
  glm::ivec3 boundsMinimum{0}, boundsMaximum{0};  ///< inclusive, index space
  glm::dvec3 voxelSize{0.0};                      ///< world units along the three index axes
  bool hasRange = false;                          ///< the grid holds one real number a voxel
  double minimum = 0.0, maximum = 0.0;            ///< of the finite active values
  std::uint64_t memoryBytes = 0;
  glm::ivec3 renderDimensions{0};  ///< of the box that readVdb makes of it; 0 where it cannot be rendered
  /// Blocks of each level of that box's octree in which a voxel's density is above 0; empty where it cannot
  /// be rendered, or is too large to count.
  std::vector<std::uint64_t> storedBlocks;
  std::uint64_t hostBytes = 0;  ///< of the volume that readVdb makes of it; 0 where it cannot be rendered
  std::string unusable;         ///< empty, or why it cannot be rendered, in one clause
  bool isTemperature = false;   ///< --emission takes it where no other is named
  bool isAlbedo = false;        ///< --albedo-grid takes it
};

/// Every grid of the file in file order. Fails with ExitCode::Input on a missing, truncated or foreign file.
std::vector<GridInfo> describeVdb(const std::filesystem::path& file);

/// What of a grid is known without its voxels.
struct GridChoice {
  std::string name;                                              ///< as GridInfo::name
  bool isDensity = false;                                        ///< readVdb may take it
  bool isReal = false, isTemperature = false, isAlbedo = false;  ///< the latter as in GridInfo
};

/// In file order. Reads the file's table of contents and each grid's metadata; a file that was streamed out
/// as a whole. Fails as describeVdb does.
std::vector<GridChoice> listVdb(const std::filesystem::path& file);

/// Grids of the same file and on the same lattice of voxels to read as well.
struct MoreGrids {
  std::optional<std::string> temperature;  ///< a float grid; empty: `temperature`, `heat` or `flame`
  std::optional<std::string> albedo;       ///< a vec3s, vec3h or vec3d grid
};

/// A volume that can be read, but in which nothing is to be drawn, as in frames of a simulation before its source begins.
class EmptyVolumeError : public Error {
 public:
  using Error::Error;
};

/// Reads one float or half grid as a dense box around its active voxels (active tiles counted as voxels).
/// `gridName`: "NAME" or "NAME[k]"; empty means `density`, else the only float grid, else an error that lists
/// the choice. A level set becomes fog: density 1 inside, 0 outside, linear over the one voxel at the
/// surface. With temperatures the box is around their active voxels too. Fails with ExitCode::Input:
/// `more` that is not there or has another transform, frustum transforms, other grid types, empty grids (EmptyVolumeError),
/// unreadable files; and with ExitCode::OutOfMemory where the box exceeds `maximumVoxels`, before anything of
/// that size is allocated.
Volume readVdb(const std::filesystem::path& file, const std::string& gridName, std::uint64_t maximumVoxels,
               const MoreGrids& more = {});

/// Writes the active voxels as one float fog-volume grid, and temperatures as another. Atomic
/// (core/atomic_file.h).
void writeVdb(const std::filesystem::path& file, const Volume& volume, const std::string& gridName);

}  // namespace freevoxels
