// The window of freevoxels-view: what it shows, opens, saves and how it ends.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "engine/image/srgb.h"
#include "tests/commands/viewer_fixture.h"

namespace freevoxels::test {

namespace {

/// Pixels of the window's image that are not those of the file, up to so many of 255 `levels`, except where something is drawn over them.
int differingPixels(const Image& window, const Image& image, int levels) {
  const auto equal = [&](const glm::vec4& a, const glm::vec4& b) {
    for (int c = 0; c < 3; ++c)
      if (std::abs(int(srgbByteFromLinear(a[c])) - int(srgbByteFromLinear(b[c]))) > levels) return false;
    return true;
  };
  int different = 0;
  for (int y = 0; y < image.size.y; ++y)
    for (int x = 0; x < image.size.x; ++x) {
      if (isCovered({x, y}, image.size)) continue;
      const int place = x + window.size.x - image.size.x + (y + kBar) * window.size.x;
      different += !equal(window.pixels[std::size_t(place)], image.pixels[std::size_t(y * image.size.x + x)]);
    }
  return different;
}

/// How long the window takes to close: 0.3 s where nothing else runs.
double secondsToQuit(ViewerSession& session) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(session.quit().exitCode, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

class ViewerImage : public Viewer {
 protected:
  /// `ofRender`, `ofWindow`: more options of one of the two. With a tone map, of which the former are, pixels may be off by one level.
  void expectWindowOfRender(const std::string& more, const std::string& ofRender = "", const std::string& ofWindow = "") {
    const std::string options = " --resolution 32 --orbit 200,15 --background 0.1,0.2,0.3" + more;
    const ProgramResult shown = view("procedural:cloud --screenshot @window.png" + options + ofWindow);
    EXPECT_EQ(shown.exitCode, 0);
    EXPECT_EQ(shown.err, "");
    const std::string size = fmt::format(" --size {}x{}", kWindow.x - kPanel, kWindow.y - 2 * kBar);
    expectSuccess(run("render procedural:cloud @image.png --quiet" + options + ofRender + size));
    const Image window = readPng(folder / "window.png"), drawn = readPng(folder / "image.png");
    ASSERT_EQ(window.size, kWindow);
    EXPECT_EQ(differingPixels(window, drawn, ofRender.empty() ? 0 : 1), 0);
    EXPECT_NE(drawn.pixels[std::size_t(400 * drawn.size.x + 470)], drawn.pixels.front());
    EXPECT_FALSE(std::filesystem::exists(folder / "freevoxels")) << "a screenshot remembers no file";
  }
};

/// Of one volume, of several, and of several in a scene file.
TEST_F(ViewerImage, TheWindowShowsTheImageOfRender) {
  writeBytes(folder / "two.json", R"({"volumes": [{"volume": "procedural:cube", "resolution": 9, "density-scale": 2}]})");
  for (const char* more : {" --light direction=1,1,0", " --unlit --add procedural:fire,resolution=16,transform=0.2,0,0 --tone-map none",
                           " --unlit --scene @two.json"}) {
    SCOPED_TRACE(more);
    expectWindowOfRender(more);
  }
}

TEST_F(ViewerImage, BrightLightIsToneMappedWhereNothingElseIsSaid) {
  for (const char* more :
       {" --light direction=1,1,0 --light direction=0,1,1", " --unlit --add procedural:fire,resolution=16,transform=0.2,0,0"}) {
    SCOPED_TRACE(more);
    expectWindowOfRender(more, " --tone-map filmic");
  }
}

TEST_F(ViewerImage, OneDeviceMayMakeTheImagesAndAnotherShowThem) {
  expectWindowOfRender("", "", " --show-on 0");
}

TEST_F(Viewer, ATryOfPresentationSaysWhetherTheDisplayCan) {
  const ProgramResult tried = view("--try-presentation --device 0");
  EXPECT_EQ(tried.exitCode, 0);
  EXPECT_EQ(tried.out + tried.err, "");
  EXPECT_NE(view("--try-presentation --device nonsense").exitCode, 0);
  setenv("DISPLAY", ":no-such-display", 1);
  EXPECT_NE(view("--try-presentation").exitCode, 0);
}

TEST_F(Viewer, AFlightBeginsAtItsFirstKeyAndIsAFileThatIsOpened) {
  const std::string keys = R"({"keys": [{"time": 0, "camera-position": [1, 2, 3], "look-at": [0, 0, 0]},
                                        {"time": 4, "camera-position": [-1, 2, 3], "look-at": [0, 0.1, 0]}]})";
  writeBytes(folder / "flight.json", keys);
  const auto session = use("procedural:cloud --resolution 24 --flight @flight.json");
  const nlohmann::json scene = sceneOf(*session, "a.json");
  EXPECT_EQ(vectorOf(scene, "camera-position"), glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_FALSE(scene.at("camera").contains("flight")) << "it is the image's scene";
  session->open("flight.json");
  EXPECT_EQ(sceneOf(*session, "b.json"), scene) << "the camera stays until the flight is played";
  expectQuietEnd(*session);
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
