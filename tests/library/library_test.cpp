// The installed interface: closed forms, what frames share, submitted frames, errors.

#include <fmt/format.h>
#include <freevoxels/freevoxels.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "tests/library/expect_error.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

constexpr const char* kAlongZ =
    R"({"camera-position": [9.5, 9.5, 100], "look-at": [9.5, 9.5, 0], "up": [0, 1, 0], "orthographic": 20, "size": [40, 40]})";

const v1::Volume& cloud() {
  static const v1::Volume volume = v1::Volume::open("procedural:cloud", R"({"resolution": 32})");
  return volume;
}

TEST(Library, HomogeneousBoxIsTheLawOfBeerAndLambert) {
  const std::vector<float> ones(20 * 20 * 12, 1.0f);
  v1::Renderer renderer(v1::Volume::copy(ones, {20, 20, 12}, {.spacing = {1.0, 1.0, 2.0}}), kAlongZ);
  const v1::Image image = renderer.render(R"({"density-scale": 0.1, "unlit": true, "albedo": [0.8, 0.5, 0.2]})", {.depth = true});
  ASSERT_EQ(image.pixels.size(), 4u * 40u * 40u);
  ASSERT_EQ(image.depth.size(), 40u * 40u);
  const float* const middle = &image.pixels[4 * (20 + 40 * 20)];
  const double alpha = 1.0 - std::exp(-0.1 * 12 * 2);
  EXPECT_NEAR(middle[0], 0.8 * alpha, 2e-3);
  EXPECT_NEAR(middle[2], 0.2 * alpha, 2e-3);
  EXPECT_NEAR(middle[3], alpha, 2e-3);
  EXPECT_GT(image.depth[20 + 40 * 20], 100.0f - 23.0f);
  EXPECT_LT(image.depth[20 + 40 * 20], 100.0f);
}

TEST(Library, RaysEndAtTheDepthsOfAHoldout) {
  const std::vector<float> ones(20 * 20 * 12, 1.0f);
  v1::Renderer renderer(v1::Volume::copy(ones, {20, 20, 12}, {.spacing = {1.0, 1.0, 2.0}}), kAlongZ);
  const std::string scene = R"({"density-scale": 0.1, "unlit": true})";
  std::vector<float> depths(40 * 40, 100.0f - 23.0f + 10.0f);  // 10 behind the first face
  const v1::Image image = renderer.render(scene, {.holdout = {40, 40, depths}});
  EXPECT_NEAR(image.pixels[4 * (20 + 40 * 20) + 3], 1.0 - std::exp(-0.1 * 10), 2e-3);
  EXPECT_EQ(renderer.submit(scene, {.holdout = {40, 40, depths}}).image().pixels, image.pixels);
  EXPECT_NEAR(renderer.render(scene).pixels[4 * (20 + 40 * 20) + 3], 1.0 - std::exp(-0.1 * 24), 2e-3);
  expectRefused(v1::ErrorKind::Input, "40x39", [&] { renderer.render(scene, {.holdout = {40, 39, depths}}); });
  expectRefused(v1::ErrorKind::Usage, "holdout", [&] { renderer.render(R"({"size": 9})", {.holdout = {40, 40, depths}}); });
  depths[7] = -1.0f;
  expectRefused(v1::ErrorKind::Input, "pixel (7, 0)", [&] { renderer.render(scene, {.holdout = {40, 40, depths}}); });
}

TEST(Library, FramesOfOneRendererAreThoseOfSeparateOnes) {
  const std::string base = R"({"size": [48, 40], "density-scale": 20})";
  v1::Renderer shared(cloud(), base);
  for (const char* frame : {"{}", R"({"orbit": [90, 10]})", R"({"density-scale": 80})", R"({"draw": "splats"})", "{}"}) {
    v1::Renderer separate(cloud(), base);
    EXPECT_EQ(shared.render(frame).pixels, separate.render(frame).pixels) << frame;
  }
  EXPECT_FALSE(shared.timings().empty());
}

