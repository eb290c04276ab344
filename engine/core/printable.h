#pragma once
// Text from files and file names on its way to a terminal, which would obey control characters in it.

#include <string>
#include <string_view>

namespace freevoxels {

/// The text with control characters (C0, DEL, C1), characters that reverse the direction of writing, and bytes that are not
/// UTF-8 as "\x1b" for each of their bytes. All else is as it was.
std::string printable(std::string_view text);

/// printable() of the text's beginning, with "..." where `bytes` of it or more follow.
std::string printablePart(std::string_view text, std::size_t bytes);

/// The beginning of a wrong value, as long as a sentence can quote it.
std::string quotedPart(std::string_view text);

}  // namespace freevoxels
