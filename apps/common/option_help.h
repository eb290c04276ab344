#pragma once
// The --help texts of the options that are fields of a scene.

#include <string>
#include <string_view>
#include <vector>

namespace freevoxels {

struct OptionHelp {
  std::string_view field;  ///< SceneField::name
  std::string text;
  bool ofMethod = false;  ///< whether only commands that draw by the drawing method have the option, which the oracle does not
};

/// In the order of --help. Commands that have `frames` describe it themselves.
const std::vector<OptionHelp>& optionHelp();

}  // namespace freevoxels
