#pragma once
// Light that voxels send out by their temperature.

#include <optional>
#include <string>

#include "apps/freevoxels/input_options.h"
#include "engine/volume/classification.h"

namespace freevoxels {

struct EmissionOptions {
  bool emission = false;  ///< --emission, with or without a strength
  std::optional<std::string> temperatureGrid;
  std::optional<double> strength, temperatureScale, temperatureOffset;

  void add(CLI::App& app);
  /// Refuses options that do not apply: ExitCode::Usage.
  void check(const InputOptions& input) const;
  /// Of the grid to read; nothing where no emission is asked for.
  std::optional<std::string> grid() const;
  /// What is not given defaults to the automatic values. `classification` is of what does not shine.
  std::optional<Emission> resolve(const Volume& volume, const Classification& classification) const;
  /// Takes the place of what is not given: what was resolved for another volume.
  void take(const Emission& resolved);
  void describe(OptionList& options, const Volume& volume, const std::optional<Emission>& resolved) const;
  /// One warning each for temperatures that are not drawn as they are, and where nothing sends out light.
  static void warn(const Volume& volume, const Classification& classification);
};

}  // namespace freevoxels
