#pragma once
// Internal to the reading of scans: which of a file's channels are drawn, and how.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/parameter.h"
#include "engine/volume/scan_file.h"

namespace freevoxels {

/// Channels that are drawn together, and their numbers in the file.
struct ChosenChannels {
  std::vector<ChannelStyle> styles;
  std::vector<int> numbers;
  bool areColors = false;  ///< whether the numbers are those of colours, which have no styles
};

/// Names the numbers that follow each other in every voxel as channels.
void describeColors(ScanHeader& header);
/// The number of the channel with a name, or that has this number itself. Fails with ErrorKind::Input for others; `asked` is what says it.
int channelOf(const std::filesystem::path& file, const ScanHeader& header, const std::string& name, const Parameter& asked);
/// Those that are asked for, or that the file shows, with the file's colours and windows where none are given; all of colours. None where
/// one is read alone. Adds remarks to the header.
ChosenChannels chosenChannels(const std::filesystem::path& file, ScanHeader& header, const ScanRequest& request);
/// The window of a channel of which neither the file nor the user says one: from the end of the background, whose noise reaches as far
/// above the most frequent value as below it, to the value that one voxel in a thousand exceeds. Nothing where most voxels are above that.
std::optional<std::array<float, 2>> windowAboveBackground(const ScalarBricks& values);

}  // namespace freevoxels
