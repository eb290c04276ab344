#include "apps/view/folder_list.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

class FolderListTest : public testing::Test {
 protected:
  FolderListTest() {
    std::filesystem::create_directory(folder / "scans");
    for (const char* const name : {"Head.vdb", "head_2.vdb", "cloud_1.vdb", "cloud_2.vdb", "notes.txt", ".hidden.vdb"})
      test::writeBytes(folder / name, std::string(std::string(name) == "Head.vdb" ? 10 : 5, 'x'));
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const FolderList::Entry& entry : list.entries()) all.push_back(entry.name);
    return all;
  }

  const test::TemporaryFolder folder;
  FolderList list;
};

TEST_F(FolderListTest, ListsFoldersThenFilesWithTheirEndingsAndSequences) {
  EXPECT_EQ(list.read(folder.path(), {".vdb"}, false), "");
  EXPECT_EQ(names(), (std::vector<std::string>{"scans/", "Head.vdb", "cloud_#.vdb", "cloud_1.vdb", "cloud_2.vdb", "head_2.vdb"}));
  EXPECT_EQ(list.hidden(), 1u);
  EXPECT_TRUE(list.hasFiles());
  EXPECT_FALSE(list.isVolume());
  list.sortBy(FolderList::Column::Size, true);
  EXPECT_EQ(names()[1], "Head.vdb");
  EXPECT_EQ(names().front(), "scans/") << "folders have no size";
  EXPECT_EQ(list.read(folder.path(), {}, true), "");
  EXPECT_EQ(names().size(), 6u) << "all files, and no sequence where one is to be saved";
  EXPECT_NE(list.read(folder / "none", {}, false).find("none"), std::string::npos);
  EXPECT_EQ(names().size(), 6u) << "as before";
}

TEST_F(FolderListTest, ArrowsGoThroughWhatContainsThePart) {
  list.read(folder.path(), {".vdb"}, false);
  EXPECT_EQ(list.next("head", "head", 1), "Head.vdb");
  EXPECT_EQ(list.next("head", "Head.vdb", 1), "head_2.vdb");
  EXPECT_EQ(list.next("head", "head_2.vdb", 1), "head_2.vdb") << "the last one";
  EXPECT_EQ(list.next("head", "head_2.vdb", -1), "Head.vdb");
  EXPECT_EQ(list.next("none", "none", 1), "none");
}

TEST_F(FolderListTest, NamesAreCompletedAsFarAsAllEntriesAgree) {
  list.read(folder.path(), {".vdb"}, false);
  EXPECT_EQ(list.completed("cl"), "cloud_");
  EXPECT_EQ(list.completed("cloud_1"), "cloud_1.vdb");
  EXPECT_EQ(list.completed("HEAD_"), "head_2.vdb");
  EXPECT_EQ(list.completed("he"), "he") << "as one begins with H, and the other with h";
  EXPECT_EQ(list.completed("none"), "none");
}

}  // namespace
}  // namespace freevoxels
