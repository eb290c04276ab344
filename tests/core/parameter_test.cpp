#include "engine/core/parameter.h"

#include <gtest/gtest.h>

#include "apps/common/failure.h"

namespace freevoxels {
namespace {

const std::string kText = fmt::format("the device is full: raise {}, or use {} and a smaller {}, not {}", Parameter("memory-limit"),
                                      Parameter("draw", "splats"), Parameter("size"), Parameter("memory-limit"));

TEST(Parameter, IsWrittenAsTheFrontEndSpellsIt) {
  EXPECT_EQ(withOptions(kText), "the device is full: raise --memory-limit, or use --draw splats and a smaller --size, not --memory-limit");
  EXPECT_EQ(plainlySpelled(kText), "the device is full: raise memory-limit, or use draw = splats and a smaller size, not memory-limit");
}

TEST(Parameter, IsListedOnce) {
  EXPECT_EQ(parametersIn(kText), (std::vector<std::string>{"memory-limit", "draw", "size"}));
  EXPECT_TRUE(parametersIn("no parameter").empty());
}

TEST(Parameter, ControlCharactersOfFileNamesStay) {
  for (const std::string text : {"'a\x01'", "'\x02\x03'", "'\x01 b\x03\x02'", "\x01"}) EXPECT_EQ(plainlySpelled(text), text);
}

TEST(Error, KeepsTheParametersOfItsSentence) {
  const Error error(ErrorKind::OutOfMemory, kText);
  EXPECT_STREQ(error.what(), plainlySpelled(kText).c_str());
  EXPECT_EQ(error.parameters().front(), "memory-limit");
  EXPECT_EQ(exitCodeOf(error.kind()), ExitCode::OutOfMemory);
}

}  // namespace
}  // namespace freevoxels
