#include "apps/view/image_maker.h"

#include <algorithm>

#include "apps/view/export_files.h"
#include "engine/volume/openvdb_trees.h"
#include "engine/volume/procedural.h"
#include "engine/volume/vdb.h"
#include "tests/device/device_fixture.h"
#include "tests/failing_allocation.h"
#include "tests/image_measures.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

class ImageMakerTest : public DeviceTest {
 protected:
  static ImageRequest litCloud() {
    ImageRequest request;
    request.scene.input = {.volume = "procedural:cloud", .grid = std::nullopt, .resolution = glm::ivec3(24)};
    request.scene.camera.size = {48, 48};
    request.scene.lighting.lights.push_back({.light = {.place = {0.0, 1.0, 0.0}}});
    return request;
  }
  /// The times of that name, in the order of the image's stages; a stage has its time only where it is new, or where
  /// it is of the volume that is kept.
  static std::vector<double> timesOf(const DrawnImage& drawn, const std::string& stage) {
    std::vector<double> times;
    for (const StageTime& time : drawn.times)
      if (time.name == stage) times.push_back(time.milliseconds);
    return times;
  }

  VolumeCache volumes_{1u << 30};
  ImageMaker maker_{device(), volumes_};
};

TEST_F(ImageMakerTest, TurningALightKeepsTheVolumeAndItsOccupancy) {
  ImageRequest request = litCloud();
  const DrawnImage first = maker_.make(request, {});
  request.scene.lighting.lights[0].light.place = {1.0, 0.0, 0.0};
  const DrawnImage turned = maker_.make(request, {});
  EXPECT_NE(downloadImage(device(), *turned.image).pixels, downloadImage(device(), *first.image).pixels);
  ASSERT_EQ(timesOf(first, "upload").size(), 1u);
  EXPECT_EQ(timesOf(turned, "upload"), timesOf(first, "upload")) << "measured once";
  EXPECT_EQ(timesOf(first, "bricks").size(), 1u);
  EXPECT_EQ(timesOf(turned, "bricks").size(), 0u);
}

/// As while a plane or a side of the box is dragged: with half of the quality, of the whole volume with clipped rays, or where that is not
/// ready of the coarse volume without what is clipped.
TEST_F(ImageMakerTest, DraftsOfAClippedVolumeResembleTheWholeImage) {
  ImageRequest request = litCloud();
  request.scene.input.resolution = glm::ivec3(128);
  request.scene.camera.size = {96, 96};
  const DrawnImage unclipped = maker_.make(request, {});
  const Image uncut = downloadImage(device(), *unclipped.image);
  request.scene.camera.look(unclipped.scene.camera);
  request.scene.classification.takeDensityScale(unclipped.scene.classification.densityScale);
  const glm::ivec3 last = unclipped.scene.volume->dimensions - 1;
  ImageMaker ofDrafts(device(), volumes_), ofRays(device(), volumes_);
  for (const int offset : {0, 5})
    for (const bool byPlane : {true, false}) {
      InputDescription& input = request.scene.input;
      input.clipPlane.reset();
      input.clipBox.reset();
      if (byPlane)
        input.clipPlane = ClipPlane{.point = glm::dvec3(0.01 * offset), .normal = {1.0, 0.5, 0.2}};
      else
        input.clipBox = VoxelBox{glm::ivec3(0), last - glm::ivec3(40 + offset, 0, 13)};
      ImageRequest draft = request;
      draft.purpose = Purpose::Edit;
      draft.voxelsAlongEdge = 64;
      draft.quality = ImageRequest::kSmallerBelow;
      const Image whole = downloadImage(device(), *maker_.make(request, {}).image);
      const double likeWhole = psnr(downloadImage(device(), *ofDrafts.make(draft, {}).image), whole);
      EXPECT_GT(likeWhole, 25.0) << offset << " " << byPlane;
      EXPECT_GT(likeWhole, psnr(uncut, whole) + 6.0) << offset << " " << byPlane;
      draft.purpose = Purpose::Clip;
      draft.voxelsAlongEdge = kAllVoxels;
      const double likeRays = psnr(downloadImage(device(), *ofRays.make(draft, {}).image), whole);
      EXPECT_GT(likeRays, 30.0) << offset << " " << byPlane;
    }
}

