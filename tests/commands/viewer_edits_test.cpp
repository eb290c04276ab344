// Edits in the window of freevoxels-view: by panels, handles in the image and slices, and their undoing.

#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "engine/image/srgb.h"
#include "tests/commands/viewer_fixture.h"

namespace freevoxels::test {

namespace {

/// A spot of one colour (sRGB), wider than lines and letters; not that of the axes in the corner.
std::optional<glm::ivec2> findSpot(const Image& screen, glm::ivec3 color) {
  const auto isColor = [&](int x, int y) {
    const glm::vec4 pixel = screen.pixels[std::size_t(y * screen.size.x + x)];
    for (int c = 0; c < 3; ++c)
      if (std::abs(pixel[c] - linearFromSrgb(float(color[c]) / 255.0f)) > 0.01f) return false;
    return true;
  };
  for (int y = kBar + 3; y < kWindow.y - kBar - 3; ++y)
    for (int x = kPanel + 3; x < kWindow.x - 3; ++x) {
      if (isCovered({x - kPanel, y - kBar}, {kWindow.x - kPanel, kWindow.y - 2 * kBar})) continue;
      bool all = true;
      for (int i = 0; i < 25 && all; ++i) all = isColor(x + i % 5 - 2, y + i / 5 - 2);
      if (all) return glm::ivec2(x, y);
    }
  return {};
}

}  // namespace

TEST_F(Viewer, CamerasGoBackAndForwardAndTheLastSceneComesBack) {
  nlohmann::json last;
  {
    const auto session = use("procedural:cloud --resolution 16");
    session->hands("windowsize @ 600 200");
    const nlohmann::json first = sceneOf(*session, "first.json");
    session->hands("mousemove 500 100 key 1");
    const nlohmann::json right = sceneOf(*session, "right.json");
    ASSERT_NE(armOf(right), armOf(first));
    session->hands("mousemove 500 100 key 3");
    sceneOf(*session, "above.json");
    session->hands("key ctrl+shift+z");
    EXPECT_EQ(sceneOf(*session, "before.json"), right);
    session->hands("key ctrl+shift+z");
    EXPECT_EQ(vectorOf(sceneOf(*session, "before2.json"), "camera-position"), vectorOf(first, "camera-position"));
    session->hands("key ctrl+shift+y");
    last = sceneOf(*session, "after.json");
    EXPECT_EQ(last, right);
    session->hands("key Tab");  // hides the panel
    session->save('s', "wide.png");
    EXPECT_EQ(readPng(folder / "wide.png").size.x, 600);
    session->hands("key Tab");
    expectQuietEnd(*session);
  }
  const auto session = use("procedural:cube --resolution 16");
  session->hands("windowsize @ 600 200");
  session->save('s', "cube.png");
  session->hands("key ctrl+shift+o");
  const nlohmann::json restored = sceneOf(*session, "restored.json");
  EXPECT_EQ(restored.at("input"), last.at("input"));
  EXPECT_EQ(vectorOf(restored, "camera-position"), vectorOf(last, "camera-position"));
  expectQuietEnd(*session);
}

TEST_F(Viewer, ThePanelsValuesAreDraggedAndAFinishedImageIsShownBrighterWithoutDrawingIt) {
  writeBytes(folder / "tf.json", R"({"opacity": [[0, 0], [1, 0.5]]})");
  const auto session = use("procedural:cloud --resolution 32 --verbose");
  const auto wholeImages = [&] {
    const std::string said = readBytes(folder / "said.txt");
    int count = 0;
    for (std::size_t at = said.find("whole image"); at != std::string::npos; at = said.find("whole image", at + 1)) ++count;
    return count;
  };
  const std::string before = session->save('s', "before.png");
  const int drawn = wholeImages();
  session->hands("mousemove 228 437 mousedown 1 mousemove 240 437 mousemove 262 437 mouseup 1 mousemove 700 300");
  EXPECT_NE(session->save('s', "brighter.png"), before);
  const nlohmann::json brighter = sceneOf(*session, "brighter.json");
  EXPECT_GT(brighter.at("output").at("exposure"), 0.5);
  EXPECT_EQ(wholeImages(), drawn);
  session->hands("mousemove 700 300 key 1 key ctrl+z");
  const nlohmann::json undone = sceneOf(*session, "undone.json");
  EXPECT_FALSE(undone.contains("output") && undone.at("output").contains("exposure"));
  EXPECT_EQ(vectorOf(undone, "up"), glm::dvec3(0.0, 1.0, 0.0));
  EXPECT_NE(vectorOf(undone, "camera-position"), vectorOf(brighter, "camera-position")) << "cameras are no edits";
  session->hands("key ctrl+y key ctrl+shift+z");

  session->hands("mousemove 143 151 click 1 mousemove 700 300");  // the box that clips
  EXPECT_EQ(sceneOf(*session, "clipped.json").at("input").at("clip-box").size(), 6u);
  session->hands("key ctrl+z");
  EXPECT_FALSE(sceneOf(*session, "unclipped.json").at("input").contains("clip-box"));

  session->open("tf.json");
  const std::string function = sceneOf(*session, "function.json").at("classification").at("transfer-function").dump();
  session->hands("mousemove 700 300 mousedown 3 mousemove 760 300 mousemove 640 340 mouseup 3");
  const nlohmann::json windowed = sceneOf(*session, "windowed.json");
  EXPECT_EQ(windowed.at("classification").at("transfer-function").dump(), function);
  EXPECT_TRUE(windowed.at("classification").contains("window"));

  session->hands("mousemove 337 600 mousedown 1 mousemove 420 600 mousemove 440 600 mouseup 1 mousemove 700 300");
  session->save('s', "narrow.png");
  EXPECT_NEAR(readPng(folder / "narrow.png").size.x, kWindow.x - 443, 4) << "the panel's border is dragged";
  EXPECT_EQ(session->quit().exitCode, 0);
}

TEST_F(Viewer, HandlesMoveTheBoxAndThePlaneThatClip) {
  constexpr glm::ivec3 kRed{224, 96, 88}, kYellow{240, 200, 80};  // of the sides across x, and of the plane
  const auto session = use("procedural:cube --resolution 16 --orbit 40,20");
  const auto drag = [&](glm::ivec3 color, glm::ivec2 way) {
    // The window may still show the dialog in which the scene was saved, or the volume as it was clipped before.
    std::optional<glm::ivec2> spot, before;
    for (int i = 0; i < 100 && (!spot || spot != before); ++i) {
      session->hands("sleep 0.4");
      before = std::exchange(spot, findSpot(display->screen(), color));
    }
    ASSERT_TRUE(spot);
    const glm::ivec2 half = *spot + way / 2, end = *spot + way;
    session->hands(fmt::format("mousemove {} {} mousedown 1 mousemove {} {} mousemove {} {} mouseup 1 mousemove 700 60", spot->x, spot->y,
                               half.x, half.y, end.x, end.y));
  };
  session->save('s', "image.png");  // without one there is nothing to clip
  session->hands("mousemove 143 151 click 1 mousemove 700 60");
  const auto whole = sceneOf(*session, "whole.json").at("input").at("clip-box");
  drag(kRed, {60, 0});
  const auto cut = sceneOf(*session, "cut.json").at("input").at("clip-box");
  EXPECT_TRUE(cut.at(0) > whole.at(0) || cut.at(3) < whole.at(3) || cut.at(0) > 0) << cut.dump();
  for (const int i : {1, 2, 4, 5}) EXPECT_EQ(cut.at(i), whole.at(i)) << "along y and z it stays";
  session->hands("mousemove 143 151 click 1 mousemove 205 151 click 1 mousemove 700 60");
  const nlohmann::json plane = sceneOf(*session, "plane.json").at("input");
  EXPECT_FALSE(plane.contains("clip-box"));
  drag(kYellow, {0, -70});
  const nlohmann::json moved = sceneOf(*session, "moved.json").at("input");
  EXPECT_NE(plane.at("clip-plane"), moved.at("clip-plane"));
  for (const int i : {3, 4, 5}) EXPECT_EQ(plane.at("clip-plane").at(i), moved.at("clip-plane").at(i)) << "its normal stays";
  session->hands("key ctrl+z");
  EXPECT_EQ(sceneOf(*session, "undone.json").at("input"), plane);
  expectQuietEnd(*session);
}

TEST_F(Viewer, ABakedVolumeIsClippedLikeOthers) {
  expectSuccess(run("bake procedural:cube @cube.fvx --resolution 16 --quiet"));
  const auto session = use("cube.fvx");
  session->save('s', "image.png");                               // without one there is nothing to clip
  session->hands("mousemove 143 125 click 1 mousemove 700 60");  // there is no row for the resolution
  const nlohmann::json scene = sceneOf(*session, "clipped.json");
  EXPECT_EQ(scene.at("input").at("clip-box").dump(), "[0,0,0,15,15,15]");
  EXPECT_FALSE(scene.contains("classification")) << "it is the file's";
  session->save('s', "clipped.png");
  expectQuietEnd(*session);
}

TEST_F(Viewer, SlicesShowTheValuesAndGoToWhereTheyAreClicked) {
  const auto session = use("procedural:cloud --resolution 32");
  const auto save = [&](const char* name) {
    session->save('s', name);
    return readPng(folder / name).size;
  };
  const glm::ivec2 all = save("all.png");
  session->hands("mousemove 700 300 key l");
  const glm::ivec2 beside = save("beside.png");
  EXPECT_EQ(beside.y, all.y);
  EXPECT_LT(beside.x, all.x) << "the slices are beside the image";
  const int left = kPanel + beside.x;
  const auto greys = [&] {  // of the slices alone
    const Image screen = cropped(display->screen(), {{left, kBar}, {kWindow.x - left, kWindow.y - 2 * kBar}});
    std::vector<float> values;
    for (const glm::vec4& pixel : screen.pixels) values.push_back(pixel.r + pixel.g + pixel.b);
    return values;
  };
  session->hands("sleep 0.5");  // the window may still show the dialog
  const std::vector<float> before = greys();
  EXPECT_GT(std::set<float>(before.begin(), before.end()).size(), 30u) << "values of a cloud";
  session->hands(fmt::format("mousemove {} 160 click 1 sleep 0.3 mousemove 700 300 sleep 0.3", left + 100));
  EXPECT_NE(greys(), before) << "the other two slices go through the voxel that was clicked";
  session->hands("key l");
  EXPECT_EQ(save("again.png"), all);
  expectQuietEnd(*session);
}

}  // namespace freevoxels::test
