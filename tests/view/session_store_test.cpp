#include "apps/view/session_store.h"

#include <thread>

#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::TemporaryFolder;

TEST(SessionStore, TheLastFileIsOnTopAndNoneIsThereTwice) {
  const TemporaryFolder folder;
  SessionStore store(folder / "deep/state");
  for (const char* name : {"/a.vdb", "/b.vdb", "/x/../a.vdb"}) store.remember(name);
  EXPECT_EQ(store.recent(), (std::vector<std::string>{"/a.vdb", "/b.vdb"}));
  EXPECT_EQ(SessionStore(folder / "deep/state").recent(), store.recent()) << "kept for the next window";
}

TEST(SessionStore, ThereAreAtMostTenFiles) {
  const TemporaryFolder folder;
  SessionStore store(folder / "state");
  for (int i = 0; i < 15; ++i) store.remember("/" + std::to_string(i) + ".vdb");
  ASSERT_EQ(store.recent().size(), SessionStore::kMaxRecent);
  EXPECT_EQ(store.recent().front(), "/14.vdb");
  EXPECT_EQ(store.recent().back(), "/5.vdb");
}

TEST(SessionStore, NamesAreKeptWhateverBytesAreInThem) {
  const TemporaryFolder folder;
  SessionStore store(folder / "state");
  store.remember("/a \"b\" \\ \xC3\xA4.vdb");
  EXPECT_EQ(SessionStore(folder / "state").recent(), store.recent());
  EXPECT_NO_THROW(store.remember("/\xFF.vdb"));
}

TEST(SessionStore, AStateThatCannotBeReadIsEmpty) {
  const TemporaryFolder folder;
  for (const char* text : {"", "{", "[1]", "7", R"({"recent": 3, "bookmarks": []})", R"({"recent": [1, null, "/a.vdb"]})",
                           R"({"bookmarks": {"/a.vdb": [{"position": [1]}]}})"}) {
    test::writeBytes(folder / "viewer.json", text);
    SessionStore store(folder.path());
    EXPECT_LE(store.recent().size(), 1u) << text;
    store.remember("/b.vdb");
    EXPECT_EQ(store.recent().front(), "/b.vdb") << text;
  }
}

TEST(SessionStore, AStateThatIsTooDeepIsEmpty) {
  const TemporaryFolder folder;
  for (const std::size_t depth : {std::size_t(65), std::size_t(200'000)})
    for (const std::string& text : {"{\"recent\":" + std::string(depth, '[') + std::string(depth, ']') + "}", std::string(depth, '[')}) {
      test::writeBytes(folder / "viewer.json", text);
      SessionStore store(folder.path());
      EXPECT_TRUE(store.recent().empty());
      store.remember("/b.vdb");
      EXPECT_EQ(SessionStore(folder.path()).recent().front(), "/b.vdb");
    }
}

TEST(SessionStore, TwoWindowsKeepEachOthersFiles) {
  const TemporaryFolder folder;
  SessionStore one(folder / "state"), other(folder / "state");
  std::thread writer([&] {
    for (int i = 0; i < 5; ++i) one.remember("/one" + std::to_string(i) + ".vdb");
  });
  for (int i = 0; i < 5; ++i) other.remember("/other" + std::to_string(i) + ".vdb");
  writer.join();
  const SessionStore next(folder / "state");
  EXPECT_EQ(next.recent().size(), 10u) << "none is lost";
}

TEST(SessionStore, BookmarksBelongToTheirVolume) {
  const TemporaryFolder folder;
  SessionStore store(folder / "state");
  Camera camera;
  camera.position = {1.0, 2.0, 3.5};
  camera.orthographic = true;
  camera.orthographicHeight = 4.0;
  store.setBookmarks("/a.vdb", {camera});
  store.setKnowsHowToTurn();
  const SessionStore next(folder / "state");
  EXPECT_TRUE(next.knowsHowToTurn());
  EXPECT_TRUE(next.bookmarks("/b.vdb").empty());
  ASSERT_EQ(next.bookmarks("/a.vdb").size(), 1u);
  EXPECT_EQ(next.bookmarks("/a.vdb").front().position, camera.position);
  EXPECT_TRUE(next.bookmarks("/a.vdb").front().orthographic);
  EXPECT_EQ(next.bookmarks("/a.vdb").front().orthographicHeight, 4.0);
}

TEST(SessionStore, AThumbnailIsTheMiddleOfTheImage) {
  const TemporaryFolder folder;
  const SessionStore store(folder / "state");
  Image image{.size = {300, 200}};
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 300; ++x) image.pixels.push_back(x < 150 ? glm::vec4(1.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f, 0.0f, 1.0f, 1.0f));
  store.storeThumbnail("/a.vdb", image, {});
  const Image small = readPng(store.thumbnail("/a.vdb"));
  ASSERT_EQ(small.size, SessionStore::kThumbnailSize);
  EXPECT_NEAR(small.pixels[10].r, 1.0f, 1e-3f);
  EXPECT_NEAR(small.pixels[80].b, 1.0f, 1e-3f);
}

TEST(SessionStore, WithoutAFolderNothingIsStored) {
  const TemporaryFolder folder;
  test::writeBytes(folder / "file", "");
  SessionStore unwritable(folder / "file/state");
  unwritable.remember("/a.vdb");
  EXPECT_EQ(unwritable.recent().size(), 1u) << "for this window alone";
  EXPECT_EQ(folder.fileCount(), 1u);
  SessionStore none("");
  none.remember("/a.vdb");
  EXPECT_TRUE(none.recent().empty());
  EXPECT_TRUE(none.lastScene().empty());
}

}  // namespace
}  // namespace freevoxels
