#pragma once
// Volumes of several channels: scalars that were measured at the same voxels, as by a microscope with several dyes. Each has a colour
// and a window of its values, and they are drawn in one march: extinctions add up, and so does the light that is scattered or sent out.

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

/// Channels of a volume at most.
inline constexpr std::size_t kMaxChannels = 16;
/// The name of the albedo and radiance grids that are made of channels.
inline constexpr const char* kChannelsName = "channels";

/// How a channel is drawn. Its intensity is 0 up to the beginning of the window, 1 from its end on, and linear between; or with a transfer
/// function its extinction, of which the largest counts as 1.
struct ChannelStyle {
  std::string name;                ///< of the grid, or its number from 0 on
  std::optional<glm::vec3> color;  ///< linear Rec.709, 0..1; else that of automaticChannelColor(). Factor of the function's colours, else 1
  std::string function = {};       ///< a transfer function, as readTransferCurves() takes it; empty for none
  float weight = 1.0f;             ///< of the density or the light of intensity 1, 0 or more
  /// Else from the least value to that which one voxel in a thousand exceeds, or where a transfer function has its values.
  std::optional<std::array<float, 2>> window;
  bool emits = false;                          ///< whether it sends out light and lets all other light through

  bool operator==(const ChannelStyle&) const = default;
};

/// The colour of a channel by its place in the list: colours of dyes, the sums of which are told apart.
glm::vec3 automaticChannelColor(std::size_t place);

/// Fills a volume, whose box and place are known, from its channels: with densities Σ w s and the albedo Σ w s c / Σ w s of intensities s,
/// weights w and colours c (of a transfer function those at the voxels' values); and with light of the same sums
/// (TemperatureGrid::isRadiance) of the channels that emit. `values` has the scalars of each channel for the volume's box. Fails with
/// ErrorKind::Input for transfer functions that cannot be read.
void mixChannels(Volume& volume, const std::vector<ChannelStyle>& channels, std::vector<ScalarBricks> values);

/// The factor of a channel's colours, by its place in the list.
glm::vec3 channelColor(const ChannelStyle& channel, std::size_t place);

/// The number that the name of a channel is, where channels have numbers alone. Fails with ErrorKind::Input if it is none of `count`.
std::size_t channelNumber(const ChannelStyle& channel, std::size_t count);

/// Fails with ErrorKind::Usage for more than kMaxChannels.
void checkCount(const std::vector<ChannelStyle>& channels);

}  // namespace freevoxels
