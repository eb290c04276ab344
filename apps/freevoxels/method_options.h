#pragma once
// How the picture is computed, where the paper and FreeVoxels differ. `--paper` takes the paper's side in all
// eight, but an option that is given explicitly wins over it.

#include <optional>

#include "apps/freevoxels/option_values.h"
#include "engine/splatting/render_settings.h"

namespace freevoxels {

struct MethodOptions {
  bool paper = false;
  std::optional<int> composite, attenuation, directions, code, hierarchyFilter;
  std::optional<bool> pathLengthCorrection, gradient, culling;
  std::optional<double> lod, cullThreshold;

  void add(CLI::App& app);
  TableSettings table() const;
  void apply(FrameSettings& frame) const;
  void describe(OptionList& options) const;
};

}  // namespace freevoxels
