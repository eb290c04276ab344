#pragma once
// The options of the drawing method, in which the paper and FreeVoxels differ. `--paper` selects the paper's
// side of eight options; those that are given win.

#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

/// The words of the options, in the order of the enumerators; those of --directions in the order of
/// DirectionSet's values, from 1.
inline const std::vector<std::string> kDrawWords{"auto", "gather", "splats"};
inline const std::vector<std::string> kCompositeWords{"normalised", "additive", "sorted"};
inline const std::vector<std::string> kAttenuationWords{"bilinear", "nearest", "exact", "auto"};
inline const std::vector<std::string> kDirectionWords{"26", "98"};
inline const std::vector<std::string> kCodeWords{"depth8", "linear8"};
inline const std::vector<std::string> kHierarchyFilterWords{"geometric", "arithmetic"};

/// A text that differs between tables that are made differently.
std::string tableText(const TableSettings& table);

struct MethodOptions {
  bool paper = false;
  std::optional<int> draw, composite, attenuation, directions, code, hierarchyFilter;
  std::optional<bool> pathLengthCorrection, gradient, culling;
  std::optional<double> lod, cullThreshold;

  void add(CLI::App& app);
  TableSettings table() const;
  void apply(FrameSettings& frame) const;
  void describe(OptionList& options) const;
};

}  // namespace freevoxels
