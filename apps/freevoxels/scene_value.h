#pragma once
// A value of a scene file, as JSON and as the text of its option on the command line.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace CLI {
class Option;
}  // namespace CLI

namespace freevoxels {

/// The option as on the command line: "--fov", or "IN".
std::string optionName(const CLI::Option& option);

/// Whether the option may be repeated, and is a list in a scene.
bool isRepeated(const CLI::Option& option);

/// The option's key in a scene: its name without dashes; "lights" for --light, which may be repeated;
/// "volume" for IN.
std::string sceneKey(const CLI::Option& option);

/// The section of the scene for an option: its group in --help, in lower case. Empty if the option does not
/// affect images.
std::string sceneSection(const CLI::Option& option);

/// The words of the command line for a value; several for an option that may be repeated. File names are
/// relative to `folder`. Fails with ErrorKind::Input and a sentence that calls the value `name`.
std::vector<std::string> optionTexts(const CLI::Option& option, const nlohmann::json& value,
                                     const std::filesystem::path& folder, const std::string& name);

/// Converts one word of the command line to JSON; "" is a flag.
nlohmann::json sceneValue(const CLI::Option& option, const std::string& text,
                          const std::filesystem::path& folder);

}  // namespace freevoxels
