#pragma once
// Parameters in sentences for the user. The engine names what the user can change; every front end spells that name as its
// users write it: --memory-limit on the command line, memory_limit in Python.

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace freevoxels {

/// A parameter by the name of its option without dashes, such as "memory-limit", and the value that it is to have, if the
/// sentence says one. Formatting it puts marks into the text, which spelled() replaces.
struct Parameter {
  constexpr explicit Parameter(std::string_view parameter, std::string_view wanted = {}) : name(parameter), value(wanted) {}
  std::string_view name, value;
};

/// Returns how a front end's users write a parameter, with its value unless that is empty.
using Spelling = std::function<std::string(std::string_view name, std::string_view value)>;

/// The text with each Parameter as `spelling` writes it.
std::string spelled(std::string_view text, const Spelling& spelling);
/// The text with each Parameter by its bare name: "raise memory-limit", "use draw = splats".
std::string plainlySpelled(std::string_view text);
/// The names of the parameters in the text, in order, each once.
std::vector<std::string> parametersIn(std::string_view text);

}  // namespace freevoxels

template <>
struct fmt::formatter<freevoxels::Parameter> {
  constexpr auto parse(fmt::format_parse_context& context) { return context.begin(); }
  template <typename Context>
  auto format(const freevoxels::Parameter& parameter, Context& context) const {
    return fmt::format_to(context.out(), "\x01{}\x02{}\x03", parameter.name, parameter.value);
  }
};
