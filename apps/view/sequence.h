#pragma once
// Volumes that are the frames of one film: files whose names differ in a number.

#include <optional>
#include <string>
#include <vector>

namespace freevoxels {

struct Sequence {
  std::string pattern;             ///< "smoke_####.vdb", as for frameName
  std::vector<std::string> files;  ///< that are there, in the order of their numbers
};

/// The frames of a pattern. ExitCode::Input where there is none, ExitCode::Usage as for frameName.
Sequence findSequence(const std::string& pattern);

/// The sequence that a file is a frame of: its name without extension ends in the number. The # are as many
/// as make most frames. Nothing where it is the only one.
std::optional<Sequence> sequenceAround(const std::string& file);

/// Whether it names a sequence, not a file.
bool isPattern(const std::string& file);

}  // namespace freevoxels
