#pragma once
// The options of the input: an OpenVDB file, a baked volume (.fvx), or `procedural:NAME`.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "apps/freevoxels/option_values.h"
#include "engine/storage/fvx_file.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/vdb.h"
#include "engine/volume/volume.h"

namespace freevoxels {

inline constexpr int kDefaultResolution = 128, kMostResolution = 2048;

std::uint64_t machineMemoryBytes();

/// `--resolution` of a procedural volume.
CLI::Option* addResolution(CLI::App& app, std::optional<glm::ivec3>& target);
/// "128", or "2048x2048x512" of one that is no cube.
std::string resolutionText(glm::ivec3 dimensions);

/// NAME of "procedural:NAME"; nothing for a file.
std::optional<std::string> proceduralName(const std::string& input);

/// Calls makeProcedural, but fails with ErrorKind::OutOfMemory before allocating if the volume exceeds
/// `maximumVoxels` or this machine's memory.
Volume openProcedural(const std::string& name, std::optional<glm::ivec3> resolution, std::uint64_t maximumVoxels);

struct InputOptions {
  std::string input;
  std::optional<std::string> grid;
  std::optional<glm::ivec3> resolution;
  std::optional<VoxelBox> clipBox;  ///< of the volume's box; the voxels outside are not drawn
  std::optional<ClipPlane> clipPlane;  ///< voxels in front of it are not drawn

  /// IN and --resolution.
  void add(CLI::App& app);
  /// Adds --grid.
  void addGrid(CLI::App& app);
  /// Adds --clip-box and --clip-plane.
  void addClip(CLI::App& app);
  /// Fails with ErrorKind::Usage without IN.
  void checkGiven() const;
  /// Fails with ErrorKind::Usage for options that do not apply to this input.
  void check() const;
  /// The part of a volume in the clip box and behind the clip plane. Fails with ErrorKind::Usage if there is none.
  Volume clip(Volume volume) const;
  /// A procedural volume has its temperatures if any are requested; a baked one always has its temperatures
  /// and albedos. If the box of a baked volume is too large at `level`, the finest level that fits is opened,
  /// with a warning.
  Volume open(std::uint64_t maximumVoxels, const MoreGrids& more = {}, int level = 0) const;
  /// Null where the input is no baked volume.
  std::shared_ptr<const fvx::FvxFile> baked() const;
  void describe(OptionList& options) const;
};

/// What the user should know of a volume: its own warnings, NaN values, and negative values if the scalars are densities.
/// Parameters are marked (engine/core/parameter.h).
std::vector<std::string> warningsOf(const Volume& volume, bool scalarsAreDensities);
/// Logs them.
void logWarnings(const Volume& volume, bool scalarsAreDensities);

}  // namespace freevoxels
