#pragma once
// Outputs appear under their name when they are complete, so that a reader never sees half a file and a failed run leaves what
// was there before.

#include <filesystem>
#include <functional>
#include <string_view>

namespace freevoxels {

/// Calls `write` with a path through which it opens and writes the new contents, flushes them to the disk and gives them the name
/// `destination`. The path need not resemble `destination`: where the file system has files without a name (O_TMPFILE) it is
/// one in /proc, and nothing is left of a process that is killed. A file that is replaced keeps its mode and, where possible,
/// its owner; a symbolic link is kept and the file that it names is written, whether or not that exists. Whatever `write`
/// throws, `destination` is as before; an exception that is not an `Error` (a library's "disk full") becomes one with
/// ErrorKind::Output that names `destination` and the reason. InternalError and std::bad_alloc pass as they are. `write` must
/// throw when it could not write everything (core/checked_file.h helps); writing nothing is an error too.
void writeAtomically(const std::filesystem::path& destination,
                     const std::function<void(const std::filesystem::path&)>& write);

/// Writes a file that consists of these bytes, in the same way.
void writeTextAtomically(const std::filesystem::path& destination, std::string_view text);

/// Fails early, before any work, if `destination` can clearly not be written: its folder is missing or not
/// writable, or it is a folder itself.
void checkWritable(const std::filesystem::path& destination);

}  // namespace freevoxels
