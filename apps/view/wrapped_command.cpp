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

/// A word that is longer than a line, where nothing in it keeps a shell from joining it again.
std::string inPieces(std::string_view word, std::size_t columns) {
  std::string pieces;
  const bool plain = word.find_first_of("'\"\\") == std::string_view::npos;
  for (; plain && columns > 1 && word.size() > columns; word.remove_prefix(columns - 1)) {
    pieces += word.substr(0, columns - 1);
    pieces += "\\\n";
  }
  return pieces.append(word);
}

}  // namespace

std::string wrappedCommand(std::string_view command, std::size_t columns) {
  std::string text;
  std::size_t used = 0;
  for (const std::string_view word : wordsOf(command)) {
    const bool fits = used + 1 + word.size() + kBreakColumns <= columns;
    if (used > 0) text += fits ? " " : kBreak;
    const std::string pieces = used > 0 && fits ? std::string(word) : inPieces(word, columns);
    used = used > 0 && fits ? used + 1 + word.size() : pieces.size() - (pieces.rfind('\n') + 1);
    text += pieces;
  }
  return text;
}

}  // namespace freevoxels
