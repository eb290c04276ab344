#include "engine/volume/channels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/volume/histogram.h"
#include "engine/volume/transfer_source.h"
#include "engine/volume/value_range.h"

namespace freevoxels {

namespace {

/// The window of a channel for which none is given.
std::array<float, 2> automaticWindow(const ScalarBricks& values) {
  constexpr int kBins = 4096;
  constexpr double kBrighter = 0.001;  // part of the voxels
  const auto [minimum, maximum] = rangeOf(values);
  if (!(minimum < maximum)) return {std::min(minimum, 0.0f), maximum};
  const Histogram histogram = histogramOf(values, minimum, maximum, kBins);
  const auto active = double(histogram.count());
  const std::size_t bin = histogram.binOfRank(active - std::floor(kBrighter * active)) + 1;
  return {minimum, std::lerp(minimum, maximum, float(bin) / float(kBins))};
}

/// A channel as it adds to the sums.
struct Part {
  /// Intensity times weight, and the colour.
  struct Amount {
    float amount = 0.0f;
    glm::vec3 color{0.0f};
  };
  static constexpr int kIntervals = 4096;

  const ScalarBricks* values;
  std::array<float, 2> window;
  std::vector<Amount> amounts;  ///< over the window: at its ends only, or with a transfer function at the ends of kIntervals

