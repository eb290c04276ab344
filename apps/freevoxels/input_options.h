#pragma once
// Where the volume comes from: an OpenVDB file, a baked volume (.fvx), or `procedural:NAME`.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "apps/freevoxels/option_values.h"
#include "engine/storage/fvx_file.h"
#include "engine/volume/vdb.h"
#include "engine/volume/volume.h"

namespace freevoxels {

inline constexpr int kDefaultResolution = 128, kMostResolution = 2048;

std::uint64_t machineMemoryBytes();

/// `--resolution` of a procedural volume.
CLI::Option* addResolution(CLI::App& app, std::optional<glm::ivec3>& target);
/// "128", or "2048x2048x512" of one that is no cube.
std::string resolutionText(glm::ivec3 dimensions);

/// NAME of "procedural:NAME", or nothing for a file.
std::optional<std::string> proceduralName(const std::string& input);

/// makeProcedural, but refused with ExitCode::OutOfMemory before anything is allocated where the volume
/// exceeds `maximumVoxels` or this machine's memory.
Volume openProcedural(const std::string& name, std::optional<glm::ivec3> resolution, std::uint64_t maximumVoxels);

struct InputOptions {
  std::string input;
  std::optional<std::string> grid;
  std::optional<glm::ivec3> resolution;

  /// IN and --resolution.
  void add(CLI::App& app);
  /// --grid, where one is wanted.
  void addGrid(CLI::App& app);
  /// ExitCode::Usage without IN.
  void checkGiven() const;
  /// Refuses an option that does not apply to this input: ExitCode::Usage.
  void check() const;
  /// A procedural volume has its temperatures where any are asked for, a baked one always, and its own albedos. Of a baked volume whose
  /// box is too large at `level` the finest level that fits is opened, with a warning.
  Volume open(std::uint64_t maximumVoxels, const MoreGrids& more = {}, int level = 0) const;
  /// Null where the input is no baked volume.
  std::shared_ptr<const fvx::FvxFile> baked() const;
  void describe(OptionList& options) const;
};

/// One warning each for NaN and, where the scalars are densities, for negative values.
void warnAboutValues(const Volume& volume, bool scalarsAreDensities);

}  // namespace freevoxels
