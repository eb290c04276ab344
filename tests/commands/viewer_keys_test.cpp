// freevoxels-view by the keyboard: files that are found by typing, menus, and files that are not read to their end.

#include <cstdlib>

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
  session->hands("sleep 0.5 key Down sleep 0.3 key Return sleep 0.3 mousemove 700 300");
  session->hands("sleep 0.2");
  EXPECT_TRUE(sceneOf(*session, "other.json").at("camera").contains("orthographic"));
  session->hands("mousemove 104 10 click 1");
  session->hands("sleep 0.5 key Escape sleep 0.3 mousemove 700 300");
  session->hands("sleep 0.2 key o");  // a shortcut again, as no menu is open
  session->hands("sleep 0.2");
  EXPECT_FALSE(sceneOf(*session, "again.json").at("camera").contains("orthographic"));
  session->hands("mousemove 104 10 click 1");
  expectQuietEnd(*session);  // by Ctrl+Q, though the menu is open
}

TEST_F(Viewer, AnEntryOfAListIsFoundByTypingHowItBegins) {
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 900 600");
  session->save('s', "a.png");  // the panel Look is there from the first image on
  const auto modeAfter = [&](const char* keys, const char* scene) {
    session->hands("mousemove 230 229 click 1 sleep 0.5");
    session->hands(keys);
    session->hands("sleep 0.3 key Return sleep 0.3 mousemove 700 300");
    return sceneOf(*session, scene).at("method").value("mode", "volume");
  };
  EXPECT_EQ(modeAfter("key a", "average.json"), "average");
  EXPECT_EQ(modeAfter("key v key o", "volume.json"), "volume");
  EXPECT_EQ(modeAfter("key m", "mip.json"), "mip");
  expectQuietEnd(*session);
}

TEST_F(Viewer, LettersAreThoseOfTheKeyboardsLayout) {
  if (!installedProgram("setxkbmap")) GTEST_SKIP() << "setxkbmap is not installed: the keyboard has one layout here";
  for (const char* const layout : {"us", "de", "fr"}) {  // Z is elsewhere on a German keyboard, A and Q on a French one
    ASSERT_EQ(std::system(fmt::format("setxkbmap {}", layout).c_str()), 0);
    const auto session = use("procedural:cloud --resolution 16");
    session->hands("windowsize @ 600 200");
    sceneOf(*session, fmt::format("{}_first.json", layout));
    session->hands("mousemove 500 100 key o");
    EXPECT_TRUE(sceneOf(*session, fmt::format("{}_other.json", layout)).at("camera").contains("orthographic")) << layout;
    session->hands("key ctrl+a key ctrl+shift+z");  // the former is no shortcut, and the latter goes back to the camera before
    EXPECT_FALSE(sceneOf(*session, fmt::format("{}_back.json", layout)).at("camera").contains("orthographic")) << layout;
    expectQuietEnd(*session);
  }
  EXPECT_EQ(std::system("setxkbmap us"), 0);
}

TEST_F(Viewer, ReadingIsGivenUpByEscape) {
  const auto session = use("procedural:cloud --resolution 16 --verbose");
  session->hands("windowsize @ 900 600");
  session->save('s', "a.png");
  // Far more voxels than are made until the key is pressed.
  writeBytes(folder / "large.json", R"({"input": {"volume": "procedural:cloud", "resolution": 900}})");
  session->open("large.json");
  for (int i = 0; i < 4; ++i) session->hands("mousemove 700 300 sleep 0.5 key Escape");  // the first may come before it is read
  session->hands("sleep 0.5 key ctrl+z");                                                // back to the small one
  session->save('s', "b.png");
  EXPECT_NE(readBytes(folder / "said.txt").find("was given up"), std::string::npos);
  EXPECT_EQ(session->quit().exitCode, 0);
}

}  // namespace
}  // namespace freevoxels::test
