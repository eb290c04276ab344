#include "apps/common/frame_names.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "apps/common/output_options.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Where "%d" or "%0Nd" is in a text, and its N, else 1.
struct Conversion {
  std::size_t begin, end, digits;
};

std::optional<Conversion> findConversion(const std::string& text, std::size_t from) {
  constexpr std::size_t kMaxDigits = 9;  // that an int holds
  for (std::size_t begin = text.find('%', from); begin != std::string::npos; begin = text.find('%', begin + 1)) {
    std::size_t digits = 1;
    const char* const number = text.data() + begin + 1;
    const auto [end, error] = std::from_chars(number, text.data() + text.size(), digits);
    const bool isPadded = error == std::errc() && *number == '0';
    if ((isPadded || end == number) && digits >= 1 && digits <= kMaxDigits && *end == 'd')
      return Conversion{begin, std::size_t(end - text.data()) + 1, digits};
  }
  return std::nullopt;
}

/// The part of the pattern that may have the number: the file name, or the last folder with a place for it. Nothing if there is none.
struct Component {
  std::size_t begin, end;
};

template <typename HasPlace>
std::optional<Component> componentWith(const std::string& pattern, const HasPlace& hasPlace) {
  for (std::size_t end = pattern.size();;) {
    const std::size_t begin = end == 0 ? 0 : pattern.rfind('/', end - 1) + 1;  // 0 without a folder
    if (hasPlace(begin, end)) return Component{begin, end};
    if (begin == 0) return std::nullopt;
    end = begin - 1;
  }
}

}  // namespace

std::string FrameNumber::text(std::size_t digits) const {
  return fmt::format("{}{:0{}.0f}{}", value < 0.0 ? "-" : "", std::floor(std::abs(value)), digits, fraction);
}

std::string withHashes(const std::string& pattern) {
  std::optional<Conversion> conversion;
  componentWith(pattern, [&](std::size_t begin, std::size_t end) {
    conversion = findConversion(pattern, begin);
    if (conversion && conversion->end > end) conversion.reset();
    return conversion || std::string_view(pattern).substr(begin, end - begin).find('#') != std::string_view::npos;
  });
  if (!conversion) return pattern;
  return pattern.substr(0, conversion->begin) + std::string(conversion->digits, '#') + pattern.substr(conversion->end);
}

bool hasNumberPlace(const std::string& text) {
  return withHashes(text).find('#') != std::string::npos;
}

NumberPlace placeOfNumber(const std::string& pattern) {
  const std::string hashes = withHashes(pattern);
  const auto component = componentWith(hashes, [&](std::size_t begin, std::size_t end) {
    return std::string_view(hashes).substr(begin, end - begin).find('#') != std::string_view::npos;
  });
  if (!component)
    fail(ErrorKind::Usage,
         "'{}' has no place for the number of the frame: put a run of # into the file name, as in "
         "orbit_####.png",
         pattern);
  const std::string name = hashes.substr(component->begin, component->end - component->begin);
  const std::size_t first = name.find('#'), last = name.find_last_of('#');
  if (name.find_first_not_of('#', first) < last)
    fail(ErrorKind::Usage, "'{}' has several runs of #: leave one, for the number of the frame", pattern);
  return {.folder = hashes.substr(0, component->begin),
          .before = name.substr(0, first),
          .after = name.substr(last + 1),
          .rest = hashes.substr(component->end),
          .digits = last + 1 - first};
}

std::string frameName(const std::string& pattern, const FrameNumber& frame) {
  if (pattern == kStandardOutput) return pattern;
  const NumberPlace place = placeOfNumber(pattern);
  return place.folder + place.before + frame.text(place.digits) + place.after + place.rest;
}

std::optional<FrameNumber> frameOf(std::string_view name, const NumberPlace& pattern) {
  constexpr std::size_t kMaxDigits = 9, kMaxFraction = 6;
  if (name.size() <= pattern.before.size() + pattern.after.size() || !name.starts_with(pattern.before) || !name.ends_with(pattern.after))
    return std::nullopt;
  const std::string_view text = name.substr(pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size());
  const std::size_t sign = text.starts_with('-') ? 1 : 0, point = std::min(text.find('.'), text.size());
  const std::string_view digits = text.substr(sign, point - sign), fraction = text.substr(point);
  const auto areDigits = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (!areDigits(digits) || digits.size() > kMaxDigits) return std::nullopt;
  if (!fraction.empty() && (!areDigits(fraction.substr(1)) || fraction.size() > kMaxFraction + 1)) return std::nullopt;
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  const FrameNumber number(value, std::string(fraction));
  // printf counts the sign among the digits.
  const bool isPadded = number.text(pattern.digits) == text || (sign == 1 && number.text(pattern.digits - 1) == text);
  return isPadded ? std::optional(number) : std::nullopt;
}

}  // namespace freevoxels
