#include "apps/freevoxels/sequence.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <numeric>

#include "apps/freevoxels/frame_names.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kMaxDigits = 9;  // that an int holds

std::size_t nameStart(const std::string& file) {
  return file.rfind('/') + 1;  // 0 without a folder
}

/// The number that makes `name` of the pattern.
std::optional<int> numberOf(const std::string& name, const std::string& pattern) {
  const std::size_t first = pattern.find('#'), end = pattern.find_last_of('#') + 1;
  const std::size_t around = first + pattern.size() - end;
  if (name.size() <= around || name.size() - around > kMaxDigits) return std::nullopt;
  const char* const digits = name.data() + first;
  const char* const digitsEnd = digits + (name.size() - around);
  int number = 0;
  const auto [read, error] = std::from_chars(digits, digitsEnd, number);
  if (error != std::errc() || read != digitsEnd || number < 0) return std::nullopt;
  return frameName(pattern, number) == name ? std::optional(number) : std::nullopt;
}

/// `pattern` has a run of #.
Sequence filesOf(const std::string& pattern) {
  frameName(pattern, 0);  // refuses what is no pattern
  const std::string folder = pattern.substr(0, nameStart(pattern));
  const std::string ownName = pattern.substr(nameStart(pattern));
  std::vector<std::pair<int, std::string>> frames;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (const std::optional<int> number = numberOf(name, ownName))
      frames.emplace_back(*number, folder + name);
  }
  std::ranges::sort(frames);
  Sequence sequence{.pattern = pattern};
  for (auto& [number, file] : frames) {
    sequence.files.push_back(std::move(file));
    sequence.numbers.push_back(number);
  }
  return sequence;
}

/// A whole number that fills the text.
std::optional<int> wholeNumber(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

}  // namespace

FrameRange readFrameRange(const std::string& option, const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string_view range = std::string_view(text).substr(0, colon);
  const std::size_t dash = range.find('-');
  const std::optional<int> first = wholeNumber(range.substr(0, dash));
  std::optional<int> last = first, step = 1;
  if (dash != std::string_view::npos)
    last = dash + 1 == range.size() ? std::numeric_limits<int>::max() : wholeNumber(range.substr(dash + 1));
  if (colon < text.size()) step = wholeNumber(std::string_view(text).substr(colon + 1));
  if (!first || !last || !step || *step < 1 || *last < *first)
    fail(ErrorKind::Usage, "{} takes A-B, A-B:STEP, A- or A, whole numbers with A up to B and STEP of at least 1, not '{}'", option,
         text);
  return {*first, *last, *step};
}

Sequence findSequence(const std::string& pattern) {
  Sequence sequence = filesOf(withHashes(pattern));
  if (sequence.files.empty())
    fail(ErrorKind::Input, "there is no frame of '{}': its # stand for the digits of a file's number",
         pattern);
  return sequence;
}

Sequence selectFrames(const Sequence& sequence, const FrameRange& range) {
  Sequence selected{.pattern = sequence.pattern};
  for (std::size_t i = 0; i < sequence.files.size(); ++i) {
    if (!range.contains(sequence.numbers[i])) continue;
    selected.files.push_back(sequence.files[i]);
    selected.numbers.push_back(sequence.numbers[i]);
  }
  if (selected.files.empty())
    fail(ErrorKind::Input, "'{}' has no frame among those chosen: its numbers are from {} to {}", sequence.pattern,
         sequence.numbers.front(), sequence.numbers.back());
  return selected;
}

std::string gapsOf(const Sequence& sequence, const std::optional<FrameRange>& range) {
  const std::vector<int>& numbers = sequence.numbers;
  std::int64_t step = range ? range->step : 0;
  if (!range)
    for (const int number : numbers) step = std::gcd(step, std::int64_t(number - numbers.front()));
  std::string gaps;
  const auto addBetween = [&](std::int64_t before, std::int64_t after) {  // neither of which is missing
    const std::int64_t first = before + step, last = after - step;
    if (first > last) return;
    gaps += fmt::format("{}{}", gaps.empty() ? "" : ", ", first);
    if (last > first) gaps += fmt::format("{}{}", last - first == step ? ", " : "-", last);
  };
  if (range) addBetween(range->first - step, numbers.front());
  for (std::size_t i = 1; i < numbers.size(); ++i) addBetween(numbers[i - 1], numbers[i]);
  if (range && range->last < std::numeric_limits<int>::max())
    addBetween(numbers.back(), range->first + (std::int64_t(range->last) - range->first) / step * step + step);
  return gaps;
}

std::optional<Sequence> sequenceAround(const std::string& file) {
  const std::size_t end = file.size() - fs::path(file).extension().string().size();
  const std::size_t before = file.find_last_not_of(kDigits, end == 0 ? 0 : end - 1);
  const std::size_t first = std::max(before + 1, nameStart(file));  // 0 where all of it are digits
  const std::size_t digits = end > first ? end - first : 0;
  if (digits == 0 || digits > kMaxDigits || file.find('#', nameStart(file)) != std::string::npos)
    return std::nullopt;
  Sequence most;
  for (std::size_t width = file[first] == '0' ? digits : 1; width <= digits; ++width) {
    Sequence found = filesOf(file.substr(0, first) + std::string(width, '#') + file.substr(end));
    if (found.files.size() >= most.files.size()) most = std::move(found);
  }
  if (most.files.size() < 2) return std::nullopt;
  return most;
}

bool isPattern(const std::string& file) {
  std::error_code unreadable;
  return withHashes(file).find('#', nameStart(file)) != std::string::npos && !fs::exists(file, unreadable);
}

}  // namespace freevoxels