TEST(Library, DraftsFollowTheirBudgetToTheWholeImageAndToTheLeastQuality) {
  v1::Renderer renderer(cloud(), R"({"size": [96, 80], "density-scale": 20, "unlit": true})");
  const v1::Image whole = renderer.render();
  const v1::Image least = renderer.render(R"({"quality": 0.05})");
  ASSERT_EQ(least.pixels.size(), whole.pixels.size());
  EXPECT_NE(least.pixels, whole.pixels);
  EXPECT_EQ(renderer.render("{}", {.budget = 1e-6}).pixels, least.pixels) << "no time at all";
  std::vector<float> last;
  for (int i = 0; i < 40 && last != whole.pixels; ++i) last = renderer.submit("{}", {.budget = 1e9}).image().pixels;
  EXPECT_EQ(last, whole.pixels) << "all the time in the world";
  EXPECT_EQ(renderer.render().pixels, whole.pixels);
  for (const double none : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    expectRefused(v1::ErrorKind::Usage, "budget", [&] { renderer.render("{}", {.budget = none}); });
  expectRefused(v1::ErrorKind::Usage, "quality", [&] { renderer.render(R"({"quality": 0})"); });
}

/// Extinctions add up, whatever a volume is divided into.
TEST(Library, TwoHalvesOfAVolumeAreTheVolume) {
  const std::string half = R"({"volume": "procedural:cloud", "resolution": 24, "density-scale": 10})";
  const v1::Volume volume = v1::Volume::open("procedural:cloud", R"({"resolution": 24})");
  const std::string view = R"("size": [48, 40], "unlit": true)";
  const v1::Image whole = v1::Renderer(volume, "{" + view + R"(, "density-scale": 20})").render();
  v1::Renderer two(volume, "{" + view + R"(, "density-scale": 10, "volumes": [)" + half + "]}");
  const v1::Image halves = two.render();
  ASSERT_EQ(halves.pixels.size(), whole.pixels.size());
  for (std::size_t i = 0; i < whole.pixels.size(); ++i) ASSERT_NEAR(halves.pixels[i], whole.pixels[i], 0.03) << i;
  EXPECT_NE(v1::Renderer(volume, "{" + view + R"(, "density-scale": 10})").render().pixels, halves.pixels);
}

TEST(Library, CopiedVolumeKnowsWhatItHolds) {
  std::vector<float> values{1.0f, 2.0f, std::numeric_limits<float>::quiet_NaN(), 3.0f};
  const v1::Volume volume = v1::Volume::copy(values, {2, 1, 2});
  EXPECT_EQ(volume.dimensions(), (std::array{2, 1, 2}));
  EXPECT_EQ(volume.activeVoxels(), 3u);
  EXPECT_EQ(volume.range(), std::pair(1.0f, 3.0f));
}

TEST(Library, ThreadsMayDrawAtOnce) {
  std::vector<v1::Image> images(2);
  {
    std::vector<std::jthread> threads;
    for (v1::Image& image : images)
      threads.emplace_back([&image] { image = v1::Renderer(cloud(), R"({"size": [48, 40]})").render(); });
  }
  EXPECT_EQ(images[0].pixels, images[1].pixels);
  EXPECT_FALSE(images[0].pixels.empty());
}

TEST(Library, SavesWhatItDrew) {
  const test::TemporaryFolder folder;
  const v1::Image image = v1::Renderer(cloud(), R"({"size": [48, 40]})").render("{}", {.depth = true});
  v1::save(folder.path() / "a.png", image, R"({"background": [0.1, 0.2, 0.3]})");
  v1::save(folder.path() / "a.exr", image, R"({"float": true})");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "a.png"));
  EXPECT_GT(std::filesystem::file_size(folder.path() / "a.exr"), 0u);
}

