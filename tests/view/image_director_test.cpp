#include "apps/view/image_director.h"

#include <chrono>
#include <thread>
#include <vector>

#include "apps/view/navigation.h"
#include "engine/image/metrics.h"
#include "engine/splatting/frame_targets.h"
#include "engine/volume/openvdb_trees.h"
#include "tests/device/device_fixture.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

class ImageDirectorTest : public DeviceTest {
 protected:
  ImageDirectorTest() {
    state.scene.input = {.volume = "procedural:cube", .grid = std::nullopt, .resolution = glm::ivec3(150)};
    state.scene.lighting.unlit = true;
  }
  /// Asks and takes until the image is complete; returns what was shown on the way.
  std::vector<ImageRequest> follow() {
    std::vector<ImageRequest> shown;
    std::exception_ptr failure;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    do {
      director.ask(state, {64, 48}, false);
      if (director.take(state, failure)) shown.push_back(state.latest->request);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    } while (!director.isComplete(state) && !failure && std::chrono::steady_clock::now() < end);
    EXPECT_FALSE(failure) << state.problem;
    EXPECT_TRUE(director.isComplete(state));
    return shown;
  }

  /// Asks and takes until `isDone`; false if that takes too long.
  template <typename Done>
  static bool askUntil(ImageDirector& asked, ViewState& of, const Done& isDone) {
    std::exception_ptr failure;
    for (int i = 0; i < 20'000 && !isDone(); ++i) {
      asked.ask(of, {64, 48}, false);
      asked.take(of, failure);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return isDone();
  }

  ViewState state;
  ImageDirector director{device(), false};
};

TEST_F(ImageDirectorTest, RefinesInStepsAndMovesWithAllVoxels) {
  const std::vector<ImageRequest> first = follow();
  ASSERT_EQ(first.size(), 3u);
  EXPECT_EQ(first[0].purpose, Purpose::Edit);
  EXPECT_EQ(first[1].purpose, Purpose::Refine);
  EXPECT_EQ(first[1].voxelsAlongEdge, 2 * first[0].voxelsAlongEdge);
  EXPECT_EQ(first[1].scene.camera.size, glm::ivec2(64, 48)) << "in full size";
  EXPECT_EQ(first[2].purpose, Purpose::Whole);

  state.setCamera(orbited(*state.camera, state.pole, {0.1, 0.0}));
  const std::vector<ImageRequest> moved = follow();
  ASSERT_FALSE(moved.empty());
  for (const ImageRequest& request : moved) EXPECT_EQ(request.voxelsAlongEdge, kAllVoxels);
  EXPECT_EQ(moved.back().purpose, Purpose::Whole);
  EXPECT_EQ(state.whole->scene.camera.position, state.camera->position);
  EXPECT_EQ(moved.back().revision, moved.front().revision) << "nothing else is resolved again";
}

TEST_F(ImageDirectorTest, EditsOfATransferFunctionAreDrawnWithAllVoxels) {
  state.scene.input = {.volume = "procedural:head", .grid = std::nullopt, .resolution = glm::ivec3(100)};
  state.scene.lighting.unlit = false;
  state.scene.classification.transferFunction = "skin-and-bone";
  follow();
  const auto edit = [&] {
    state.changed = true;
    return follow();
  };
  state.scene.classification.window = ValueWindow{.low = 0.3, .high = 0.8};
  const std::vector<ImageRequest> edited = edit();
  ASSERT_GE(edited.size(), 2u);
  for (const ImageRequest& request : edited) EXPECT_EQ(request.voxelsAlongEdge, kAllVoxels);
  EXPECT_EQ(edited.front().purpose, Purpose::Classify);
  EXPECT_EQ(edited.back().purpose, Purpose::Whole);
  const Image after = downloadImage(device(), *state.whole->image);

  ImageDirector another(device(), true);
  ViewState same = state;
  same.changed = true;
  same.whole = same.latest = nullptr;
  ASSERT_TRUE(askUntil(another, same, [&] { return another.isComplete(same); }));
  EXPECT_EQ(after.pixels, downloadImage(device(), *same.whole->image).pixels) << "as of a volume that was opened with this function";

  state.scene.classification.order = ClassificationOrder::Pre;
  EXPECT_EQ(edit().front().purpose, Purpose::Edit) << "what is made of the voxels is other than before";
  state.scene.classification.opacity = 0.5;
  EXPECT_EQ(edit().front().purpose, Purpose::Edit) << "voxels are classified before interpolation";
}

/// The first time of the volume that is shown, whose rays are clipped; then of one that is kept beside what is left of it.
TEST_F(ImageDirectorTest, PlanesAndBoxesAreMovedWithAllVoxels) {
  state.scene.input = {.volume = "procedural:head", .grid = std::nullopt, .resolution = glm::ivec3(100)};
  state.scene.lighting.unlit = false;
  state.scene.classification.transferFunction = "skin-and-bone";
  follow();
  const auto clip = [&](double offset) {
    state.clip({}, ClipPlane{.point = glm::dvec3(offset), .normal = {1.0, 0.5, 0.2}});
    return follow();
  };
  for (const double offset : {0.0, 0.1, 0.05}) {
    const std::vector<ImageRequest> shown = clip(offset);
    ASSERT_GE(shown.size(), 2u);
    EXPECT_EQ(shown.front().purpose, Purpose::Clip) << offset;
    EXPECT_EQ(shown.front().voxelsAlongEdge, kAllVoxels);
    EXPECT_EQ(shown.back().purpose, Purpose::Whole);
    // Gets the whole volume ready for the next plane, without an image that is shown.
    const std::shared_ptr<const DrawnImage> latest = state.latest;
    ASSERT_TRUE(askUntil(director, state, [&] { return director.isReadyToClip(state.scene); }));
    EXPECT_EQ(state.latest, latest);
  }
  state.comparison = 1;
  EXPECT_NE(clip(0.06).front().purpose, Purpose::Clip) << "the other method may not clip rays";
  state.comparison = 0;
  EXPECT_EQ(clip(0.07).front().purpose, Purpose::Clip) << "the whole volume was kept";
  state.scene.classification.transferFunction = "layers";
  state.changed = true;
  EXPECT_NE(follow().front().purpose, Purpose::Clip);
  ASSERT_TRUE(askUntil(director, state, [&] { return director.isReadyToClip(state.scene); }));
  EXPECT_EQ(clip(0.05).front().purpose, Purpose::Clip) << "it was made ready again";
  ImageDirector another(device(), true);
  ViewState same = state;
  same.changed = true;
  same.whole = same.latest = nullptr;
  ASSERT_TRUE(askUntil(another, same, [&] { return another.isComplete(same); }));
  EXPECT_EQ(downloadImage(device(), *state.whole->image).pixels, downloadImage(device(), *same.whole->image).pixels)
      << "as of a volume that was clipped when it was opened";
}

/// The image that is shown at once after an edit of colours, beside the whole image that follows it.
TEST_F(ImageDirectorTest, ColoursAreMixedOfLayersOnceTheyWereEdited) {
  const auto expectMixed = [&] {
    state.changed = true;
    director.ask(state, {64, 48}, false);
    std::exception_ptr failure;
    ASSERT_TRUE(director.take(state, failure)) << "it is there at once";
    const Image mixed = downloadImage(device(), *state.latest->image);
    follow();
    EXPECT_GT(compareImages(mixed, downloadImage(device(), *state.whole->image)).psnr, 55.0);
  };
  const auto makeLayers = [&] {
    state.changed = true;
    follow();
    ASSERT_TRUE(askUntil(director, state, [&] { return director.mayMix(state); }));
  };
  state.scene.lighting = {.lights = {{.light = {.place = {1, 1, 1}}}, {.light = {.place = {-1, 0, 1}}}}, .ambient = glm::dvec3(0.2)};
  follow();
  state.scene.lighting.lights[0].light.color = {1.0, 0.5, 0.5};
  makeLayers();
  state.scene.lighting.lights[0].light.color = {0.0, 0.2, 2.0};
  state.scene.lighting.lights[1].hasIntensity = true;
  state.scene.lighting.lights[1].light.intensity = 0.3;
  state.scene.lighting.ambient = glm::dvec3(0.4, 0.0, 0.0);
  expectMixed();
}

TEST_F(ImageDirectorTest, AnAutomaticCameraFollowsTheWindow) {
  follow();
  const Camera before = *state.camera;
  director.ask(state, {30, 90}, false);
  std::exception_ptr failure;
  for (int i = 0; i < 20'000 && !director.isComplete(state); ++i) {
    director.take(state, failure);
    director.ask(state, {30, 90}, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_TRUE(director.isComplete(state));
  EXPECT_NE(state.camera->position, before.position) << "it fits the volume into a narrow image";
  EXPECT_EQ(state.camera->position, state.whole->scene.camera.position);
}

TEST_F(ImageDirectorTest, AllFramesOfASequenceHaveTheViewOfTheWhole) {
  const test::TemporaryFolder folder;
  openvdb::initialize();
  state.scene.input = {};
  state.sequence.emplace();
  for (const int edge : {3, 9, 20}) {
    openvdb::GridCPtrVec grids;
    for (const char* name : {"density", "temperature"}) {
      const auto grid = openvdb::FloatGrid::create(0.0f);
      grid->setName(name);
      const bool isHot = *name == 't';
      grid->denseFill({openvdb::Coord(0), openvdb::Coord(edge - 1)}, isHot ? 100.0f * float(edge) : 0.3f, true);
      if (!isHot || edge > 3) grids.push_back(grid);
    }
    state.sequence->files.push_back((folder / fmt::format("f{}.vdb", state.sequence->files.size())).string());
    openvdb::io::File(state.sequence->files.back()).write(grids);
  }
  state.scene.input.volume = state.sequence->files.front();
  follow();
  const Camera camera = *state.camera;
  const EmissionDescription emission = state.scene.emission;
  EXPECT_TRUE(emission.strength) << "the first frame has no temperatures";
  for (const std::string& file : state.sequence->files) {
    state.showFrame(file);
    follow();
    EXPECT_EQ(state.whole->scene.camera.position, camera.position) << file;
    EXPECT_EQ(state.scene.emission, emission) << file;
    EXPECT_EQ(state.whole->scene.classification.emission.has_value(), file != state.sequence->files.front()) << file;
  }
}

}  // namespace
}  // namespace freevoxels
