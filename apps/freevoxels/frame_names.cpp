#include "apps/freevoxels/frame_names.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "apps/freevoxels/output_options.h"
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

}  // namespace

std::string withHashes(const std::string& pattern) {
  const auto conversion = findConversion(pattern, pattern.rfind('/') + 1);  // 0 without a folder
  if (!conversion) return pattern;
  return pattern.substr(0, conversion->begin) + std::string(conversion->digits, '#') + pattern.substr(conversion->end);
}

std::string frameName(const std::string& pattern, int frame) {
  if (pattern == kStandardOutput) return pattern;
  const std::string hashes = withHashes(pattern);
  const std::size_t first = hashes.find('#', hashes.rfind('/') + 1);
  if (first == std::string::npos)
    fail(ErrorKind::Usage,
         "'{}' has no place for the number of the frame: put a run of # into the file name, as in "
         "orbit_####.png",
         pattern);
  const std::size_t end = std::min(hashes.find_first_not_of('#', first), hashes.size());
  if (hashes.find('#', end) != std::string::npos)
    fail(ErrorKind::Usage, "'{}' has several runs of #: leave one, for the number of the frame", pattern);
  return fmt::format("{}{:0{}}{}", hashes.substr(0, first), frame, end - first, hashes.substr(end));
}

}  // namespace freevoxels
