#pragma once
// Volumes that are the frames of one film: files whose names differ in a number.

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/common/frame_names.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

struct Sequence {
  std::string pattern;               ///< "smoke_####.vdb", as for frameName
  std::vector<std::string> files;    ///< that exist, in the order of their numbers
  std::vector<FrameNumber> numbers;  ///< of each file
};

/// Numbers of frames: all from first to last, or first, first + step, ... up to last.
struct FrameRange {
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  std::optional<double> step;
  bool contains(const FrameNumber& number) const;
};

/// "A-B:STEP", "A-B", "A-" or "A", in which A and B may be below 0. ErrorKind::Usage for anything else; `option` is what the sentence calls
/// it.
FrameRange readFrameRange(const std::string& option, const std::string& text);

/// The frames of a pattern. ErrorKind::Input where there is none, ErrorKind::Usage as for frameName.
Sequence findSequence(const std::string& pattern);

/// The frames of a sequence that are in the range. ErrorKind::Input where there is none.
Sequence selectFrames(const Sequence& sequence, const FrameRange& range);

/// "13, 17-19": the numbers of the range at which no file exists. Without a range those between the first and the last frame, in
/// steps of the greatest common divisor of the distances between numbers: of 0, 10, 30 that is 20. Empty where there are none, and of
/// frames with fractions.
std::string gapsOf(const Sequence& sequence, const std::optional<FrameRange>& range = std::nullopt);

/// The sequence that a file is a frame of: its name without extension ends in the number, or a folder is called by it. The # are as many
/// as make most frames. Nothing where it is the only one.
std::optional<Sequence> sequenceAround(const std::string& file);

/// Whether it names a sequence, not a file.
bool isPattern(const std::string& file);

/// A volume of a film.
struct NumberedVolume {
  std::string file;
  FrameNumber number;
  std::string name;  ///< of its images, where these have none of their own
};

/// The volumes of a film, in its order.
struct NumberedVolumes {
  std::vector<NumberedVolume> volumes;
  bool haveNumbers = false;       ///< whether some are of a pattern
  std::vector<std::string> gaps;  ///< a sentence for each pattern that has no file of some number
};

/// The volumes of files and patterns. `frames`, which readFrameRange reads, chooses among the files of patterns. Fails as findSequence and
/// selectFrames do, and with ErrorKind::Usage where `frames` chooses among nothing, or two neighbours are one file.
NumberedVolumes findVolumes(std::span<const std::string> names, const std::optional<std::string>& frames);

/// The image that a holdout's name is for the frame of this number: one for each frame if it is a pattern, else that of all frames.
std::optional<std::string> holdoutOf(const CameraDescription& camera, const FrameNumber& number);
/// The same for a frame of a full turn of `frames`, whose camera moves: ErrorKind::Usage unless the name is a pattern, where there are
/// several.
std::optional<std::string> holdoutOfTurn(const CameraDescription& camera, int frame, int frames);

/// "cloud" of "a/cloud.vdb" and of "procedural:cloud".
std::string nameOfVolume(const std::string& volume);

}  // namespace freevoxels
