#include "engine/description/label_words.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/description/text_values.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

constexpr const char *kAll = "all", *kNoLabels = "none", *kEmission = "emission";

std::vector<std::string> wordsOf(const std::string& text, char separator) {
  std::vector<std::string> words(1);
  for (const char character : text)
    if (character == separator)
      words.emplace_back();
    else
      words.back().push_back(character);
  return words;
}

glm::vec3 readColor(const std::string& name, const std::string& text) {
  const std::optional<glm::dvec3> linear = namedColor(text);
  if (!linear) fail(ErrorKind::Usage, "{} takes colours such as #d0a080 or red, not '{}'", name, quotedPart(text));
  return glm::vec3(*linear);
}

std::string colorText(glm::vec3 color) {
  const auto byte = [](float linear) { return int(srgbByteFromLinear(linear)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

/// Reads "7", "7=red", "7@0.3" and "7=red@0.3".
void readOne(const std::string& name, const std::string& word, Labels& labels) {
  const std::vector<std::string> parts = wordsOf(word, '@'), label = wordsOf(parts.front(), '=');
  if (parts.size() > 2 || label.size() > 2) fail(ErrorKind::Usage, "{} takes {}, not '{}'", name, kLabelsForm, quotedPart(word));
  // The largest whole number up to which double precision, which texts are read in, has all.
  constexpr double kLargest = 9007199254740992.0;
  const auto id = readNumbers({.name = name, .form = kLabelsForm, .range = {-kLargest, kLargest}, .whole = true}, label.front());
  LabelStyle style;
  if (label.size() > 1) style.color = readColor(name, label.back());
  if (parts.size() > 1)
    style.opacity = float(readNumbers({.name = name + " opacity", .form = "OPACITY", .range = {0.0, 1.0}}, parts.back()).front());
  labels.styles[std::int64_t(id.front())] = style;
}

}  // namespace

Labels readLabels(const std::string& name, const std::string& text) {
  Labels labels{.showsAll = false, .styles = {}};
  if (text == kNoLabels) return labels;
  for (const std::string& word : wordsOf(text, ','))
    if (word == kAll)
      labels.showsAll = true;
    else
      readOne(name, word, labels);
  return labels;
}

std::string labelsText(const Labels& labels) {
  if (labels.isNone()) return kNoLabels;
  std::vector<std::string> words;
  if (labels.showsAll) words.emplace_back(kAll);
  for (const auto& [label, style] : labels.styles) {
    std::string word = fmt::format("{}", label);
    if (style.color) word += fmt::format("={}", colorText(*style.color));
    if (style.opacity < 1.0f) word += fmt::format("@{}", style.opacity);
    words.push_back(word);
  }
  return fmt::format("{}", fmt::join(words, ","));
}

ChannelStyle readChannel(const std::string& name, const std::string& text) {
  constexpr double kLargest = 1e30;
  ChannelStyle channel;
  const std::vector<std::string> words = wordsOf(text, ':');
  channel.name = words.front();
  if (channel.name.empty()) fail(ErrorKind::Usage, "{} takes {}, not '{}'", name, kChannelForm, quotedPart(text));
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == kEmission) {
      channel.emits = true;
    } else if (word.find(',') != std::string::npos) {
      const auto n = readNumbers({.name = name + " window", .form = "LO,HI", .count = 2, .range = {-kLargest, kLargest}}, word);
      if (!(n[0] < n[1])) fail(ErrorKind::Usage, "{} has an empty window {}: give the smaller value first", name, word);
      channel.window = {float(n[0]), float(n[1])};
    } else {
      const std::vector<std::string> parts = wordsOf(word, '@');
      const std::optional<glm::dvec3> color = namedColor(parts.front());
      if (color)
        channel.color = glm::vec3(*color);
      else if (!parts.front().empty())
        channel.function = parts.front();
      else if (parts.size() == 1)
        fail(ErrorKind::Usage, "{} takes {}, not '{}'", name, kChannelForm, quotedPart(text));
      if (parts.size() > 1)
        channel.weight = float(readNumbers({.name = name + " weight", .form = "WEIGHT", .range = {0.0, kLargest}}, parts.back()).front());
    }
  }
  return channel;
}

std::string withFunction(const std::string& name, const std::string& text, const std::function<std::string(const std::string&)>& change) {
  ChannelStyle channel = readChannel(name, text);
  if (channel.function.empty()) return text;
  channel.function = change(channel.function);
  return channelText(channel);
}

std::string channelText(const ChannelStyle& channel) {
  std::vector<std::string> words{channel.name};
  const std::string weight = channel.weight != 1.0f ? fmt::format("@{}", channel.weight) : "";
  if (!channel.function.empty()) words.push_back(channel.function);
  if (channel.color || !weight.empty()) words.push_back(fmt::format("{}{}", channel.color ? colorText(*channel.color) : "", weight));
  if (channel.window) words.push_back(fmt::format("{},{}", (*channel.window)[0], (*channel.window)[1]));
  if (channel.emits) words.emplace_back(kEmission);
  return fmt::format("{}", fmt::join(words, ":"));
}

}  // namespace freevoxels
