#pragma once
// Formats a long command line for reading.

#include <string>
#include <string_view>

namespace freevoxels {

/// Breaks a command into lines of at most `columns` characters: between words, or inside words that are
/// longer and not quoted. A shell reads the lines as the same command.
std::string wrappedCommand(std::string_view command, std::size_t columns);

}  // namespace freevoxels
