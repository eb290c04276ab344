// Parts, and how many processes can divide a volume.

#include "apps/common/share_options.h"

#include "tests/refusal.h"

namespace freevoxels {
namespace {

TEST(ShareOptions, MoreRanksThanSharesAreRefused) {
  for (const int ranks : {1, 2, 256}) EXPECT_NO_THROW(checkRanks(ranks));
  test::expectRefusal([] { checkRanks(257); }, ErrorKind::Usage, {"257 ranks", "start 256 or fewer"});
}

TEST(ShareOptions, PartsAreReadAndWrittenAlike) {
  for (const char* text : {"0/1", "2/7", "255/256"}) EXPECT_EQ(sharePartText(readSharePart("--share", text)), text);
  for (const char* text : {"1/1", "-1/2", "0/0", "0/257", "0", "/2", "1/", "0/2x", "0,2"})
    test::expectRefusal([&] { readSharePart("--share", text); }, ErrorKind::Usage, {"--share takes I/N", text});
}

}  // namespace
}  // namespace freevoxels
