#include "apps/common/sequence.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numeric>

#include "apps/common/frame_names.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/volume/scan_file.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

/// `pattern` has a run of #.
Sequence filesOf(const std::string& pattern) {
  const NumberPlace place = placeOfNumber(pattern);
  std::vector<std::pair<FrameNumber, std::string>> frames;
  std::error_code error, unreadable;
  for (fs::directory_iterator entry(place.folder.empty() ? "." : place.folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::optional<FrameNumber> number = frameOf(name, place);
    const std::string file = place.folder + name + place.rest;
    if (number && (place.rest.empty() || fs::exists(file, unreadable))) frames.emplace_back(*number, file);
  }
  std::ranges::sort(frames);
  Sequence sequence{.pattern = pattern};
  for (auto& [number, file] : frames) {
    sequence.files.push_back(std::move(file));
    sequence.numbers.push_back(number);
  }
  return sequence;
}

/// Takes a number from the front of a text.
std::optional<double> takeNumber(std::string_view& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  constexpr double kLargest = 1e9;
  if (error != std::errc() || !(std::abs(number) < kLargest)) return std::nullopt;
  text.remove_prefix(std::size_t(end - text.data()));
  return number;
}

bool takeCharacter(std::string_view& text, char character) {
  if (!text.starts_with(character)) return false;
  text.remove_prefix(1);
  return true;
}

/// Nothing if it is none.
std::optional<FrameRange> rangeOf(std::string_view text) {
  const std::optional<double> first = takeNumber(text);
  if (!first) return std::nullopt;
  FrameRange range{.first = *first, .last = *first, .step = std::nullopt};
  if (takeCharacter(text, '-')) {
    const bool isOpen = text.empty() || text.front() == ':';
    const std::optional<double> last = isOpen ? FrameRange{}.last : takeNumber(text);
    if (!last || *last < *first) return std::nullopt;
    range.last = *last;
  }
  if (takeCharacter(text, ':')) {
    range.step = takeNumber(text);
    if (!range.step || !(*range.step > 0.0)) return std::nullopt;
  }
  return text.empty() ? std::optional(range) : std::nullopt;
}

}  // namespace

bool FrameRange::contains(const FrameNumber& number) const {
  constexpr double kSame = 1e-6;
  if (!(number.value >= first - kSame && number.value <= last + kSame)) return false;
  return !step || std::abs(std::remainder(number.value - first, *step)) < kSame;
}

FrameRange readFrameRange(const std::string& option, const std::string& text) {
  const std::optional<FrameRange> range = rangeOf(text);
  if (!range) fail(ErrorKind::Usage, "{} takes A-B, A-B:STEP, A- or A, numbers with A up to B and STEP above 0, not '{}'", option, text);
  return *range;
}

Sequence findSequence(const std::string& pattern) {
  Sequence sequence = filesOf(withHashes(pattern));
  if (sequence.files.empty()) fail(ErrorKind::Input, "there is no frame of '{}': its # stand for the digits of a file's number", pattern);
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
         sequence.numbers.front().text(1), sequence.numbers.back().text(1));
  return selected;
}

std::string gapsOf(const Sequence& sequence, const std::optional<FrameRange>& range) {
  std::vector<std::int64_t> numbers;
  for (const FrameNumber& number : sequence.numbers) numbers.push_back(std::llround(number.value));
  const double given = range ? range->step.value_or(1.0) : 0.0;
  const bool areWhole = std::ranges::all_of(sequence.numbers, [](const FrameNumber& number) { return number.fraction.empty(); });
  if (!areWhole || given != std::floor(given) || (range && range->first != std::floor(range->first))) return "";
  auto step = std::int64_t(given);
  if (!range)
    for (const std::int64_t number : numbers) step = std::gcd(step, number - numbers.front());
  std::string gaps;
  const auto addBetween = [&](std::int64_t before, std::int64_t after) {  // neither of which is missing
    const std::int64_t first = before + step, last = after - step;
    if (first > last) return;
    gaps += fmt::format("{}{}", gaps.empty() ? "" : ", ", first);
    if (last > first) gaps += fmt::format("{}{}", last - first == step ? ", " : "-", last);
  };
  if (range) addBetween(std::int64_t(range->first) - step, numbers.front());
  for (std::size_t i = 1; i < numbers.size(); ++i) addBetween(numbers[i - 1], numbers[i]);
  if (range && std::isfinite(range->last)) {
    const auto first = std::int64_t(range->first);
    addBetween(numbers.back(), first + (std::int64_t(std::floor(range->last)) - first) / step * step + step);
  }
  return gaps;
}

