#pragma once
// One value of a scene file, as JSON and as the text of its option on the command line.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace CLI {
class Option;
}  // namespace CLI

namespace freevoxels {

/// The option as a person gives it: "--fov", or "IN".
std::string optionName(const CLI::Option& option);

/// Whether the option may be given several times, and is a list in a scene.
bool isRepeated(const CLI::Option& option);

/// What the option is called in a scene: its name without dashes, "lights" for --light of which there may be
/// several, "volume" for IN.
std::string sceneKey(const CLI::Option& option);

/// The object of the scene that it is in: its group in the help, in small letters. Empty where the option is
/// not of a picture.
std::string sceneSection(const CLI::Option& option);

/// What the command line would say; several words for an option that may be repeated. File names are relative
/// to `folder`. `name` is what the sentence calls the value that refuses it: ExitCode::Input.
std::vector<std::string> optionTexts(const CLI::Option& option, const nlohmann::json& value,
                                     const std::filesystem::path& folder, const std::string& name);

/// The other way round, of one word; "" is a flag.
nlohmann::json sceneValue(const CLI::Option& option, const std::string& text,
                          const std::filesystem::path& folder);

}  // namespace freevoxels
