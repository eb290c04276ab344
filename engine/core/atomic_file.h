#pragma once
// Outputs are written under a temporary name beside their destination and renamed when complete, so that a
// reader never sees half a file and a failed run leaves what was there before.

#include <filesystem>
#include <functional>
#include <string_view>

namespace freevoxels {

/// Calls `write` with a temporary path in the folder of `destination`, flushes it to the disk and renames it
/// to `destination`. The temporary keeps the extension of `destination`. Whatever `write` throws, the
/// temporary is removed; an exception that is not an `Error` (a library's "disk full") becomes one with
/// ExitCode::Output that names `destination` and the reason. InternalError and std::bad_alloc pass as they
/// are. `write` must throw when it could not write everything: core/checked_file.h helps.
void writeAtomically(const std::filesystem::path& destination,
                     const std::function<void(const std::filesystem::path&)>& write);

/// Writes a file that consists of these bytes, in the same way.
void writeTextAtomically(const std::filesystem::path& destination, std::string_view text);

/// Fails early, before any work, if `destination` can clearly not be written: its folder is missing or not
/// writable, or it is a folder itself.
void checkWritable(const std::filesystem::path& destination);

}  // namespace freevoxels
