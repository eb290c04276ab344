#pragma once

#include <filesystem>
#include <string_view>

namespace freevoxels {

/// Fails with ErrorKind::Input, before a library opens `file` and tells less, where it does not exist, is no regular file, or is in
/// a folder that may not be searched. `kind` is what the sentence calls it: "image".
void checkInputFile(std::string_view kind, const std::filesystem::path& file);

}  // namespace freevoxels
