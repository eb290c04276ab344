#include "engine/core/parameter.h"

#include <algorithm>

namespace freevoxels {

std::string spelled(std::string_view text, const Spelling& spelling) {
  std::string result;
  while (!text.empty()) {
    const std::size_t begin = text.find('\x01');
    const std::size_t middle = std::min(text.find('\x02', begin), text.size());
    const std::size_t end = std::min(text.find('\x03', middle), text.size());
    if (end == text.size()) break;  // no parameter, whatever control characters there are
    result += text.substr(0, begin);
    result += spelling(text.substr(begin + 1, middle - begin - 1), text.substr(middle + 1, end - middle - 1));
    text.remove_prefix(end + 1);
  }
  result += text;
  return result;
}

std::string plainlySpelled(std::string_view text) {
  return spelled(text, [](std::string_view name, std::string_view value) {
    return value.empty() ? std::string(name) : fmt::format("{} = {}", name, value);
  });
}

std::vector<std::string> parametersIn(std::string_view text) {
  std::vector<std::string> names;
  spelled(text, [&](std::string_view name, std::string_view) {
    if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
    return std::string();
  });
  return names;
}

}  // namespace freevoxels
