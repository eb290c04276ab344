#include "apps/view/export_files.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace freevoxels {
namespace {

std::string saidByShell(const std::string& command) {
  std::FILE* const shell = popen(command.c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(shell)) != EOF;) text += char(c);
  pclose(shell);
  return text;
}

TEST(WrappedCommand, BreaksBetweenWords) {
  EXPECT_EQ(wrappedCommand("one two three", 80), "one two three");
  EXPECT_EQ(wrappedCommand("one two three", 9), "one two \\\nthree");
  EXPECT_EQ(wrappedCommand("one two three", 8), "one \\\ntwo \\\nthree");
  EXPECT_EQ(wrappedCommand("", 8), "");
}

TEST(WrappedCommand, BreaksWordsThatAreLongerThanALine) {
  EXPECT_EQ(wrappedCommand("a 1234567890 b", 6), "a \\\n12345\\\n67890 \\\nb");
  EXPECT_EQ(wrappedCommand("'123 4567890'", 6), "'123 4567890'") << "a quoted one has to stay";
}

TEST(WrappedCommand, AShellTakesItForTheSameCommand) {
  const std::string command =
      R"(printf '[%s]' a --b 'c  d' 'it'\''s  here' "" '{"x": [1, 2]}' longer-than-a-line-of-all)";
  for (const std::size_t columns : {1u, 10u, 14u, 20u, 30u})
    EXPECT_EQ(saidByShell(wrappedCommand(command, columns)), saidByShell(command)) << columns;
}

}  // namespace
}  // namespace freevoxels
