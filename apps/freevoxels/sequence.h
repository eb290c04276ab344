#pragma once
// Volumes that are the frames of one film: files whose names differ in a number.

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace freevoxels {

struct Sequence {
  std::string pattern;             ///< "smoke_####.vdb", as for frameName
  std::vector<std::string> files;  ///< that exist, in the order of their numbers
  std::vector<int> numbers;        ///< of each file
};

/// Numbers of frames: first, first + step, ... up to last.
struct FrameRange {
  int first = 0, last = std::numeric_limits<int>::max(), step = 1;
  bool contains(int number) const { return number >= first && number <= last && (number - first) % step == 0; }
};

/// "A-B:STEP", "A-B", "A-" or "A". ErrorKind::Usage for anything else; `option` is what the sentence calls it.
FrameRange readFrameRange(const std::string& option, const std::string& text);

/// The frames of a pattern. ErrorKind::Input where there is none, ErrorKind::Usage as for frameName.
Sequence findSequence(const std::string& pattern);

/// The frames of a sequence that are in the range. ErrorKind::Input where there is none.
Sequence selectFrames(const Sequence& sequence, const FrameRange& range);

/// "13, 17-19": the numbers of the range at which no file exists. Without a range those between the first and the last frame, in
/// steps of the greatest common divisor of the distances between numbers: of 0, 10, 30 that is 20. Empty where there are none.
std::string gapsOf(const Sequence& sequence, const std::optional<FrameRange>& range = std::nullopt);

/// The sequence that a file is a frame of: its name without extension ends in the number. The # are as many
/// as make most frames. Nothing where it is the only one.
std::optional<Sequence> sequenceAround(const std::string& file);

/// Whether it names a sequence, not a file.
bool isPattern(const std::string& file);

}  // namespace freevoxels