TEST_F(ImageMakerTest, ASequenceIsSavedWithTheCameraOfTheImage) {
  const test::TemporaryFolder folder;
  Sequence sequence{.pattern = (folder.path() / "c_#.vdb").string(), .files = {}, .numbers = {}};
  for (const int number : {2, 7}) {
    sequence.files.push_back((folder.path() / fmt::format("c_{}.vdb", number)).string());
    sequence.numbers.push_back(FrameNumber(number));
    writeVdb(sequence.files.back(), makeProcedural("cloud", 10 + number), "density");
  }
  ImageRequest request = litCloud();
  request.scene.input = {.volume = sequence.files.front()};
  request.isFrame = true;
  const DrawnImage shown = maker_.make(request, {});
  request.scene.camera.look(shown.scene.camera);
  request.scene.classification.takeDensityScale(shown.scene.classification.densityScale);
  const DrawnImage kept = maker_.make(request, {});
  saveSequence(device(), kept, sequence, (folder.path() / "f_##.exr").string(), [](std::string_view, double) {});
  for (std::size_t i = 0; i < 2; ++i) {
    request.scene.input.volume = sequence.files[i];
    const Image drawn = downloadImage(device(), *maker_.make(request, {}).image);
    const Image saved = readExr((folder.path() / fmt::format("f_{:02}.exr", i == 0 ? 2 : 7)).string());
    EXPECT_GT(psnr(saved, drawn), 60.0) << "as 16-bit floats";
  }
}

/// With the camera of the image, whose automatic place would depend on the shape of the image.
TEST_F(ImageMakerTest, AnImageOfAnotherSizeIsSavedWithTheSameView) {
  const test::TemporaryFolder folder;
  ImageRequest request = litCloud();
  const DrawnImage shown = maker_.make(request, {});
  const std::string file = (folder.path() / "large.exr").string();
  saveImageOfSize(device(), shown, {90, 40}, file, {});
  request.scene.camera.size = {90, 40};
  request.scene.camera.look(shown.scene.camera);
  request.scene.output.fullFloat = false;
  const Image saved = readExr(file), drawn = downloadImage(device(), *maker_.make(request, {}).image);
  EXPECT_EQ(saved.size, glm::ivec2(90, 40));
  EXPECT_GT(psnr(saved, drawn), 60.0) << "of 16 bits";
}

/// A draft has all voxels; its time follows its pixels.
TEST_F(ImageMakerTest, ImagesOfAMovementResembleTheWholeOne) {
  ImageRequest request = litCloud();
  request.scene.input.resolution = glm::ivec3(64);
  request.scene.camera.size = {96, 96};
  const Image whole = downloadImage(device(), *maker_.make(request, {}).image);
  request.purpose = Purpose::Move;
  EXPECT_GT(psnr(downloadImage(device(), *maker_.make(request, {}).image), whole), 35.0);
}

TEST_F(ImageMakerTest, ImagesOfAnEditedFunctionResembleTheWholeOne) {
  ImageRequest request = litCloud();
  request.scene.input = {.volume = "procedural:head", .grid = std::nullopt, .resolution = glm::ivec3(64)};
  request.scene.camera.size = {96, 96};
  request.scene.classification.transferFunction = "skin-and-bone";
  const DrawnImage before = maker_.make(request, {});
  request.scene.camera.look(before.scene.camera);
  request.scene.classification.window = ValueWindow{.low = 0.15, .high = 0.9};
  request.purpose = Purpose::Classify;
  const DrawnImage draft = maker_.make(request, {});
  EXPECT_EQ(draft.scene.volume->dimensions, before.scene.volume->dimensions) << "of all voxels";
  request.purpose = Purpose::Whole;
  const Image whole = downloadImage(device(), *maker_.make(request, {}).image);
  const double ofDraft = psnr(downloadImage(device(), *draft.image), whole), ofBefore = psnr(downloadImage(device(), *before.image), whole);
  EXPECT_GT(ofDraft, 30.0);
  EXPECT_GT(ofDraft, ofBefore + 6.0) << "the edit is seen";
}

TEST_F(ImageMakerTest, AnotherClassificationMakesAnotherOccupancy) {
  ImageRequest request = litCloud();
  maker_.make(request, {});
  request.scene.classification.transferFunction = R"({"opacity": [[0, 0], [1, 0.5]]})";
  EXPECT_EQ(timesOf(maker_.make(request, {}), "bricks").size(), 1u);
}