  Amount at(float scalar) const {
    if (scalar == kInactiveVoxel || std::isnan(scalar) || !(window[0] < window[1])) return {};
    const float place = std::clamp((scalar - window[0]) / (window[1] - window[0]), 0.0f, 1.0f) * float(amounts.size() - 1);
    const std::size_t before = std::min(std::size_t(place), amounts.size() - 2);
    const float after = place - float(before);
    return {std::lerp(amounts[before].amount, amounts[before + 1].amount, after),
            amounts[before].color + after * (amounts[before + 1].color - amounts[before].color)};
  }
};

Part partOf(const ChannelStyle& style, std::size_t place, const ScalarBricks& values, const glm::dmat4& indexToWorld) {
  const glm::vec3 color = channelColor(style, place);
  if (style.function.empty())
    return {&values, style.window ? *style.window : automaticWindow(values), {{0.0f, color}, {style.weight, color}}};
  const TransferCurves curves = readTransferCurves(style.function);
  std::array<float, 2> window{float(curves.window.low), float(curves.window.high)};
  if (style.window)
    window = *style.window;
  else if (curves.range != TransferCurves::Range::Values)
    window = automaticWindow(values);
  Part part{&values, window, {}};
  if (!(window[0] < window[1])) return part;
  const Volume channel{.dimensions = values.dimensions(), .indexToWorld = indexToWorld};
  const Classification classification{.transferFunction =
                                          fitted(curves, channel, {.window = ValueWindow{double(window[0]), double(window[1])}})};
  std::vector<ClassifiedVoxel> entries;
  double largest = 0.0;
  for (int i = 0; i <= Part::kIntervals; ++i) {
    entries.push_back(classify(classification, std::lerp(window[0], window[1], float(i) / float(Part::kIntervals))));
    largest = std::max(largest, entries.back().extinction);
  }
  for (const ClassifiedVoxel& entry : entries)
    part.amounts.push_back({style.weight * float(largest > 0.0 ? entry.extinction / largest : 0.0), color * glm::vec3(entry.color)});
  return part;
}

/// Adds up the amounts of channels, whose box `sums` has, and makes the means of their colours.
void sumUp(const std::vector<Part>& parts, ScalarBricks& sums, std::array<ScalarBricks, 3>& colors) {
  for (const Part& part : parts)
    for (std::size_t brick = 0; brick < part.values->count(); ++brick) sums.makeBrick(part.values->cell(brick));
  colors.fill(sums);
  const std::span<ScalarBricks::Brick> sumBricks = sums.editable();
  std::array<std::span<ScalarBricks::Brick>, 3> colorBricks;
  for (std::size_t c = 0; c < 3; ++c) colorBricks[c] = colors[c].editable();
  tbb::parallel_for(std::size_t(0), sumBricks.size(), [&](std::size_t brick) {
    std::vector<std::optional<ScalarBricks::Brick>> of(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (const auto number = parts[i].values->numberAt(sums.cell(brick))) of[i] = parts[i].values->brick(*number);
    for (std::size_t voxel = 0; voxel < ScalarBricks::kVoxels; ++voxel) {
      float sum = 0.0f;
      glm::vec3 color(0.0f);
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const Part::Amount part = of[i] ? parts[i].at((*of[i])[voxel]) : Part::Amount();
        sum += part.amount;
        color += part.amount * part.color;
      }
      sumBricks[brick][voxel] = sum > 0.0f ? sum : kInactiveVoxel;
      for (int c = 0; c < 3; ++c) colorBricks[std::size_t(c)][brick][voxel] = sum > 0.0f ? color[c] / sum : kInactiveVoxel;
    }
  });
}

}  // namespace

glm::vec3 automaticChannelColor(std::size_t place) {
  constexpr std::array<glm::vec3, 8> kColors{
      glm::vec3(0.05f, 1.0f, 0.05f), glm::vec3(1.0f, 0.05f, 1.0f), glm::vec3(0.05f, 0.9f, 1.0f), glm::vec3(1.0f, 0.8f, 0.05f),
      glm::vec3(1.0f, 0.1f, 0.05f),  glm::vec3(0.1f, 0.2f, 1.0f),  glm::vec3(1.0f, 0.4f, 0.05f), glm::vec3(0.9f)};
  return kColors[place % kColors.size()];
}

glm::vec3 channelColor(const ChannelStyle& channel, std::size_t place) {
  return channel.color.value_or(channel.function.empty() ? automaticChannelColor(place) : glm::vec3(1.0f));
}

std::size_t channelNumber(const ChannelStyle& channel, std::size_t count) {
  const char* const end = channel.name.data() + channel.name.size();
  std::size_t number = 0;
  const auto [stopped, error] = std::from_chars(channel.name.data(), end, number);
  if (error != std::errc() || stopped != end || number >= count)
    fail(ErrorKind::Input, "there are {} channels, numbered from 0, and {} is none of them", count, Parameter("channel", channel.name));
  return number;
}

void checkCount(const std::vector<ChannelStyle>& channels) {
  if (channels.size() > kMaxChannels)
    fail(ErrorKind::Usage, "a volume has at most {} channels, and {} are given: leave some out", kMaxChannels, channels.size());
}

void mixChannels(Volume& volume, const std::vector<ChannelStyle>& channels, std::vector<ScalarBricks> values) {
  FV_CHECK_EQ(channels.size(), values.size());
  checkCount(channels);
  std::vector<Part> scattering, emitting;
  for (std::size_t i = 0; i < channels.size(); ++i)
    (channels[i].emits ? emitting : scattering).push_back(partOf(channels[i], i, values[i], volume.indexToWorld));
  const glm::ivec3 corner = values.front().corner();
  volume.isFog = true;
  volume.madeOf = MadeOf::Channels;
  volume.scalars = ScalarBricks(volume.dimensions, corner);
  if (!scattering.empty()) {
    volume.albedo = AlbedoGrid{.name = kChannelsName, .values = {}};
    sumUp(scattering, volume.scalars, volume.albedo->values);
  }
  if (!emitting.empty()) {
    TemperatureGrid& light = volume.temperature.emplace(TemperatureGrid{.name = kChannelsName, .isRadiance = true});
    light.values = ScalarBricks(volume.dimensions, corner);
    sumUp(emitting, light.values, light.colors);
    summariseValues(light);
    coverBricks(volume, light.values);
  }
  summariseValues(volume);
}

}  // namespace freevoxels
