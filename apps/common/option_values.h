#pragma once
// Option values that are checked when they are parsed: a bad one fails with ErrorKind::Usage and one sentence
// that names the option. NaN and infinities are always bad. Lists are one word: "1,2,3". If an option is
// given twice, the last one counts.

#include <fmt/format.h>

#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/description/text_values.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace freevoxels {

/// `form` is how the help shows the value: "DEG", "X,Y,Z".
CLI::Option* addNumber(CLI::App& app, const std::string& name, const std::string& form, std::optional<double>& target,
                       const std::string& description, NumberRange range = {});
CLI::Option* addPair(CLI::App& app, const std::string& name, const std::string& form, std::optional<glm::dvec2>& target,
                     const std::string& description, NumberRange range = {});
CLI::Option* addTriple(CLI::App& app, const std::string& name, const std::string& form, std::optional<glm::dvec3>& target,
                       const std::string& description, NumberRange range = {});
CLI::Option* addWholeNumber(CLI::App& app, const std::string& name, const std::string& form, std::optional<int>& target,
                            const std::string& description, NumberRange range);
CLI::Option* addText(CLI::App& app, const std::string& name, const std::string& form, std::optional<std::string>& target,
                     const std::string& description);

/// Resolved options as "--name" and value, for messages, metadata and timings. An empty name is a positional,
/// an empty value a flag.
using OptionList = std::vector<std::pair<std::string, std::string>>;

/// The options by name without dashes; the positional is "input", a flag is "yes"; values of a repeated
/// option are joined by spaces.
std::map<std::string, std::string> optionMap(const OptionList& options);

/// The options as shell words, quoted where necessary.
std::string commandText(const OptionList& options);

}  // namespace freevoxels