TEST(Library, ScenesAreWrittenToFilesAndReadBack) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "scene.json";
  v1::saveScene(file, R"({"volume": "procedural:cloud", "resolution": 24, "camera": {"size": [48, 40], "fov": 20}, "fov": 30,
                          "output": {"background": [0.1, 0.2, 0.3]}})");
  const std::string scene = v1::loadScene(file);
  EXPECT_NE(scene.find(R"("fov": 30)"), std::string::npos) << scene;
  const v1::Image image = v1::Renderer(v1::Volume::open("", scene), scene).render();
  const v1::Volume same = v1::Volume::open("procedural:cloud", R"({"resolution": 24})");
  EXPECT_EQ(image.pixels, v1::Renderer(same, R"({"size": [48, 40], "fov": 30})").render().pixels);
  v1::save(folder.path() / "a.png", image, scene);

  EXPECT_TRUE(v1::sceneWarnings(file).empty());
  test::writeBytes(file, R"({"light": {"scattering-scale": 0.4}})");
  EXPECT_EQ(v1::loadScene(file).find("scattering-scale"), std::string::npos);
  ASSERT_EQ(v1::sceneWarnings(file).size(), 1u);
  EXPECT_NE(v1::sceneWarnings(file).front().find("scattering-scale"), std::string::npos);

  test::writeBytes(file, R"({"camera": {"fob": 3}})");
  expectError(v1::ErrorKind::Input, R"(no key "camera.fob"; did you mean "camera.fov"?)", [&] { v1::loadScene(file); });
  expectError(v1::ErrorKind::Usage, "there is no volume to open", [] { v1::Volume::open(""); }, {"volume"});
  expectError(v1::ErrorKind::Output, "there is no folder", [] { v1::saveScene("/none/s.json", "{}"); });
}

TEST(Library, AFramesKeysReplaceWhatTheyExcludeAndSectionsGiveWay) {
  v1::Renderer renderer(cloud(), R"({"camera": {"camera-position": [2, 1, 3], "size": [48, 40]}, "density-scale": 20})");
  v1::Renderer separate(cloud(), R"({"size": [48, 40], "density-scale": 20})");
  EXPECT_EQ(renderer.render(R"({"orbit": [90, 10]})").pixels, separate.render(R"({"orbit": [90, 10]})").pixels);
}

double distanceOf(const v1::Renderer& renderer) {
  const nlohmann::json camera = nlohmann::json::parse(renderer.camera());
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = camera["camera-position"][axis].get<double>() - camera["look-at"][axis].get<double>();
    sum += along * along;
  }
  return std::sqrt(sum);
}

TEST(Library, TheViewIsTheRenderersWhichOrbitsTurn) {
  const v1::Volume bar = v1::Volume::copy(std::vector<float>(40 * 9 * 6, 1.0f), {40, 9, 6});
  for (const char* own : {R"({"size": [48, 40]})", R"({"size": [40, 48], "orbit": [10, -20], "orthographic": 50})"}) {
    v1::Renderer renderer(bar, own);
    EXPECT_EQ(renderer.camera(), "{}");
    const std::vector<float> first = renderer.render().pixels;
    const std::string camera = renderer.camera();
    const double distance = distanceOf(renderer);
    for (const char* orbit : {R"({"orbit": [0, 0]})", R"({"orbit": [90, 10]})", R"({"orbit": [200, -80]})"}) {
      renderer.render(orbit);
      EXPECT_NEAR(distanceOf(renderer), distance, 1e-9 * distance) << orbit;
    }
    EXPECT_EQ(renderer.render(camera).pixels, first);
  }
}

TEST(Library, TurnsHaveOneDistanceAndTheirFramesAreNumbered) {
  v1::Renderer renderer(cloud(), R"({"size": [48, 40]})");
  std::vector<double> distances;
  for (int frame = 0; frame < 5; ++frame) {
    renderer.renderTurn(frame, 5);
    distances.push_back(distanceOf(renderer));
    EXPECT_NEAR(distances.back(), distances.front(), 1e-9 * distances.front());
  }
  for (const auto& [frame, frames] : {std::pair(-1, 5), std::pair(5, 5), std::pair(0, 0), std::pair(0, 1 << 30)})
    expectError(v1::ErrorKind::Usage, "is not one of", [&] { renderer.renderTurn(frame, frames); }, {"frames"});
}

