#include "apps/view/typed_text.h"

#include <gtest/gtest.h>

namespace freevoxels {
namespace {

using Found = std::optional<std::size_t>;

const std::vector<std::string> kEntries{"fog", "cloud", "ct-bone", "CT-lung", "cool-warm"};

TEST(TypedText, GoesToTheEntryThatBeginsWithIt) {
  TypedText typed;
  EXPECT_EQ(typed.find(kEntries, 0, "", 10.0), Found());
  EXPECT_EQ(typed.find(kEntries, 0, "c", 10.0), Found(1));
  EXPECT_EQ(typed.find(kEntries, 1, "T", 10.5), Found(2));
  EXPECT_EQ(typed.find(kEntries, 2, "-", 11.0), Found(2)) << "the current entry still begins so";
  EXPECT_EQ(typed.find(kEntries, 2, "l", 11.9), Found(3));
  EXPECT_EQ(typed.find(kEntries, 3, "x", 12.0), Found()) << "no entry begins so";
}

TEST(TypedText, BeginsANewTextAfterASecond) {
  TypedText typed;
  EXPECT_EQ(typed.find(kEntries, 0, "c", 10.0), Found(1));
  EXPECT_EQ(typed.find(kEntries, 1, "f", 11.1), Found(0));
}

TEST(TypedText, OneLetterGoesFromEntryToEntry) {
  TypedText typed;
  std::size_t current = 0;
  for (const std::size_t next : {1u, 2u, 3u, 4u, 1u}) {
    const Found found = typed.find(kEntries, current, "c", 10.0);
    ASSERT_EQ(found, Found(next));
    current = *found;
  }
}

TEST(TypedText, IsFoundWhereNoEntryIsChosen) {
  EXPECT_EQ(TypedText().find(kEntries, kEntries.size(), "f", 10.0), Found(0));
  EXPECT_EQ(TypedText().find({}, 0, "f", 10.0), Found());
}

}  // namespace
}  // namespace freevoxels
