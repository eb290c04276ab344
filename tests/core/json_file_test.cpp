#include "engine/core/json_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/description/scene_json.h"
#include "engine/volume/classification.h"
#include "engine/volume/transfer_curves.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

std::string repeated(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) result += text;
  return result;
}

/// Lists, objects, and both in turn, so many within each other; whole, and without their ends.
std::vector<std::string> nested(int depth) {
  const std::string inner = "0";
  return {repeated("[", depth) + inner + repeated("]", depth), repeated(R"({"a":)", depth) + inner + repeated("}", depth),
          repeated(R"([{"a":)", depth / 2) + repeated("[", depth % 2) + inner + repeated("]", depth % 2) + repeated("}]", depth / 2)};
}

TEST(JsonFile, IsReadUpToItsDepthAndRefusedBeyondInOneSentence) {
  for (const int depth : {1, 2, kDeepestJson - 1, kDeepestJson})
    for (const std::string& text : nested(depth)) {
      EXPECT_EQ(parseJson("scene", "a.json", text), parseJsonQuietly(text));
      EXPECT_FALSE(parseJsonQuietly(text).is_discarded()) << text;
      EXPECT_FALSE(isTooDeep(text)) << text;
    }
  for (const int depth : {kDeepestJson + 1, kDeepestJson + 2, 1000, 100'000, 2'000'000})
    for (const std::string& text : nested(depth)) {
      test::expectRefusal([&] { parseJson("scene", "a.json", text); }, ErrorKind::Input, {"scene 'a.json' is nested more than 64 deep"});
      EXPECT_TRUE(parseJsonQuietly(text).is_discarded());
      EXPECT_TRUE(isTooDeep(text));
      const std::string cut = text.substr(0, text.size() / 2);
      test::expectRefusal([&] { parseJson("scene", "a.json", cut); }, ErrorKind::Input, {"a.json"});
      EXPECT_TRUE(parseJsonQuietly(cut).is_discarded());
    }
}

TEST(JsonFile, BracketsInTextsAreNoDepth) {
  const std::string text = "[\"" + repeated("[{", 1000) + "\"]";
  EXPECT_EQ(parseJson("scene", "a.json", text).at(0).get<std::string>().size(), 2000u);
  EXPECT_FALSE(parseJsonQuietly(text).is_discarded());
}

TEST(JsonFile, WhatIsNoJsonIsQuietlyNone) {
  for (const char* text : {"", "{", "[1,", "\xff", "\"\x01\"", "1e999", "nan"}) {
    EXPECT_TRUE(parseJsonQuietly(text).is_discarded()) << text;
    EXPECT_FALSE(isTooDeep(text)) << text;
  }
  for (const char* text : {"1", "null", "\"a\"", R"({"a":1,"a":2})"}) EXPECT_FALSE(parseJsonQuietly(text).is_discarded()) << text;
}

TEST(JsonFile, SentencesStayShortAndPrintable) {
  const std::string letters(100'000, 'x'), list = "[" + repeated("7,", 50'000) + "7]";
  const auto expectShort = [](const auto& action) {
    const std::string sentence = test::errorOf(action).what();
    EXPECT_LT(sentence.size(), 900u) << sentence.substr(0, 1000);
    EXPECT_EQ(sentence.find('\x1b'), std::string::npos);
  };
  expectShort([&] { parseJson("scene", "a.json", "{\"" + letters); });
  expectShort([&] { parseJson("scene", "a.json", "{\"" + letters + "\":1,\"" + letters + "\":1}"); });
  expectShort([&] { parseJson("scene", "a.json", "\x1b[31m" + letters); });
  const test::TemporaryFolder folder;
  for (const std::string& text : {"{\"camera\":" + list + "}", "{\"camera\":{\"up\":[" + list + "]}}", "{\"" + letters + "\":{}}",
                                  "{\"camera\":{\"" + letters + "\":1}}", R"({"camera":{"fov":[true]}})" + std::string(), R"({"light":{"light":)" + list + "}}"}) {
    test::writeBytes(folder / "a.json", text);
    expectShort([&] { readScene(folder / "a.json"); });
  }
  expectShort([&] { parseTransferCurves("inline", "{\"" + letters + "\":1}"); });
}

}  // namespace
}  // namespace freevoxels
