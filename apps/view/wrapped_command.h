#pragma once
// A long command line, to be read.

#include <string>
#include <string_view>

namespace freevoxels {

/// Broken into lines of at most so many characters: between its words, or within those that are longer and
/// not quoted. A shell takes the lines for the same command.
std::string wrappedCommand(std::string_view command, std::size_t columns);

}  // namespace freevoxels
