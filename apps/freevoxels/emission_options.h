#pragma once
// The options of emission by temperature.

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
  /// Fails with ErrorKind::Usage for options that do not apply.
  void check(const InputOptions& input) const;
  /// The name of the grid to read; nothing without emission.
  std::optional<std::string> grid() const;
  /// Options that are not given have automatic values. `classification` is that without emission.
  std::optional<Emission> resolve(const Volume& volume, const Classification& classification) const;
  /// Takes the place of what is not given: what was resolved for another volume.
  void take(const Emission& resolved);
  void describe(OptionList& options, const Volume& volume, const std::optional<Emission>& resolved) const;
  /// Warns of temperatures that are not drawn as they are, and if nothing emits light.
  static void warn(const Volume& volume, const Classification& classification);
};

}  // namespace freevoxels