TEST_F(ImageMakerTest, AVolumeThatDoesNotFitIsDrawnCubeByCube) {
  ImageRequest request = litCloud();
  request.scene.input.resolution = glm::ivec3(120, 96, 97);
  request.scene.camera.size = {60, 48};
  const Image whole = downloadImage(device(), *maker_.make(request, {}).image);
  const Device limited(instance(), "", {.memory = std::uint64_t(30) << 20});
  ImageMaker maker(limited, volumes_);
  const DrawnImage drawn = maker.make(request, {});
  EXPECT_GT(psnr(downloadImage(limited, *drawn.image), whole), 60.0);
  request.diagnosis.shown = Shown::TableSlice;
  test::expectRefusal([&] { maker.make(request, {}); }, ErrorKind::OutOfMemory, {"memory-limit"});
}

TEST_F(ImageMakerTest, LightingAShiningVolumeMakesItsLightFallOnIt) {
  ImageRequest request = litCloud();
  request.scene.input.volume = "procedural:fire";
  request.scene.emission.emission = true;
  request.scene.lighting.unlit = true;
  maker_.make(request, {});
  request.scene.lighting.unlit = false;
  const DrawnImage kept = maker_.make(request, {}), made = ImageMaker(device(), volumes_).make(request, {});
  EXPECT_EQ(downloadImage(device(), *kept.image).pixels, downloadImage(device(), *made.image).pixels);
}

/// Frames of 2, 0 and more voxels along an edge.
TEST_F(ImageMakerTest, AFilmIsSeenAsAWholeFromItsFirstFrameOnEvenIfThatIsEmpty) {
  const test::TemporaryFolder folder;
  openvdb::initialize();
  std::vector<std::string> files;
  for (const int edge : {0, 2, 8, 24}) {
    const auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    if (edge > 0) grid->denseFill({openvdb::Coord(0), openvdb::Coord(edge - 1)}, 0.02f * float(edge), true);
    files.push_back((folder / fmt::format("f{}.vdb", files.size())).string());
    openvdb::io::File(files.back()).write(openvdb::GridCPtrVec{grid});
  }
  ImageRequest request;
  request.scene.camera.size = {40, 40};
  request.isFrame = true;
  request.film = files;
  std::vector<Scene> scenes;
  for (const std::string& file : files) {
    request.scene.input.volume = file;
    const DrawnImage drawn = maker_.make(request, {});
    scenes.push_back(drawn.scene);
    const Image image = downloadImage(device(), *drawn.image);
    const auto shows = [](const glm::vec4& pixel) { return pixel.a > 0.0f; };
    EXPECT_EQ(std::ranges::any_of(image.pixels, shows), file != files.front()) << file;
    EXPECT_EQ(image.pixels.front().a, 0.0f) << file << " is cut";
    EXPECT_EQ(scenes.back().camera.position, scenes.front().camera.position) << file;
    EXPECT_EQ(scenes.back().classification.densityScale, scenes.front().classification.densityScale) << file;
  }
  request.film = {files.front()};
  request.scene.input.volume = files.front();
  test::expectRefusal([&] { maker_.make(request, {}); }, ErrorKind::Input, {"no frame of the sequence"});
}

TEST_F(ImageMakerTest, AfterWantOfMemoryForACoarseVolumeTheNextImageIsNotOfThePreviousVolume) {
  for (const int voxels : {64, 33}) {
    ImageRequest first = litCloud();
    first.scene.input.resolution = {104, 72, 88};
    first.voxelsAlongEdge = voxels;
    ImageRequest next = first;
    next.scene.input.volume = "procedural:shells";
    ImageMaker maker(device(), volumes_);
    const DrawnImage before = maker.make(first, {});
    for (int times = 0; times < 2; ++times) {
      volumes_.read(next.scene, 1);
      const test::FailingAllocation want(sizeof(SparseGrid<std::int32_t>::Node));  // of the places of the coarse volume's first bricks
      EXPECT_ANY_THROW(maker.make(next, {}));
    }
    const DrawnImage after = maker.make(next, {}), expected = ImageMaker(device(), volumes_).make(next, {});
    EXPECT_EQ(downloadImage(device(), *after.image).pixels, downloadImage(device(), *expected.image).pixels);
    EXPECT_NE(downloadImage(device(), *after.image).pixels, downloadImage(device(), *before.image).pixels);
    // The same where the first volume comes back.
    const DrawnImage again = maker.make(first, {});
    EXPECT_EQ(downloadImage(device(), *again.image).pixels, downloadImage(device(), *before.image).pixels);
  }
}

}  // namespace
}  // namespace freevoxels
