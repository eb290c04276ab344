#include "apps/view/typed_text.h"

#include <algorithm>
#include <cctype>

namespace freevoxels {

bool containsIgnoringCase(const std::string& text, const std::string& part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::ranges::search(text, part, same).begin() != text.end() || part.empty();
}

bool startsIgnoringCase(const std::string& text, const std::string& part) {
  return part.size() <= text.size() && containsIgnoringCase(text.substr(0, part.size()), part);
}

std::optional<std::size_t> TypedText::find(const std::vector<std::string>& entries, std::size_t current, const std::string& letters,
                                           double time) {
  constexpr double kLongestPause = 1.0;
  if (letters.empty()) return {};
  if (time - last_ > kLongestPause) text_.clear();
  last_ = time;
  text_ += letters;
  const bool isOneLetter = text_.find_first_not_of(text_.front()) == std::string::npos;
  const std::string sought = isOneLetter ? text_.substr(0, 1) : text_;
  const std::size_t first = isOneLetter && current < entries.size() ? current + 1 : current;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (const std::size_t entry = (first + i) % entries.size(); startsIgnoringCase(entries[entry], sought)) return entry;
  return {};
}

}  // namespace freevoxels
