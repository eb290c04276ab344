// freevoxels-view by the keyboard: files that are found by typing, menus, and files that are not read to their end.

#include "tests/commands/viewer_fixture.h"

namespace freevoxels::test {
namespace {

TEST_F(Viewer, AFileIsFoundByTypingAPartOfItsNameTabAndArrows) {
  for (const char* const name : {"alpha_head_whose_name_is_longer_than_others", "beta_cloud", "beta_cube"})
    expectSuccess(run(fmt::format("generate cube @{}.vdb --resolution 16 --quiet", name)));
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 900 600");
  session->save('s', "a.png");
  const auto openedBy = [&](const char* text, const char* keys, const char* scene) {
    session->hands("mousemove 700 300 key ctrl+o");
    session->hands(std::string("type --delay 1 ") + text);
    session->hands(keys);
    session->hands("key Return mousemove 700 300 sleep 0.3");
    return sceneOf(*session, scene).at("input").at("volume").get<std::string>();
  };
  EXPECT_EQ(openedBy("alpha_head_whose_name", "key Tab", "1.json"), "alpha_head_whose_name_is_longer_than_others.vdb") << "completed";
  EXPECT_EQ(openedBy("cu", "key Down", "2.json"), "beta_cube.vdb") << "the one that has this in its name";
  EXPECT_EQ(openedBy("beta", "key Down key Down key Up", "3.json"), "beta_cloud.vdb");
  expectQuietEnd(*session);
}

TEST_F(Viewer, MenusAndChoicesAreGoneThroughWithArrowsEnterAndEscape) {
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 900 600");
  const nlohmann::json first = sceneOf(*session, "first.json");
  // The menu View, whose first entry is chosen at first: the second one is the other projection.
  session->hands("mousemove 104 10 click 1");
  session->hands("sleep 0.2 key Down sleep 0.1 key Return sleep 0.1 mousemove 700 300");
  session->hands("sleep 0.2");
  EXPECT_TRUE(sceneOf(*session, "other.json").at("camera").contains("orthographic"));
  session->hands("mousemove 104 10 click 1");
  session->hands("sleep 0.2 key Escape mousemove 700 300");
  session->hands("sleep 0.2 key o");  // a shortcut again, as no menu is open
  session->hands("sleep 0.2");
  EXPECT_FALSE(sceneOf(*session, "again.json").at("camera").contains("orthographic"));
  session->hands("mousemove 104 10 click 1");
  expectQuietEnd(*session);  // by Ctrl+Q, though the menu is open
}

TEST_F(Viewer, ReadingIsGivenUpByEscape) {
  const auto session = use("procedural:cloud --resolution 16 --verbose");
  session->hands("windowsize @ 900 600");
  session->save('s', "a.png");
  // Far more voxels than are made until the key is pressed.
  writeBytes(folder / "large.json", R"({"input": {"volume": "procedural:cloud", "resolution": 900}})");
  session->open("large.json");
  session->hands("mousemove 700 300 sleep 0.5 key Escape sleep 0.5 key ctrl+z");  // back to the small one
  session->save('s', "b.png");
  EXPECT_NE(readBytes(folder / "said.txt").find("was given up"), std::string::npos);
  EXPECT_EQ(session->quit().exitCode, 0);
}

}  // namespace
}  // namespace freevoxels::test