namespace {

/// The patterns that a name may be of, with the number at its end: "smoke_0001", "-0001", "0001.5". The best is the last.
std::vector<std::string> patternsOf(const std::string& name, std::size_t end) {
  constexpr std::string_view kDigits = "0123456789", kBeforeSigns = "_. ";
  constexpr std::size_t kMaxDigits = 9;  // of a FrameNumber
  const std::size_t first = end == 0 ? 0 : name.find_last_not_of(kDigits, end - 1) + 1,
                    digits = end - first;  // 0 where all of it are digits
  if (digits == 0 || digits > kMaxDigits) return {};
  std::vector<std::string> patterns;
  const bool mayBeFraction = end == name.size() && first > 1 && name[first - 1] == '.';
  if (mayBeFraction) patterns = patternsOf(name, first - 1);
  const bool isNegative =
      first > 0 && name[first - 1] == '-' && (first == 1 || kBeforeSigns.find(name[first - 2]) != std::string_view::npos);
  for (std::size_t width = name[first] == '0' ? digits : 1; width <= digits; ++width)
    patterns.push_back(name.substr(0, first - (isNegative ? 1 : 0)) + std::string(width, '#'));
  return patterns;
}

/// The pattern with most frames.
void takeMost(Sequence& most, const std::string& before, const std::string& name, const std::string& after) {
  if (name.find('#') != std::string::npos) return;
  const auto isWhole = [](const FrameNumber& number) { return number.fraction.empty(); };
  for (const std::string& pattern : patternsOf(name, name.size()))
    if (Sequence found = filesOf(before + pattern + after);
        found.files.size() >= most.files.size() &&
        std::ranges::any_of(found.numbers, isWhole))  // else what looks like a fraction is a number
      most = std::move(found);
}

}  // namespace

std::optional<Sequence> sequenceAround(const std::string& file) {
  Sequence most;
  const std::size_t start = file.rfind('/') + 1;  // 0 without a folder
  const std::string stem = stemOf(file);
  takeMost(most, file.substr(0, start), stem, file.substr(start + stem.size()));
  if (most.files.size() < 2 && start > 1) {
    const std::size_t folder = file.rfind('/', start - 2) + 1;
    takeMost(most, file.substr(0, folder), file.substr(folder, start - 1 - folder), file.substr(start - 1));
  }
  if (most.files.size() < 2) return std::nullopt;
  return most;
}

bool isPattern(const std::string& file) {
  std::error_code unreadable;
  return hasNumberPlace(file) && !fs::exists(file, unreadable);
}

std::optional<std::string> holdoutOf(const CameraDescription& camera, const FrameNumber& number) {
  if (!camera.holdout || !isPattern(*camera.holdout)) return camera.holdout;
  return frameName(*camera.holdout, number);
}

std::optional<std::string> holdoutOfTurn(const CameraDescription& camera, int frame, int frames) {
  if (camera.holdout && frames > 1 && !isPattern(*camera.holdout))
    fail(ErrorKind::Usage,
         "'{}' has the depths of one view, and the camera of a turn moves: render an image for each frame, and name them in {} "
         "with a run of #, from 0",
         *camera.holdout, Parameter("holdout"));
  return holdoutOf(camera, frame);
}

std::string nameOfVolume(const std::string& volume) {
  return proceduralName(volume).value_or(stemOf(volume));
}

NumberedVolumes findVolumes(std::span<const std::string> names, const std::optional<std::string>& frames) {
  NumberedVolumes found;
  for (const std::string& name : names) {
    if (!isPattern(name)) {
      found.volumes.push_back({name, int(found.volumes.size()), nameOfVolume(name)});
      continue;
    }
    found.haveNumbers = true;
    Sequence sequence = findSequence(name);
    std::optional<FrameRange> range;
    if (frames) {
      range = readFrameRange(fmt::format("{}", Parameter("frames")), *frames);
      sequence = selectFrames(sequence, *range);
    }
    if (const std::string gaps = gapsOf(sequence, range); !gaps.empty())
      found.gaps.push_back(fmt::format("'{}' has no file of frame {}", name, gaps));
    const NumberPlace place = placeOfNumber(sequence.pattern);
    for (std::size_t i = 0; i < sequence.files.size(); ++i) {
      // Files in numbered folders have one name.
      const std::string ending = place.rest.empty() ? "" : "_" + sequence.numbers[i].text(place.digits);
      found.volumes.push_back({sequence.files[i], sequence.numbers[i], nameOfVolume(sequence.files[i]) + ending});
    }
  }
  for (std::size_t i = 1; i < found.volumes.size(); ++i)
    if (found.volumes[i].file == found.volumes[i - 1].file)
      fail(ErrorKind::Usage, "'{}' is named twice: name it once", found.volumes[i].file);
  if (frames && !found.haveNumbers)
    fail(ErrorKind::Usage, "{} chooses among the files of a pattern: name one, as in smoke_####.vdb", Parameter("frames"));
  return found;
}

}  // namespace freevoxels
