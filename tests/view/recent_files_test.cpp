#include "apps/view/recent_files.h"

#include <cstdlib>

#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::TemporaryFolder;

TEST(RecentFiles, TheLastIsOnTopAndNoneIsThereTwice) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "deep/recent.json";
  RecentFiles recent(file);
  for (const char* name : {"/a.vdb", "/b.vdb", "/x/../a.vdb"}) recent.add(name);
  EXPECT_EQ(recent.list(), (std::vector<std::string>{"/a.vdb", "/b.vdb"}));
  EXPECT_EQ(RecentFiles(file).list(), recent.list()) << "kept for the next window";
}

TEST(RecentFiles, ThereAreAtMostTen) {
  const TemporaryFolder folder;
  RecentFiles recent(folder / "recent.json");
  for (int i = 0; i < 15; ++i) recent.add("/" + std::to_string(i) + ".vdb");
  ASSERT_EQ(recent.list().size(), RecentFiles::kMost);
  EXPECT_EQ(recent.list().front(), "/14.vdb");
  EXPECT_EQ(recent.list().back(), "/5.vdb");
}

TEST(RecentFiles, NamesAreKeptWhateverBytesAreInThem) {
  const TemporaryFolder folder;
  RecentFiles recent(folder / "recent.json");
  recent.add("/a \"b\" \\ \xC3\xA4.vdb");
  EXPECT_EQ(RecentFiles(folder / "recent.json").list(), recent.list());
  EXPECT_NO_THROW(recent.add("/\xFF.vdb"));
}

TEST(RecentFiles, AListThatCannotBeReadIsEmpty) {
  const TemporaryFolder folder;
  for (const char* text : {"", "{", "[1, null, \"/a.vdb\"]", "{\"a\": 2}", "7"}) {
    test::writeBytes(folder / "recent.json", text);
    EXPECT_LE(RecentFiles(folder / "recent.json").list().size(), 1u) << text;
  }
}

TEST(RecentFiles, AListThatCannotBeWrittenIsOfThisWindowAlone) {
  const TemporaryFolder folder;
  test::writeBytes(folder / "file", "");
  RecentFiles recent(folder / "file/recent.json");
  recent.add("/a.vdb");
  EXPECT_EQ(recent.list().size(), 1u);
  EXPECT_EQ(folder.fileCount(), 1u);
  RecentFiles none("");
  none.add("/a.vdb");
  EXPECT_TRUE(none.list().empty());
}

}  // namespace
}  // namespace freevoxels
