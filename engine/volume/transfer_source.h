#pragma once
// What --transfer-function names: a file, one of several functions in a file, a preset, or JSON.

#include <span>
#include <string>
#include <string_view>

#include "engine/volume/transfer_curves.h"

namespace freevoxels {

/// A function that FreeVoxels has by name: a file of apps/transfer_functions as it was when this was built.
struct TransferPreset {
  std::string_view name;  ///< "ct-bone"
  std::string_view json;
};

/// All presets, in the order in which they are listed.
std::span<const TransferPreset> transferPresets();
/// The preset of this name, in which case does not matter, nor whether words are joined by -, _ or a space; null if there is none.
const TransferPreset* presetNamed(std::string_view name);
/// All presets as JSON: an object of their functions by their names.
std::string presetsJson();
/// The curves of a preset.
TransferCurves curvesOf(const TransferPreset& preset);

/// Reads what a text names: JSON if it begins with {; else a file, if there is one; else a function in a file of several, as FILE:NAME; else
/// a preset. Fails with ErrorKind::Input.
TransferCurves readTransferCurves(const std::string& text);

/// The file that a text names, which there is; empty for JSON and presets.
std::string transferFile(const std::string& text);

/// The same name, in which a relative file name becomes relative to `folder`. A preset is one if there is no such file.
std::string transferNameIn(const std::string& folder, const std::string& text);

/// Sentences about what of a text's function is not drawn. Fails as readTransferCurves().
std::vector<std::string> transferWarnings(const std::string& text);

}  // namespace freevoxels
