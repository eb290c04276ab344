// freevoxels-view: its window on a display of the tests' own, used as a person does.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/image/image.h"
#include "engine/image/srgb.h"
#include "tests/commands/viewer_runner.h"

namespace freevoxels::test {

namespace {

// Pixels of the window that are not the image's: at its left, and above and below it.
constexpr int kPanel = 340, kBar = 21;
// Those of the image that have something drawn over them: the axes at the lower left, the scale bar at the lower right.
constexpr glm::ivec2 kAxes{100, 100}, kScaleBar{240, 60};
constexpr glm::ivec2 kWindow{1280, 800};

class Viewer : public CommandTest {
 protected:
  void SetUp() override {
    if (!installedProgram("Xvfb") || !installedProgram("xdotool"))
      GTEST_SKIP() << "Xvfb and xdotool are not installed: no window can be opened and used here";
    setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
    display.emplace();
  }
  ProgramResult view(const std::string& text) const {
    return runProgramFile(FREEVOXELS_VIEW_PROGRAM, words(text));
  }
  std::unique_ptr<ViewerSession> use(const std::string& text) const {
    return std::make_unique<ViewerSession>(folder.path(), words(text));
  }
  static void expectQuietEnd(ViewerSession& session) {
    const ProgramResult result = session.quit();
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
  }
  static nlohmann::json sceneOf(const ViewerSession& session, const std::string& name) {
    return nlohmann::json::parse(session.save('e', name));
  }
  static glm::dvec3 vectorOf(const nlohmann::json& scene, const char* key) {
    const auto& value = scene.at("camera").at(key);
    return {value.at(0), value.at(1), value.at(2)};
  }
  static glm::dvec3 armOf(const nlohmann::json& scene) {
    return vectorOf(scene, "camera-position") - vectorOf(scene, "look-at");
  }

