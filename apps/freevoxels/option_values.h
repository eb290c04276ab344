#pragma once
// Option values that are checked where they are read: a bad one is refused (ExitCode::Usage) in one sentence
// that names the option. NaN and infinities are bad everywhere. Lists are one word: "1,2,3". Of an option
// that is given twice the last counts.

#include <fmt/format.h>

#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace freevoxels {

/// Both ends are allowed.
struct NumberRange {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

/// `form` is how the help shows the value: "DEG", "X,Y,Z".
CLI::Option* addNumber(CLI::App& app, const std::string& name, const std::string& form,
                       std::optional<double>& target, const std::string& description, NumberRange range = {});
/// The number may be left out; `given` says that the option is there.
CLI::Option* addOptionalNumber(CLI::App& app, const std::string& name, const std::string& form, bool& given,
                               std::optional<double>& target, const std::string& description,
                               NumberRange range = {});
CLI::Option* addPair(CLI::App& app, const std::string& name, const std::string& form,
                     std::optional<glm::dvec2>& target, const std::string& description,
                     NumberRange range = {});
CLI::Option* addTriple(CLI::App& app, const std::string& name, const std::string& form,
                       std::optional<glm::dvec3>& target, const std::string& description,
                       NumberRange range = {});
CLI::Option* addWholeNumber(CLI::App& app, const std::string& name, const std::string& form,
                            std::optional<int>& target, const std::string& description, NumberRange range);
/// Linear Rec.709 of "#rrggbb" in sRGB or of one of CSS's basic names, "white"; every option of the form R,G,B takes them.
std::optional<glm::dvec3> namedColor(const std::string& text);

/// "WxH" in pixels, or one number for a square.
CLI::Option* addSize(CLI::App& app, const std::string& name, glm::ivec2& target, int maximum,
                     const std::string& description);
/// "WxHxD" voxels, or one number for a cube.
CLI::Option* addDimensions(CLI::App& app, const std::string& name, std::optional<glm::ivec3>& target, int maximum,
                           const std::string& description);
CLI::Option* addText(CLI::App& app, const std::string& name, const std::string& form,
                     std::optional<std::string>& target, const std::string& description);

/// As many numbers as `count`; `name` is what the sentence calls that refuses the text.
std::vector<double> readNumbers(const std::string& name, const std::string& form, std::size_t count,
                                const std::string& text, NumberRange range = {});

/// "a=1,2,b=3" as {a: "1,2", b: "3"}; `name` and `form` as for readNumbers.
std::map<std::string, std::string> readKeys(const std::string& name, const std::string& form,
                                            const std::string& text);

/// Whether the text of an option that names a JSON file is the JSON itself.
bool isInlineJson(const std::string& text);

/// One of a few words; `target` becomes the position of the one that was given.
CLI::Option* addWord(CLI::App& app, const std::string& name, const std::vector<std::string>& words,
                     std::optional<int>& target, const std::string& description);

/// Resolved options as "--name" and value, for people, metadata and timings; an empty name is a positional,
/// an empty value a flag.
using OptionList = std::vector<std::pair<std::string, std::string>>;

/// Shortest text that reads back as the same number.
std::string numberText(double value);
std::string numberText(glm::dvec3 value);

/// The options by name without its dashes, the positional as "input", a flag as "yes"; values of an option
/// that is there several times joined by spaces.
std::map<std::string, std::string> optionMap(const OptionList& options);

/// The options as words for a shell, quoted where that is needed.
std::string commandText(const OptionList& options);

}  // namespace freevoxels