TEST(Library, FramesOfAFlightAreThoseOfItsCamerasAndLights) {
  const std::string flight = R"({"size": [48, 40], "flight": {"keys": [
      {"time": 0, "camera-position": [1, 1, 2], "look-at": [0, 0, 0], "light": [{"direction": [1, 1, 1]}]},
      {"time": 2, "camera-position": [-1, 0, 2], "look-at": [0, 0, 0], "light": [{"direction": [-1, 1, 1]}]}]}})";
  v1::Renderer renderer(cloud(), flight), single(cloud(), R"({"size": [48, 40]})");
  const char* const frames[] = {R"({"camera-position": [1, 1, 2], "look-at": [0, 0, 0], "light": {"direction": [1, 1, 1]}})",
                                R"({"camera-position": [-1, 0, 2], "look-at": [0, 0, 0], "light": {"direction": [-1, 1, 1]}})"};
  for (const int frame : {1, 0}) EXPECT_EQ(renderer.renderTurn(frame, 2).pixels, single.render(frames[frame]).pixels) << frame;
  EXPECT_EQ(renderer.render().pixels, single.render(frames[0]).pixels) << "one frame shows the first key";
  EXPECT_EQ(single.render(flight).pixels, single.render(frames[0]).pixels) << "whose flight is the frame's own";
  EXPECT_EQ(renderer.render(R"({"orbit": [90, 10]})").pixels, single.render(R"({"orbit": [90, 10]})").pixels) << "in place of the flight";
  expectError(v1::ErrorKind::Usage, R"("orbit" and "flight" exclude each other)",
              [&] { renderer.render(R"({"orbit": [90, 10], "flight": "f.json"})"); }, {"orbit", "flight"});
  expectError(v1::ErrorKind::Input, "flight 'inline' has 0 keys", [&] { renderer.render(R"({"flight": {"keys": []}})"); });
}

TEST(Library, FramesOfATurnAreOfTheFlightThatTheFirstOfThemHasRead) {
  const test::TemporaryFolder folder;
  const auto flightTo = [](const char* end) {
    return fmt::format(R"({{"keys": [
        {{"time": 0, "camera-position": [1, 1, 2], "look-at": [0, 0, 0], "light": [{{"direction": [1, 1, 1]}}]}},
        {{"time": 2, "camera-position": {}, "look-at": [0, 0, 0], "light": [{{"direction": {}}}]}}]}})",
                       end, end);
  };
  const std::string first = flightTo("[-1, 0, 2]"), second = flightTo("[2, 1, -1]");
  const std::filesystem::path file = folder / "flight.json";
  const std::string scene = nlohmann::json{{"flight", file.string()}}.dump();
  v1::bake(cloud(), folder / "cloud.fvx");
  for (const v1::Volume& volume : {cloud(), v1::Volume::open(folder / "cloud.fvx")}) {
    v1::Renderer renderer(volume, R"({"size": [48, 40]})"), other(volume, R"({"size": [48, 40]})");
    const auto expectFrame = [&](int frame, const std::string& flight) {
      EXPECT_EQ(renderer.renderTurn(frame, 3, scene).pixels, other.renderTurn(frame, 3, R"({"flight": )" + flight + "}").pixels) << frame;
    };
    test::writeBytes(file, first);
    expectFrame(0, first);
    test::writeBytes(file, second);
    expectFrame(1, first);
    std::filesystem::remove(file);
    expectFrame(2, first);
    expectFrame(1, first);
    expectRefused(v1::ErrorKind::Input, "flight.json", [&] { renderer.renderTurn(1, 4, scene); });
    expectRefused(v1::ErrorKind::Input, "flight.json", [&] { renderer.renderTurn(0, 3, scene); });
    test::writeBytes(file, second);
    expectFrame(0, second);
    expectFrame(2, second);
  }
}

TEST(Library, ProgressOfAFrameNeverDecreasesAndEndsAtOne) {
  v1::Renderer renderer(cloud(), R"({"size": [600, 500]})");
  for (const char* scene : {"{}", R"({"draw": "splats"})", R"({"orbit": [3, 4]})"}) {
    double last = 0.0;
    const auto grows = [&](std::string_view, double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
    };
    renderer.render(scene, {.progress = grows});
    EXPECT_EQ(last, 1.0) << scene;
  }
}

