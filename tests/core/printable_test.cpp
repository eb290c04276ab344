#include "engine/core/printable.h"

#include <gtest/gtest.h>

namespace freevoxels {
namespace {

TEST(Printable, TextOfAnyLanguageIsAsItWas) {
  for (const char* text : {"", "density[1]", "a\\b 'c' \"d\"", "Rauch \u00e4\u00f6\u00fc \u7159 \U0001f525", "\u00a0"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersAreEscaped) {
  EXPECT_EQ(printable("red \033[31m\n"), "red \\x1b[31m\\x0a");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\u009b31m"), "\\xc2\\x9b31m");  // a control sequence introducer of one character
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Printable, CharactersThatTurnTheDirectionOfTextAreEscaped) {
  EXPECT_EQ(printable("a\u202eb"), "a\\xe2\\x80\\xaeb");
  EXPECT_EQ(printable("\u2066\u2028"), "\\xe2\\x81\\xa6\\xe2\\x80\\xa8");
}

TEST(Printable, BytesThatAreNotUtf8AreEscaped) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc3"), "\\xc3");           // ends too early
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");  // '/' in more bytes than it needs
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a surrogate pair
  EXPECT_EQ(printable("\xf5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80");
  EXPECT_EQ(printable("\xe2\x82x"), "\\xe2\\x82x");
}

TEST(Printable, PartsEndBetweenCharacters) {
  EXPECT_EQ(printablePart("abc", 3), "abc");
  EXPECT_EQ(printablePart("abcd", 3), "abc...");
  EXPECT_EQ(printablePart("ab\u00e4d", 3), "ab...");
}

}  // namespace
}  // namespace freevoxels
