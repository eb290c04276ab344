#pragma once
// Reading and writing OpenVDB files (OpenVDB 10 of Debian 12 and newer).

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/stages.h"
#include "engine/volume/channels.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/labels.h"
#include "engine/volume/procedural.h"
#include "engine/volume/scan.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct GridInfo {
  std::string name;       ///< unique within the file: "density", or "density[1]" if several grids have the name
  std::string valueType;  ///< "float", "half", "int32", "bool", "mask", "vec3s", "point data", ...
  std::string gridClass;  ///< "fog volume", "level set", "staggered", "unknown"
  std::uint64_t activeVoxels = 0;                 ///< active tiles counted as voxels
  glm::i64vec3 dimensions{0};                     ///< of the active bounding box; 0 if the grid is empty
  glm::ivec3 boundsMinimum{0}, boundsMaximum{0};  ///< inclusive, index space
  glm::dvec3 voxelSize{0.0};                      ///< world units along the three index axes
  bool hasRange = false;                          ///< whether the grid has one real number a voxel
  double minimum = 0.0, maximum = 0.0;            ///< of the finite active values
  std::uint64_t memoryBytes = 0;
  glm::ivec3 renderDimensions{0};  ///< of the box that readVdb would return; 0 if the grid cannot be drawn
  /// Number of blocks of each level of that box's octree that contain a density above 0. Empty if the grid
  /// cannot be drawn or is too large to count.
  std::vector<std::uint64_t> storedBlocks;
  std::uint64_t hostBytes = 0;  ///< host memory of the volume that readVdb would return; 0 if the grid cannot be drawn
  std::string unusable;         ///< why the grid cannot be drawn, in one clause; empty if it can
  bool areLabels = false;       ///< whether it is drawn as labels, if nothing says otherwise
  bool isTemperature = false;   ///< whether emission uses it if no grid of temperatures is named
  bool isAlbedo = false;        ///< whether it can be the grid of albedos
};

/// Describes every grid of the file, in file order. Fails with ErrorKind::Input if the file is missing,
/// truncated or not an OpenVDB file.
std::vector<GridInfo> describeVdb(const std::filesystem::path& file);

/// Whether a grid of the file has the name, as `NAME` or `NAME[k]`. Fails as describeVdb does.
bool hasGrid(const std::filesystem::path& file, const std::string& name);

/// What is known of a grid without reading its voxels.
struct GridChoice {
  std::string name;                                              ///< as GridInfo::name
  bool isDensity = false;                                        ///< whether readVdb accepts it
  bool isScalar = false, isTemperature = false, isAlbedo = false;  ///< the latter two as in GridInfo
};

/// Lists the grids in file order. Reads only the file's table of contents and each grid's metadata, or the
/// whole file if it was streamed out. Fails as describeVdb does.
std::vector<GridChoice> listVdb(const std::filesystem::path& file);

/// A grid to read beside the densities.
struct GridRequest {
  std::string name;         ///< empty: the first by the usual names (grid_names.h) that there is
  bool isRequired = false;  ///< whether it is an error if there is none

  bool operator==(const GridRequest&) const = default;
};

/// More grids to read, of the same file. On another lattice of voxels they are resampled to that of the densities.
struct MoreGrids {
  std::optional<GridRequest> temperature;  ///< a float grid
  std::optional<GridRequest> albedo;       ///< a vec3s, vec3h or vec3d grid
  /// Whether the file is a frame of a film, others of which have the grids: it is read without those that it lacks.
  bool mayBeMissing = false;
};

/// A volume that can be read, but in which nothing is to be drawn, as in frames of a simulation before its source begins.
class EmptyVolumeError : public Error {
 public:
  using Error::Error;
};

/// Which part of a grid is read, and how.
struct ReadRequest {
  std::string grid;  ///< "NAME" or "NAME[k]"; empty: the first by the usual names of densities, else the only float grid that can be one
  std::uint64_t maximumVoxels = 0;  ///< of the bricks that hold something
  MoreGrids more = {};
  std::optional<VoxelBox> clipBox = std::nullopt;  ///< read only this part where the whole has more than `maximumVoxels`
  std::optional<NoData> noData = std::nullopt;     ///< of which voxels hold no data; else the padding of a scan (scan.h) does
  LabelRequest labels = {};
  std::vector<ChannelStyle> channels = {};         ///< if there are any, these grids are drawn in place of `grid` and `more` (channels.h)
  int imageEdge = 0;                               ///< of a scan, as in ScanRequest
  Progress progress = {};                          ///< may abandon it
};

/// Reads one grid of numbers as a box around its active voxels (active tiles count as voxels, but for those of a fog volume that are 0);
/// with temperatures, around their active voxels too. A file of temperatures alone is a flame without density. Where no grid can be told
/// to be the density it is an error that lists the choice. A level set becomes a density of 1 inside and 0 outside, with a smooth
/// transition of four voxels across the surface; labels become solids (labels.h). Fails with ErrorKind::Input if a required grid of `more`
/// does not exist, and for frustum transforms, other grid types, empty grids (EmptyVolumeError) and unreadable files; with
/// ErrorKind::OutOfMemory if what is occupied exceeds `maximumVoxels`, before allocating it, or the box has an edge of more than 2^30
/// voxels. Around a box of more than 2^31 voxels, those of value 0 are left out.
Volume readVdb(const std::filesystem::path& file, const ReadRequest& request);
Volume readVdb(const std::filesystem::path& file, const std::string& gridName, std::uint64_t maximumVoxels, const MoreGrids& more = {},
               const Progress& progress = {});

/// Where the voxels of a file are, as far as its header says without reading them.
struct VdbExtent {
  std::vector<glm::dvec3> corners;  ///< of the boxes of the grids that readVdb reads, in the world; empty if nothing is active
  std::uint64_t voxels = 0;         ///< active ones, of all these grids
};
/// Nothing where the header does not say it. Chooses the grids and fails as readVdb does.
std::optional<VdbExtent> extentOfVdb(const std::filesystem::path& file, const std::string& gridName, const MoreGrids& more);

/// Writes the active voxels as a float grid, a fog volume if Volume::isFog, and temperatures as a second grid. Atomic
/// (core/atomic_file.h).
void writeVdb(const std::filesystem::path& file, const Volume& volume, const std::string& gridName);
/// Scalars that become a grid of a file.
struct NamedScalars {
  std::string name;
  const Volume* volume = nullptr;
};
/// The same of the scalars of several volumes.
void writeVdb(const std::filesystem::path& file, const std::vector<NamedScalars>& grids);
/// The same of a field, of which no volume is made: 160 bytes for every 8^3 voxels that hold something are in memory, and their values in
/// a temporary file without a name beside `file`. `progress` is told 1 before the file itself is written.
void writeVdb(const std::filesystem::path& file, const ProceduralField& field, const std::string& gridName, const Progress& progress = {});

}  // namespace freevoxels
