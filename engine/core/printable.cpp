#include "engine/core/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace freevoxels {

namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};

std::size_t lengthAfter(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

/// The UTF-8 character at the beginning of `text`, or one byte that begins none.
Character firstCharacter(std::string_view text) {
  constexpr std::uint32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000};  // of a character of so many bytes
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = lengthAfter(first);
  if (length == 1) return {first, 1, true};
  if (length == 0 || length > text.size()) return {};
  std::uint32_t code = first & (0x7fu >> length);
  for (const char byte : text.substr(1, length - 1)) {
    if ((static_cast<unsigned char>(byte) & 0xc0u) != 0x80u) return {};
    code = code << 6 | (static_cast<unsigned char>(byte) & 0x3fu);
  }
  const bool isSurrogate = code >= 0xd800 && code < 0xe000;
  if (code < kMin[length] || code > 0x10ffff || isSurrogate) return {};
  return {code, length, true};
}

bool isHarmless(std::uint32_t code) {
  const bool isControl = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool turnsDirection = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  const bool endsLine = code == 0x2028 || code == 0x2029;
  return !isControl && !turnsDirection && !endsLine;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character character = firstCharacter(text);
    const std::string_view bytes = text.substr(0, character.bytes);
    if (character.valid && isHarmless(character.code))
      result += bytes;
    else
      for (const char byte : bytes) result += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
    text.remove_prefix(bytes.size());
  }
  return result;
}

std::string printablePart(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return printable(text);
  const auto continues = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u; };
  std::size_t end = bytes;
  while (end > 0 && continues(text[end])) --end;
  return printable(text.substr(0, end)) + "...";
}

std::string quotedPart(std::string_view text) {
  constexpr std::size_t kLongest = 100;
  return printablePart(text, kLongest);
}

}  // namespace freevoxels
