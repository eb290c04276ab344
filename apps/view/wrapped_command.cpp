#include "apps/view/wrapped_command.h"

#include <algorithm>
#include <vector>

namespace freevoxels {

namespace {

constexpr std::string_view kBreak = " \\\n";  // which a shell passes over
constexpr std::size_t kBreakColumns = 2;

/// Split at blanks outside of single quotes.
std::vector<std::string_view> wordsOf(std::string_view command) {
  std::vector<std::string_view> words;
  bool quoted = false;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= command.size(); ++i) {
    if (i == command.size() || (command[i] == ' ' && !quoted)) {
      if (i > first) words.push_back(command.substr(first, i - first));
      first = i + 1;
    } else if (command[i] == '\'') {
      quoted = !quoted;
    } else if (command[i] == '\\' && !quoted) {
      ++i;  // what follows stands for itself
    }
  }
  return words;
}

}  // namespace

std::string wrappedCommand(std::string_view command, std::size_t columns) {
  std::string text;
  std::size_t used = 0;
  for (const std::string_view word : wordsOf(command)) {
    const bool fits = used + 1 + word.size() + kBreakColumns <= columns;
    if (used > 0) text += fits ? " " : kBreak;
    used = used > 0 && fits ? used + 1 + word.size() : word.size();
    text += word;
  }
  return text;
}

}  // namespace freevoxels