TEST(Library, AForkedProcessIsToldThatItCannotDraw) {
  v1::Renderer renderer(cloud(), R"({"size": [16, 12]})");
  renderer.render();
  const pid_t child = fork();
  if (child == 0) {
    int told = 0;
    for (const bool isNew : {false, true}) try {
        isNew ? v1::Renderer(cloud()).render() : renderer.render();
      } catch (const v1::Error& error) {
        told += error.kind() == v1::ErrorKind::Device && std::string_view(error.what()).find("forked") != std::string_view::npos;
      }
    _exit(told);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

TEST(Library, KeysGivenTwiceAndSectionsThatAreNoObjectsAreRefused) {
  const auto make = [](const char* scene) { return [scene] { v1::Renderer(cloud(), scene); }; };
  expectError(v1::ErrorKind::Usage, "is given twice", make(R"({"light": "direction=1,1,1", "lights": ["direction=1,0,0"]})"), {"light"});
  expectError(v1::ErrorKind::Usage, "is given twice", make(R"({"density-scale": 1, "density_scale": 2})"), {"density-scale"});
  expectError(v1::ErrorKind::Usage, "is a group of options", make(R"({"camera": 5})"), {"camera"});
}

TEST(Library, ImagesThatAreNoNumbersAreNotSaved) {
  v1::Image image{.width = 3, .height = 2, .pixels = std::vector<float>(24, 0.5f)};
  image.pixels[4 * 5] = std::numeric_limits<float>::quiet_NaN();
  for (const char* name : {"none.png", "none.exr"})
    expectError(v1::ErrorKind::Input, "at row 1, column 2", [&] { v1::save(name, image); });
}

TEST(Library, ErrorsNameWhatIsWrong) {
  using enum v1::ErrorKind;
  const auto render = [](const char* scene) { return [scene] { v1::Renderer(cloud(), scene).render(); }; };
  expectError(Usage, R"("densty-scale"; did you mean "density-scale")", render(R"({"densty-scale": 1})"), {"densty-scale", "density-scale"});
  expectError(Usage, "a scene is a JSON object", render("[1, 2]"));
  const std::string deep = R"({"orbit": )" + std::string(100000, '[') + std::string(100000, ']') + "}";
  expectError(Usage, "nested at most 64 deep", render(deep.c_str()));
  expectError(Input, R"(/none/\x1b[31m\xff.vdb)", [] { v1::Volume::open("/none/\x1b[31m\xff.vdb"); });
  expectError(Usage, R"(not '[\x0a1]')", render("[\n1]"));
  expectError(Usage, R"("orbit" and "camera-position" exclude each other)", render(R"({"orbit": [1, 2], "camera-position": [1, 2, 3]})"),
              {"orbit", "camera-position"});
  expectError(Input, "scene 'inline' is not valid JSON: parse error at line 2, column 7", render("{\"size\":\n [8, 6}"));
  expectError(Input, "size", render(R"({"size": [8, 6], "size": [6, 8]})"));
  expectError(Usage, R"(no option "light.dir"; a single "light" has a "direction" or a "position")", render(R"({"light": {"dir": [1, 1, 1]}})"),
              {"light.dir", "light", "direction", "position"});
  expectError(Usage, R"("frames" is of turntables, and this is one frame)", render(R"({"frames": 3})"), {"frames", "orbit"});
  expectError(Usage, R"("share" is an option of the command line alone)", render(R"({"share": "0/2"})"), {"share"});
  expectError(Usage, "'s_##.vdb' is a sequence of volumes: draw it as a Sequence", [] { v1::Volume::open("s_##.vdb"); });
  EXPECT_EQ(v1::Renderer(cloud(), R"({"camera": {"frames": 3, "size": 8}})").render().width, 8) << "of a whole scene, a frame";
  expectError(Usage, R"("exposure" has no effect here)", render(R"({"exposure": 1})"), {"exposure"});
  expectError(Usage, R"(the camera stands at its look-at point; change "camera-position" or "look-at")",
              render(R"({"camera-position": [1, 2, 3], "look-at": [1, 2, 3]})"), {"camera-position", "look-at"});
  expectError(Usage, R"(or use "draw": "splats")", render(R"({"draw": "gather", "attenuation": "bilinear"})"),
              {"draw", "paper", "attenuation", "composite"});
  expectError(Input, R"("up" takes X,Y,Z)", render(R"({"up": true})"), {"up"});
  expectError(Usage, R"("fov" takes)", render(R"({"fov": "wide"})"), {"fov"});
  expectError(Device, R"(no device matches "device": "none such")", render(R"({"device": "none such"})"), {"device"});
  expectError(OutOfMemory, R"(use a smaller "size")", render(R"({"memory-limit": 1})"), {"size"});
  const v1::Volume large = v1::Volume::copy(std::vector<float>(80 * 80 * 80, 1.0f), {80, 80, 80});
  expectError(OutOfMemory, R"("memory-limit" is 1 MiB)", [&] { v1::Renderer(large, R"({"memory-limit": 1, "size": 16})").render(); },
              {"memory-limit"});
  expectError(Input, "there is no file '/none.vdb'", [] { v1::Volume::open("/none.vdb"); });
  const std::vector<float> values(8, 1.0f);
  expectError(Input, "8 values are not a box of 2 x 2 x 3 voxels", [&] { v1::Volume::copy(values, {2, 2, 3}); });
  // The product of these edges is 2^64, which is 0 in 64 bits.
  expectError(Input, "are not a box of", [&] { v1::Volume::copy(values, {1 << 22, 1 << 21, 1 << 21}); });
  expectError(Input, "spacing along each axis", [&] { v1::Volume::copy(values, {2, 2, 2}, {.spacing = {1.0, 0.0, 1.0}}); });
  expectError(Output, "there is no folder", [] { v1::save("/none/a.png", {.width = 1, .height = 1, .pixels = {0, 0, 0, 0}}); });
  expectError(Input, "needs 4 values", [] { v1::save("a.png", {.width = 2, .height = 1, .pixels = {0, 0, 0, 0}}); });
}

TEST(Library, SubmittedFramesAreTheRenderedOnes) {
  const v1::Context context;
  v1::Renderer renderer(context, v1::Volume::open(context, "procedural:cloud", R"({"resolution": 32})"), R"({"size": [48, 40]})");
  const v1::Frame first = renderer.submit(R"({"orbit": [90, 10]})"), second = renderer.submit("{}", {.depth = true});
  second.wait();
  EXPECT_TRUE(second.ready());
  EXPECT_TRUE(first.ready()) << "frames are drawn in the order of their submission";
  EXPECT_EQ(first.image().pixels, renderer.render(R"({"orbit": [90, 10]})").pixels);
  const v1::Image image = second.image(), expected = renderer.render("{}", {.depth = true});
  EXPECT_EQ(image.pixels, expected.pixels);
  EXPECT_EQ(image.depth, expected.depth);
}

TEST(Library, SubmittedFramesThrowWhenTheyAreWaitedFor) {
  v1::Renderer renderer(cloud(), R"({"memory-limit": 1, "size": [48, 40]})");
  expectError(v1::ErrorKind::Usage, "did you mean", [&] { renderer.submit(R"({"fob": 3})"); }, {"fob", "fov"});
  const v1::Frame frame = renderer.submit(R"({"size": [400, 400]})");
  for (int again = 0; again < 2; ++again)
    expectError(v1::ErrorKind::OutOfMemory, R"(use a smaller "size")", [&] { frame.wait(); }, {"size"});
}

/// A frame that takes some seconds unless it is cancelled.
constexpr const char* kLong = R"({"draw": "splats", "size": [2000, 2000]})";

TEST(Library, CancelledFramesEndSoonAndLeaveTheRendererUsable) {
  v1::Renderer renderer(v1::Volume::open("procedural:cloud", R"({"resolution": 64})"));
  v1::Frame current = renderer.submit(kLong), queued = renderer.submit(kLong);
  const v1::Frame last = renderer.submit(R"({"size": [40, 40]})");
  queued.cancel();
  current.cancel();
  expectError(v1::ErrorKind::Cancelled, "was cancelled", [&] { current.wait(); });
  expectError(v1::ErrorKind::Cancelled, "was cancelled", [&] { queued.image(); });
  EXPECT_EQ(last.image().pixels, renderer.render(R"({"size": [40, 40]})").pixels);
}

TEST(Library, ObjectsMayBeDestroyedInAnyOrder) {
  std::optional<v1::Context> context(std::in_place);
  std::optional<v1::Renderer> renderer(std::in_place, *context, cloud(), R"({"size": [48, 40]})");
  context.reset();
  const v1::Frame complete = renderer->submit();
  complete.wait();
  const v1::Frame abandoned = renderer->submit(kLong);
  renderer.reset();
  expectError(v1::ErrorKind::Cancelled, "was cancelled", [&] { abandoned.wait(); });
  EXPECT_EQ(complete.image().width, 48);
}

TEST(Library, AContextTakesTheChoiceOfTheDeviceFromScenes) {
  const v1::Context context;
  expectError(v1::ErrorKind::Usage, R"("device" has no effect here)", [&] { v1::Renderer(context, cloud(), R"({"device": "llvmpipe"})"); },
              {"device"});
  expectError(v1::ErrorKind::Device, R"("device": "none such")", [] { v1::Context(v1::ContextOptions{.device = "none such"}); }, {"device"});
}

TEST(Library, RemarksSayWhatIsAssumed) {
  constexpr std::array<int, 3> kSize{22, 19, 9};
  std::vector<float> values;
  for (int z = 0; z < kSize[2]; ++z)
    for (int y = 0; y < kSize[1]; ++y)
      for (int x = 0; x < kSize[0]; ++x) {
        const double distance = std::hypot(2.0 * x / kSize[0] - 1.0, 2.0 * y / kSize[1] - 1.0);
        values.push_back(distance > 0.9 ? -9999.0f : float(distance < 0.5 ? 900 : 10) + float((7 * x + 13 * y + 29 * z) % 83));
      }
  const v1::Volume volume = v1::Volume::copy(values, kSize);
  EXPECT_NE(volume.remarks().find("-9999"), std::string::npos) << volume.remarks();
  EXPECT_NE(volume.remarks().find("no-data"), std::string::npos) << volume.remarks();
  EXPECT_EQ(volume.range().first, 10.0f);
  EXPECT_EQ(cloud().remarks(), "");
}

TEST(Library, VolumesSayWhatIsRemarkableAboutThem) {
  std::vector<float> values(8, 1.0f);
  values[3] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(cloud().warnings().empty());
  const std::vector<std::string> warnings = v1::Volume::copy(values, {2, 2, 2}).warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("1 voxel"), std::string::npos) << warnings[0];
}

TEST(Library, TheVersionIsThatOfTheHeaders) {
  EXPECT_EQ(v1::version(), fmt::format("{}.{}.{}", FREEVOXELS_VERSION_MAJOR, FREEVOXELS_VERSION_MINOR, FREEVOXELS_VERSION_PATCH));
  EXPECT_EQ(FREEVOXELS_VERSION, 10000 * FREEVOXELS_VERSION_MAJOR + 100 * FREEVOXELS_VERSION_MINOR + FREEVOXELS_VERSION_PATCH);
}

TEST(Library, AnExceptionOfProgressReachesTheCaller) {
  struct Stopped {};
  v1::Renderer renderer(v1::Volume::open("procedural:cloud", R"({"resolution": 64})"), R"({"draw": "splats", "size": [900, 900]})");
  EXPECT_THROW(renderer.render("{}", {.progress = [](std::string_view, double) { throw Stopped{}; }}), Stopped);
  EXPECT_EQ(renderer.render(R"({"size": [40, 40]})").width, 40);
}

}  // namespace
}  // namespace freevoxels
