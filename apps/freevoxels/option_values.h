#pragma once
// Option values that are checked when they are parsed: a bad one fails with ErrorKind::Usage and one sentence
// that names the option. NaN and infinities are always bad. Lists are one word: "1,2,3". If an option is
// given twice, the last one counts.

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

/// A range that includes both ends.
struct NumberRange {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

/// `form` is how the help shows the value: "DEG", "X,Y,Z".
CLI::Option* addNumber(CLI::App& app, const std::string& name, const std::string& form,
                       std::optional<double>& target, const std::string& description, NumberRange range = {});
/// Adds an option whose number may be left out; `given` says that the option is present.
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
/// The linear Rec.709 colour of "#rrggbb" in sRGB or of a basic CSS name such as "white"; all options of the
/// form R,G,B accept these.
std::optional<glm::dvec3> namedColor(const std::string& text);

/// "WxH" in pixels, or one number for a square.
CLI::Option* addSize(CLI::App& app, const std::string& name, glm::ivec2& target, int maximum,
                     const std::string& description);
/// "WxHxD" voxels, or one number for a cube.
CLI::Option* addDimensions(CLI::App& app, const std::string& name, std::optional<glm::ivec3>& target, int maximum,
                           const std::string& description);
CLI::Option* addText(CLI::App& app, const std::string& name, const std::string& form,
                     std::optional<std::string>& target, const std::string& description);

/// Reads `count` numbers. Messages call the text `name`.
std::vector<double> readNumbers(const std::string& name, const std::string& form, std::size_t count,
                                const std::string& text, NumberRange range = {});

/// "a=1,2,b=3" as {a: "1,2", b: "3"}; `name` and `form` as for readNumbers.
std::map<std::string, std::string> readKeys(const std::string& name, const std::string& form,
                                            const std::string& text);

/// Whether the text of an option that names a JSON file is JSON itself.
bool isInlineJson(const std::string& text);

/// Adds an option with one of several words; `target` becomes the index of the word.
CLI::Option* addWord(CLI::App& app, const std::string& name, const std::vector<std::string>& words,
                     std::optional<int>& target, const std::string& description);

/// Resolved options as "--name" and value, for messages, metadata and timings. An empty name is a positional,
/// an empty value a flag.
using OptionList = std::vector<std::pair<std::string, std::string>>;

/// The shortest text that parses as the same number.
std::string numberText(double value);
std::string numberText(glm::dvec3 value);

/// The options by name without dashes; the positional is "input", a flag is "yes"; values of a repeated
/// option are joined by spaces.
std::map<std::string, std::string> optionMap(const OptionList& options);

/// The options as shell words, quoted where necessary.
std::string commandText(const OptionList& options);

}  // namespace freevoxels
