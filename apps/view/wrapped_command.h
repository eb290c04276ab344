#pragma once
// A long command line, to be read.

#include <string>
#include <string_view>

namespace freevoxels {

/// Broken between its words into lines of at most so many characters, where its words allow that. A shell
/// takes the lines for the same command.
std::string wrappedCommand(std::string_view command, std::size_t columns);

}  // namespace freevoxels