  std::optional<Display> display;
};

bool isCovered(glm::ivec2 pixel, glm::ivec2 size) {
  const glm::ivec2 fromRight = size - pixel;
  return (pixel.x < kAxes.x && fromRight.y <= kAxes.y) || (fromRight.x <= kScaleBar.x && fromRight.y <= kScaleBar.y);
}

/// Pixels of the window's image that are not those of the file, except where something is drawn over them.
int differingPixels(const Image& window, const Image& image) {
  int different = 0;
  for (int y = 0; y < image.size.y; ++y)
    for (int x = 0; x < image.size.x; ++x) {
      if (isCovered({x, y}, image.size)) continue;
      const int place = x + window.size.x - image.size.x + (y + kBar) * window.size.x;
      different += window.pixels[std::size_t(place)] != image.pixels[std::size_t(y * image.size.x + x)];
    }
  return different;
}

}  // namespace

TEST_F(Viewer, TheWindowShowsTheImageOfRender) {
  const std::string options =
      " --resolution 32 --orbit 200,15 --background 0.1,0.2,0.3 --light direction=1,1,0";
  const ProgramResult shown = view("procedural:cloud --screenshot @window.png" + options);
  EXPECT_EQ(shown.exitCode, 0);
  EXPECT_EQ(shown.err, "");
  const std::string size = fmt::format(" --size {}x{}", kWindow.x - kPanel, kWindow.y - 2 * kBar);
  expectSuccess(run("render procedural:cloud @image.png --quiet" + options + size));
  const Image window = readPng(folder / "window.png"), drawn = readPng(folder / "image.png");
  ASSERT_EQ(window.size, kWindow);
  EXPECT_EQ(differingPixels(window, drawn), 0);
  EXPECT_NE(drawn.pixels[std::size_t(400 * drawn.size.x + 470)], drawn.pixels.front());
  EXPECT_EQ(folder.fileCount(), 2u) << "a screenshot remembers no file";
}

TEST_F(Viewer, WhatIsTakenAwayIsWhatTheProgramsMake) {
  const auto session = use("procedural:cloud --resolution 32 --frames 3 --background 0.1,0.2,0.3 --clip-box 3,0,0,99,18,99");
  session->hands("windowsize @ 560 240");
  const std::string before = session->save('s', "before.png");
  session->hands("mousemove 440 100 mousedown 1 mousemove 470 120 mouseup 1");
  const std::string png = session->save('s', "a.png"), exr = session->save('s', "a.exr");
  const std::string scene = session->save('e', "a.json");
  EXPECT_NE(before, png) << "the drag has turned it";
  session->saveAll('t', "turn_#.exr", "turn_2.exr");
  session->save('s', "after.png");
  expectQuietEnd(*session);

  std::string command = exrAttribute(exr, "freevoxels:command");
  ASSERT_TRUE(command.starts_with("freevoxels render ")) << command;
  command.erase(0, std::string("freevoxels ").size());
  EXPECT_EQ(command.find("--background"), std::string::npos) << "an .exr has none";
  command.replace(command.find("image.exr"), std::string("image.exr").size(), "@b.exr");
  expectSuccess(run(command + " @b.png --background 0.1,0.2,0.3 --save-scene @b.json --quiet"));
  EXPECT_TRUE(png == readBytes(folder / "b.png"));
  EXPECT_EQ(scene, readBytes(folder / "b.json"));
  expectSuccess(run("render --scene @a.json @c.exr --quiet"));
  EXPECT_TRUE(exr == readBytes(folder / "c.exr"));

  expectSuccess(run("turntable --scene @a.json @again_#.exr --frames 3 --quiet"));
  for (const char frame : {'0', '1', '2'})
    EXPECT_TRUE(readBytes(folder / (std::string("turn_") + frame + ".exr")) ==
                readBytes(folder / (std::string("again_") + frame + ".exr")))
        << frame;
}

TEST_F(Viewer, HandsMoveTheCamera) {
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 440 142");  // the image is 100 pixels high
  const nlohmann::json first = sceneOf(*session, "0.json");
  session->hands("mousemove 400 60 click 4");
  const nlohmann::json nearer = sceneOf(*session, "1.json");
  EXPECT_LT(glm::distance(armOf(nearer), 0.9 * armOf(first)), 1e-9);
  session->hands("mousemove 400 60 mousedown 1 mousemove 410 60 mouseup 1");
  const glm::dvec3 arm = armOf(sceneOf(*session, "2.json")), was = armOf(nearer);
  EXPECT_NEAR(glm::length(arm), glm::length(was), 1e-9);
  EXPECT_NEAR(arm.y, was.y, 1e-9);
  EXPECT_NEAR(was.z * arm.x - was.x * arm.z, -std::sin(0.1 * M_PI) * (was.x * was.x + was.z * was.z), 1e-9)
      << "a tenth of the height is a tenth of half a turn";
  for (int i = 0; i < 5; ++i) session->hands(fmt::format("mousemove {} 60 click 1", 390 + 7 * i));
  const nlohmann::json clicked = sceneOf(*session, "clicked.json");
  EXPECT_EQ(armOf(clicked), arm) << "a motion before a press turns nothing";
  session->hands("keydown ctrl keydown w keyup ctrl sleep 0.1 keyup w");
  EXPECT_EQ(sceneOf(*session, "shortcut.json").at("camera"), clicked.at("camera")) << "what is left of a shortcut flies nowhere";
  session->hands("keydown w sleep 0.1 keyup w");
  EXPECT_NE(vectorOf(sceneOf(*session, "flown.json"), "look-at"), vectorOf(clicked, "look-at"));
  for (int axis = 0; axis < 6; ++axis) {
    session->hands("key " + std::to_string(axis + 1));
    glm::dvec3 side(0.0);
    side[axis / 2] = axis % 2 == 0 ? glm::length(was) : -glm::length(was);
    EXPECT_LT(glm::distance(armOf(sceneOf(*session, fmt::format("axis{}.json", axis))), side), 1e-9) << axis;
  }
  session->hands("key o");
  EXPECT_TRUE(sceneOf(*session, "flat.json").at("camera").contains("orthographic"));
  session->hands("key o key f");
  const nlohmann::json framed = sceneOf(*session, "framed.json");
  const auto& size = framed.at("camera").at("size");
  expectSuccess(run(
      "render procedural:cloud @r.png --resolution 16 --quiet --orbit 180,0 --save-scene @r.json --size " +
      size.at(0).dump() + "x" + size.at(1).dump()));
  const nlohmann::json expected = nlohmann::json::parse(readBytes(folder / "r.json"));
  EXPECT_LT(glm::distance(armOf(framed), armOf(expected)), 1e-9) << "from where the last key looked";
  expectQuietEnd(*session);
}

TEST_F(Viewer, AWindowMayChangeAndGoAway) {
  const auto session = use("procedural:cloud --resolution 32");
  for (const char* size : {"900 700", "400 300", "30 30", "1 1", "341 200", "1300 100"})
    session->hands(std::string("windowsize @ ") + size);
  session->hands("windowminimize @");
  session->hands("windowunmap @");
  session->hands("windowsize @ 600 300");
  session->hands("windowmap @ mousemove 400 100");
  session->hands("windowsize --sync @ 500 200");
  session->save('s', "a.png");
  EXPECT_EQ(readPng(folder / "a.png").size.y, 200 - 2 * kBar);
  session->hands("windowsize --sync @ 640 480");
  session->hands("key w");  // begins another image
  expectQuietEnd(*session);
}

TEST_F(Viewer, BadFilesAreSaidAndTheWindowStays) {
  writeBytes(folder / "bad.vdb", "this is no volume");
  expectSuccess(run("generate cube @good.vdb --resolution 16 --quiet"));
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 600 200");
  session->save('s', "a.png");
  session->open("none.vdb");
  session->hands("key Escape");  // the dialog says why and stays
  session->open("bad.vdb");
  session->hands("mousemove 500 100 click 4 key 3");
  session->open("good.vdb");
  EXPECT_EQ(sceneOf(*session, "b.json").at("input").at("volume"), "good.vdb");
  expectQuietEnd(*session);

  const ProgramResult refused = view("@bad.vdb --screenshot @w.png");
  EXPECT_EQ(refused.exitCode, int(ExitCode::Input));
  EXPECT_NE(refused.err.find("bad.vdb"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "w.png"));
}

TEST_F(Viewer, ASequenceGoesFromFrameToFrame) {
  expectSuccess(run("generate cloud @s_1.vdb --resolution 16 --quiet"));
  expectSuccess(run("generate plume @s_3.vdb --resolution 16 --quiet"));
  writeBytes(folder / "s_2.vdb", "this is no volume");
  const auto session = use("@s_#.vdb");
  session->hands("windowsize @ 600 200");
  const nlohmann::json first = sceneOf(*session, "1.json");
  EXPECT_EQ(first.at("input").at("volume"), "s_1.vdb");
  session->hands("mousemove 500 100 key period key period");  // over one that cannot be read
  const nlohmann::json third = sceneOf(*session, "3.json");
  EXPECT_EQ(third.at("input").at("volume"), "s_3.vdb");
  EXPECT_EQ(third.at("camera"), first.at("camera"));
  EXPECT_EQ(third.at("classification"), first.at("classification")) << "no frame is lit as another is not";
  expectSuccess(run("generate cube @s_2.vdb --resolution 16 --quiet"));  // nothing is saved of a bad one
  std::set<std::string> seen;
  for (int i = 0; i < 30 && seen.size() < 2; ++i) {
    // Plays for another time each round: after equal times it may stop at the same of the three frames.
    session->hands(fmt::format("key space sleep {}", 0.1 + 0.03 * (i % 5)));
    const nlohmann::json frame = sceneOf(*session, fmt::format("played{}.json", i));
    seen.insert(frame.at("input").at("volume"));
  }
  EXPECT_EQ(seen.size(), 2u) << "it plays, and a scene is of the frame that is seen then";
  session->hands("key space key comma key comma");
  expectQuietEnd(*session);
}

TEST_F(Viewer, ATurnIsGivenUp) {
  const auto session = use("procedural:cloud --resolution 32 --frames 999");
  session->hands("windowsize @ 600 200");
  session->saveAll('t', "turn_###.png", "turn_002.png");
  session->hands("mousemove 500 100 key Escape");
  session->save('s', "after.png");  // comes after what is being written
  EXPECT_FALSE(std::filesystem::exists(folder / "turn_998.png"));
  int frames = 0;
  while (std::filesystem::exists(folder / fmt::format("turn_{:03}.png", frames))) {
    EXPECT_EQ(readPng(folder / fmt::format("turn_{:03}.png", frames)).size.y, 200 - 2 * kBar);
    ++frames;
  }
  EXPECT_EQ(int(folder.fileCount()), frames + 3) << "the image, what it said, its state, and no part of a frame";
  expectQuietEnd(*session);
}

TEST_F(Viewer, EditsAreUndoneAndTheLastSceneComesBack) {
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
    session->hands("key ctrl+z");
    EXPECT_EQ(sceneOf(*session, "undone.json"), right);
    session->hands("key ctrl+z");
    EXPECT_EQ(vectorOf(sceneOf(*session, "undone2.json"), "camera-position"), vectorOf(first, "camera-position"));
    session->hands("key ctrl+y");
    last = sceneOf(*session, "redone.json");
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

TEST_F(Viewer, TheImageIsCopiedByTheClipboardsProgram) {
  std::filesystem::create_directory(folder / "programs");
  const std::filesystem::path program = folder / "programs/xclip";
  writeBytes(program, "#!/bin/sh\ncat > part && mv part copied.png\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (program.parent_path().string() + ":" + path).c_str(), 1);
  const auto session = use("procedural:cloud --resolution 16");
  setenv("PATH", path.c_str(), 1);
  session->hands("windowsize @ 600 200");
  const std::string saved = session->save('s', "a.png");
  session->hands("key ctrl+c");
  session->save('e', "after.json");  // comes after the copy
  EXPECT_TRUE(readBytes(folder / "copied.png") == saved);
  expectQuietEnd(*session);
}

TEST_F(Viewer, AFolderIsGoneThroughToAFile) {
  std::filesystem::create_directories(folder / "below/deeper");
  expectSuccess(run("generate cube @below/deeper/good.vdb --resolution 16 --quiet"));
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 900 600");
  session->save('s', "a.png");
  session->open("below");
  session->hands("type --delay 1 deeper");
  session->hands("key Return");
  session->hands("type --delay 1 good.vdb");
  session->hands("key Return mousemove 700 300");
  session->saveAll('e', "b.json", "below/deeper/b.json");  // the dialog stays in the folder
  const nlohmann::json scene = nlohmann::json::parse(readBytes(folder / "below/deeper/b.json"));
  EXPECT_EQ(scene.at("input").at("volume"), "good.vdb");
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
  session->hands("mousemove 228 385 mousedown 1 mousemove 240 385 mousemove 262 385 mouseup 1 mousemove 700 300");
  EXPECT_NE(session->save('s', "brighter.png"), before);
  EXPECT_GT(sceneOf(*session, "brighter.json").at("output").at("exposure"), 0.5);
  EXPECT_EQ(wholeImages(), drawn);

  session->hands("mousemove 143 151 click 1 mousemove 700 300");  // the box that clips
  EXPECT_EQ(sceneOf(*session, "clipped.json").at("input").at("clip-box").size(), 6u);
  session->hands("key ctrl+z");
  EXPECT_FALSE(sceneOf(*session, "unclipped.json").at("input").contains("clip-box"));

  session->open("tf.json");
  const std::string function = sceneOf(*session, "function.json").at("classification").at("transfer-function").dump();
  session->hands("mousemove 700 300 mousedown 3 mousemove 760 300 mousemove 640 340 mouseup 3");
  const nlohmann::json windowed = sceneOf(*session, "windowed.json");
  EXPECT_NE(windowed.at("classification").at("transfer-function").dump(), function);

  session->hands("mousemove 337 600 mousedown 1 mousemove 420 600 mousemove 440 600 mouseup 1 mousemove 700 300");
  session->save('s', "narrow.png");
  EXPECT_NEAR(readPng(folder / "narrow.png").size.x, kWindow.x - 443, 4) << "the panel's border is dragged";
  EXPECT_EQ(session->quit().exitCode, 0);
}

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

TEST_F(Viewer, TwoWindowsAreUsedSideBySide) {
  const auto cloud = use("procedural:cloud --resolution 16"), cube = use("procedural:cube --resolution 16");
  cloud->hands("windowsize --sync @ 700 400");
  cube->hands("windowsize --sync @ 700 400 windowmove --sync @ 0 450");
  const auto volume = [&](const ViewerSession& session, const char* mouse, const char* name) {
    session.hands(std::string("windowfocus --sync @ mousemove ") + mouse);
    return sceneOf(session, name).at("input").at("volume").get<std::string>();
  };
  EXPECT_EQ(volume(*cloud, "500 100", "1.json"), "procedural:cloud");
  EXPECT_EQ(volume(*cube, "500 550", "2.json"), "procedural:cube");
  EXPECT_EQ(volume(*cloud, "500 100", "3.json"), "procedural:cloud");
  cube->hands("windowfocus --sync @ mousemove 500 550");
  expectQuietEnd(*cube);
  EXPECT_EQ(volume(*cloud, "500 100", "4.json"), "procedural:cloud") << "the other one goes on";
  expectQuietEnd(*cloud);
}

/// How long the window takes to close: 0.3 s where nothing else runs.
double secondsToQuit(ViewerSession& session) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(session.quit().exitCode, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST_F(Viewer, ItEndsAtOnceWhileItDraws) {
  const auto session = use("procedural:cloud --resolution 256");  // takes seconds to compute, which nothing interrupts
  session->hands("sleep 0.5 mousemove 700 300 mousedown 1 mousemove 760 330");
  EXPECT_LT(secondsToQuit(*session), 3.0);
}

TEST_F(Viewer, ItEndsAtOnceWhileItExports) {
  const auto session = use("procedural:cloud --resolution 64 --frames 99");
  session->saveAll('t', "turn_##.png", "turn_01.png");
  EXPECT_LT(secondsToQuit(*session), 3.0);
  EXPECT_FALSE(std::filesystem::exists(folder / "turn_98.png"));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().extension() != ".png") continue;
    EXPECT_EQ(readPng(entry.path()).size.y, kWindow.y - 2 * kBar) << "a whole image";
  }
}

TEST_F(Viewer, WithoutADisplayItSaysSo) {
  display.reset();
  unsetenv("WAYLAND_DISPLAY");
  const ProgramResult refused = view("procedural:cloud");
  EXPECT_EQ(refused.exitCode, int(ExitCode::Device));
  EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  EXPECT_NE(refused.err.find("'freevoxels render' draws without a display"), std::string::npos)
      << refused.err;
}

}  // namespace freevoxels::test
