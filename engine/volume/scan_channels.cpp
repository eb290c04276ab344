#include "engine/volume/scan_channels.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/volume/histogram.h"
#include "engine/volume/value_range.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// "0 'DAPI', 1 'GFP'"
std::string channelList(const ScanHeader& header) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < header.channels.size(); ++i)
    words.push_back(header.channels[i].name.empty() ? fmt::format("{}", i) : fmt::format("{} '{}'", i, printable(header.channels[i].name)));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// The name that a channel is chosen by: its own, or its number where others have the same name, or it has none.
std::string nameOfChannel(const ScanHeader& header, std::size_t number) {
  const std::string& name = header.channels[number].name;
  const bool isUnique = !name.empty() && std::ranges::count(header.channels, name, &ScanChannel::name) == 1;
  return isUnique ? name : fmt::format("{}", number);
}

/// All components of colours, where no channel of them is asked for.
ChosenChannels chosenColors(const fs::path& file, ScanHeader& header, const ScanRequest& request) {
  if (request.labels != nullptr)
    fail(ErrorKind::Usage, "'{}' has colours, and labels are single numbers: leave {} out", file.string(), Parameter("labels"));
  ChosenChannels chosen{.styles = {}, .numbers = {0, 1, 2}, .areColors = true};
  if (std::max(std::size_t(header.components), header.channels.size()) > 3) chosen.numbers.push_back(3);
  if (header.components == 1)
    header.remarks.push_back(fmt::format("its {} channels are drawn as colours ({} draws them as channels, {} one as a scan)",
                                         header.channels.size(), Parameter("channel"), Parameter("grid")));
  return chosen;
}

}  // namespace

void describeColors(ScanHeader& header) {
  header.channels = {{.name = "red", .color = glm::vec3(1.0f, 0.0f, 0.0f)},
                     {.name = "green", .color = glm::vec3(0.0f, 1.0f, 0.0f)},
                     {.name = "blue", .color = glm::vec3(0.0f, 0.0f, 1.0f)}};
  if (header.components > 3) header.channels.push_back({.name = "opacity", .color = glm::vec3(1.0f), .isShown = false});
}

int channelOf(const fs::path& file, const ScanHeader& header, const std::string& name, const Parameter& asked) {
  const auto named = std::ranges::find(header.channels, name, &ScanChannel::name);
  if (named != header.channels.end()) return int(named - header.channels.begin());
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [stopped, error] = std::from_chars(name.data(), end, number);
  if (error == std::errc() && stopped == end && number < std::max<std::size_t>(header.channels.size(), 1)) return int(number);
  if (header.channels.empty()) fail(ErrorKind::Input, "{} is none of '{}', which has one channel, 0", asked, file.string());
  fail(ErrorKind::Input, "{} is none of the channels of '{}': {}", asked, file.string(), channelList(header));
}

ChosenChannels chosenChannels(const fs::path& file, ScanHeader& header, const ScanRequest& request) {
  ChosenChannels chosen;
  if (!request.array.empty() && !header.channels.empty()) return chosen;
  if (header.areColors && request.channels.empty()) return chosenColors(file, header, request);
  if (!request.array.empty() || (request.channels.empty() && header.channels.empty())) return chosen;
  const auto add = [&](ChannelStyle style, int number) {
    if (!header.channels.empty()) {
      const ScanChannel& described = header.channels[std::size_t(number)];
      if (!style.color && style.function.empty()) style.color = described.color;
      if (!style.window && style.function.empty()) style.window = described.window;
    }
    chosen.styles.push_back(std::move(style));
    chosen.numbers.push_back(number);
  };
  for (const ChannelStyle& style : request.channels) add(style, channelOf(file, header, style.name, Parameter("channel", style.name)));
  if (!request.channels.empty()) return chosen;
  if (request.labels != nullptr)
    fail(ErrorKind::Usage, "'{}' has channels, and labels are of one: choose it with {}: {}", file.string(), Parameter("grid", "NAME"),
         channelList(header));
  const bool showsSome = std::ranges::any_of(header.channels, &ScanChannel::isShown);
  for (std::size_t i = 0; i < header.channels.size() && chosen.numbers.size() < kMaxChannels; ++i)
    if (header.channels[i].isShown || !showsSome)
      add({.name = nameOfChannel(header, i)}, int(i));
  header.remarks.push_back(fmt::format("{} of its {} channels are drawn ({} chooses others, {} draws one as a scan)", chosen.numbers.size(),
                                       header.channels.size(), Parameter("channel"), Parameter("grid")));
  return chosen;
}

std::optional<std::array<float, 2>> windowAboveBackground(const ScalarBricks& values) {
  constexpr int kBins = 4096;
  constexpr double kTail = 0.001, kMaxAbove = 0.5;  // parts of the voxels
  const auto [minimum, maximum] = rangeOf(values);
  if (!(minimum < maximum)) return std::nullopt;
  const Histogram histogram = histogramOf(values, minimum, maximum, kBins);
  const auto active = double(histogram.count());
  const auto binBelow = [&](double part) { return int(histogram.binOfRank(part * active)); };
  const int mode = int(std::ranges::max_element(histogram.counts) - histogram.counts.begin());
  const int begin = 2 * mode - std::min(binBelow(kTail), mode) + 1, end = binBelow(1.0 - kTail) + 1;
  if (begin >= end || binBelow(1.0 - kMaxAbove) >= begin) return std::nullopt;
  const auto valueAt = [low = minimum, high = maximum](int bin) { return std::lerp(low, high, float(bin) / float(kBins)); };
  return std::array{valueAt(begin), valueAt(end)};
}

}  // namespace freevoxels
