#pragma once
// The file names of a sequence: "orbit_####.png" is orbit_0000.png, orbit_0001.png, ...

#include <string>
#include <vector>

namespace freevoxels {

/// Of a full turn.
inline constexpr int kDefaultFrames = 72, kMaximumFrames = 100000;

/// The pattern with the frame's number, padded with zeros, in place of the run of # in its file name; a
/// number that needs more digits has them. ExitCode::Usage where the file name has no run of # or several.
std::string frameName(const std::string& pattern, int frame);

/// [frame][pattern].
std::vector<std::vector<std::string>> frameNames(const std::vector<std::string>& patterns, int frames);

}  // namespace freevoxels
