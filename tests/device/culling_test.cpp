// What a frame leaves out: images of the rest are those of everything, whatever hides or ends where.

#include <fmt/format.h>

#include <cstring>
#include <numeric>
#include <set>

#include "engine/renderer_stages.h"
#include "engine/validation/culling_checks.h"
#include "engine/validation/level_checks.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

std::uint64_t drawnBlocks(const CutCounts& counts) {
  return std::accumulate(counts.drawn.begin(), counts.drawn.end(), std::uint64_t(0));
}

/// Walls of three voxels, and dust in the room.
Volume opaqueBox(glm::ivec3 dimensions, const glm::dmat4& transform) {
  return makeVolume(dimensions, transform, [&](int x, int y, int z) {
    const glm::ivec3 p(x, y, z), toFace = glm::min(p, dimensions - 1 - p);
    return std::min({toFace.x, toFace.y, toFace.z}) < 3 ? 1.0 : 0.02;
  });
}

QualityScene qualityScene(const char* procedural, QualityColor color, int resolution) {
  return makeQualityScene({procedural, color, false}, resolution, makeProcedural(procedural, resolution));
}

class CullingTest : public DeviceTest {
 protected:
  struct Outcome {
    CutCounts counts;
    std::uint64_t voxels = 0;
  };
  static constexpr SplatSettings kHiding{.composite = Composite::Additive};
  static Outcome expectSameImage(Renderer& renderer, const Camera& camera, FrameSettings settings, const std::string& name) {
    settings.splats().culling = false;
    const Image expected = renderer.render(camera, settings);
    settings.splats().culling = true;
    const Image image = renderer.render(camera, settings);
    EXPECT_LE(largestPixelDifference(image, expected), kCullingDifference) << name;
    EXPECT_GE(psnr(image, expected), kCullingPsnr) << name;
    return {renderer.cutCounts(), *renderer.occupiedVoxelCount()};
  }
};

TEST_F(CullingTest, WhatIsLeftOutDoesNotShowFromAnywhere) {
  const glm::ivec3 odd(45, 38, 51);
  struct Subject {
    const char* name;
    Volume volume;
    Classification classification;
  };
  std::vector<Subject> subjects;
  subjects.push_back({"box", opaqueBox(odd, shearedTransform(odd)), {.densityScale = 300.0}});
  for (const auto& [name, color] : {std::pair("head", QualityColor::Skin), {"shells", QualityColor::Cloud}}) {
    QualityScene scene = qualityScene(name, color, 48);
    subjects.push_back({name, std::move(scene.volume), scene.classification});
  }
  const std::array<TableSettings, 3> tables{
      {{}, {.code = AttenuationCode::Linear8}, {.directions = DirectionSet::Directions98}}};
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::uint64_t hidden = 0;
  for (const Subject& subject : subjects)
    for (const TableSettings& table : tables) {
      Renderer renderer(device(), subject.volume, subject.classification, table);
      for (int i = 0; i < 4; ++i) {
        Camera camera = framingCamera(subject.volume, 360.0 * uniform(generator),
                                      180.0 * uniform(generator) - 90.0, 1.0, {.orthographic = i == 1});
        camera.position =
            camera.lookAt + (0.4 + 2.0 * uniform(generator)) * (camera.position - camera.lookAt);
        const FrameSettings settings{.size = {112, 96}, .method = kHiding, .lod = i == 3 ? 3.0f : 0.0f};
        hidden += expectSameImage(renderer, camera, settings,
                                  fmt::format("{}, camera {}, {} directions, code {}", subject.name, i, directionCount(table.directions),
                                              int(table.code)))
                      .counts.hidden;
      }
    }
  EXPECT_GT(hidden, 1000u);
}

TEST_F(CullingTest, MostOfAnOpaqueHeadIsNeverDrawn) {
  QualityScene scene = qualityScene("head", QualityColor::Skin, 128);
  // Each voxel by itself, whatever the resolution.
  scene.classification.transferFunction->unitDistance = scene.volume.voxelSize();
  Renderer renderer(device(), scene.volume, scene.classification, {});
  const Outcome outcome = expectSameImage(renderer, viewCamera(scene.volume, {}), {.size = {256, 256}, .method = kHiding}, "opaque head");
  EXPECT_LT(double(drawnBlocks(outcome.counts)), 0.30 * double(outcome.voxels));
}

/// A channel along (3, 1, 2), between the directions of the table, into an opaque box, and a red voxel at its
/// end. From every voxel that a pixel looks at through it, the directions of the table meet its walls: to the
/// table all are hidden.
TEST_F(CullingTest, AHoleThatNoDirectionOfTheTableSeesShowsInTheNormalisedComposite) {
  const glm::ivec3 dimensions(64);
  const glm::dvec3 end(44.0, 29.0, 40.0), along = glm::normalize(glm::dvec3(3.0, 1.0, 2.0));
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [&](int x, int y, int z) {
    const glm::dvec3 from = glm::dvec3(x, y, z) - end;
    const double height = glm::dot(from, along);
    if (height > 0.0 && glm::length(from - height * along) < 2.2) return 0.0;
    return glm::length(from) < 3.0 ? 2.0 : 1.0;
  });
  Classification classification;
  classification.transferFunction = TransferFunction{
      .opacity = {{0.0f, 0.0f}, {1.0f, 0.95f}},
      .color = {{0.0f, {0.0f, 0.2f, 1.0f}}, {1.0f, {0.0f, 0.2f, 1.0f}}, {2.0f, {1.0f, 0.0f, 0.0f}}},
      .unitDistance = volume.voxelSize()};
  Renderer renderer(device(), volume, classification, {});
  const glm::dvec3 position(volume.indexToWorld * glm::dvec4(end, 1.0));
  const Camera camera{.position = position + 2.0 * along, .lookAt = position, .verticalFov = 30.0};
  const FrameSettings settings{.size = {161, 161}, .method = SplatSettings{}};
  const glm::vec4 middle = renderer.render(camera, settings).pixels[80 * 161 + 80];
  EXPECT_GT(middle.r, 0.03f);  // the bottom's voxels have some of the walls' blue
  EXPECT_LT(RendererStages(renderer).renderSums(camera, settings)[80 * 161 + 80].energy, settings.splats().cullThreshold);
}

TEST_F(CullingTest, WhatIsOutsideOfTheImageIsNotDrawn) {
  const Volume volume = randomVolume({61, 40, 52}, shearedTransform({61, 40, 52}), 0.5, 1.0);
  Renderer renderer(device(), volume, {.densityScale = 1.0}, {});
  for (const double zoom : {2.0, 8.0, 30.0})
    for (const bool orthographic : {false, true}) {
      Camera camera = framingCamera(volume, 35.0, 25.0, 1.5, {.orthographic = orthographic});
      camera.lookAt += glm::dvec3(0.1, -0.05, 0.02);
      camera.verticalFov /= zoom;
      camera.orthographicHeight /= zoom;
      FrameSettings settings{.size = {90, 60}, .method = SplatSettings{.cullThreshold = 0.0f}, .lod = 0.0f};
      const Image image = renderer.render(camera, settings);
      const CutCounts counts = renderer.cutCounts();
      settings.splats().culling = false;
      EXPECT_LE(largestPixelDifference(image, renderer.render(camera, settings)), kFrustumDifference);
      EXPECT_LT(double(drawnBlocks(counts)), (zoom > 2.0 ? 0.2 : 1.0) * double(*renderer.occupiedVoxelCount()));
      EXPECT_GT(counts.outside, 0u);
      EXPECT_EQ(counts.hidden, 0u);
    }
}

/// Blocks that are not empty, each considered once: those that are drawn and left out hold every voxel once.
TEST_F(CullingTest, CountsAddUp) {
  const glm::ivec3 dimensions(40, 33, 50);
  const Volume volume = opaqueBox(dimensions, cubeTransform(dimensions));
  Renderer renderer(device(), volume, {.densityScale = 300.0}, {});
  Camera camera = framingCamera(volume, 35.0, 25.0, 1.5, {});
  camera.verticalFov /= 2.0;
  renderer.render(camera, {.size = {120, 80}, .method = kHiding, .lod = 0.0f});
  const CutCounts counts = renderer.cutCounts();
  EXPECT_GT(counts.outside, 0u);
  EXPECT_GT(counts.hidden, 0u);
  EXPECT_GT(drawnBlocks(counts), 0u);
  EXPECT_EQ(counts.considered,
            counts.empty + counts.outside + counts.hidden + counts.opened + drawnBlocks(counts));
  const std::vector<Block> drawn = RendererStages(renderer).downloadDrawnBlocks();
  EXPECT_EQ(drawn.size(), drawnBlocks(counts));
  std::set<std::array<int, 3>> once;
  for (const Block& block : drawn) once.insert({block.cell.x, block.cell.y, block.cell.z});
  EXPECT_EQ(once.size(), drawn.size());

  renderer.render(camera, {.size = {120, 80}, .method = SplatSettings{.culling = false}, .lod = 0.0f});
  EXPECT_EQ(renderer.cutCounts().drawn, std::vector{*renderer.occupiedVoxelCount()});
}

/// The table counts from the outside; sorted images are of all voxels; and where nothing is dark in all of four directions there is nothing
/// to ask.
TEST_F(CullingTest, NothingIsHiddenWhereTheTableCannotTell) {
  const glm::ivec3 dimensions(40);
  const Volume volume = opaqueBox(dimensions, cubeTransform(dimensions));
  Renderer renderer(device(), volume, {.densityScale = 300.0}, {});
  const Camera outside = framingCamera(volume, 35.0, 25.0, 1.0, {});
  Camera inside = outside;
  inside.position = inside.lookAt + 0.1 * (inside.position - inside.lookAt);
  const FrameSettings hiding{.size = {64, 64}, .method = kHiding, .lod = 0.0f};
  const FrameSettings sorted{.size = {64, 64}, .method = SplatSettings{.composite = Composite::Sorted}};
  for (const auto& [camera, settings] : {std::pair(inside, hiding), {outside, sorted}}) {
    renderer.render(camera, settings);
    EXPECT_EQ(renderer.cutCounts().hidden, 0u);
  }
  EXPECT_EQ(renderer.cutCounts().drawn, std::vector{*renderer.occupiedVoxelCount()});

  Renderer thin(device(), volume, {.densityScale = 1.0}, {});
  thin.render(outside, hiding);
  EXPECT_EQ(thin.cutCounts().considered, *thin.occupiedVoxelCount());
}

TEST_F(CullingTest, TheSameFrameTwiceIsBitIdentical) {
  const QualityScene scene = qualityScene("head", QualityColor::Skin, 48);
  const Camera camera = viewCamera(scene.volume, {});
  const FrameSettings settings{.size = {100, 100}, .method = kHiding, .depth = true};
  Renderer first(device(), scene.volume, scene.classification, {});
  const Image a = first.render(camera, settings);
  first.render(viewCamera(scene.volume, {.azimuth = 200.0}), {.size = {140, 60}, .method = SplatSettings{}});
  const Image b = first.render(camera, settings);
  EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec4)), 0);
  EXPECT_EQ(std::memcmp(a.depth.data(), b.depth.data(), a.depth.size() * sizeof(float)), 0);
}

TEST_F(CullingTest, SumsAreOfEverything) {
  const QualityScene scene = qualityScene("head", QualityColor::Skin, 32);
  const Camera camera = viewCamera(scene.volume, {});
  Renderer renderer(device(), scene.volume, scene.classification, {});
  const auto sums = RendererStages(renderer).renderSums(camera, {.size = {60, 60}, .method = kHiding, .lod = 0.0f});
  const auto whole =
      RendererStages(renderer).renderSums(camera, {.size = {60, 60}, .method = SplatSettings{.culling = false}, .lod = 0.0f});
  for (std::size_t i = 0; i < sums.size(); ++i) ASSERT_EQ(sums[i].depth, whole[i].depth);
}

TEST_F(CullingTest, TheReportPasses) {
  for (const Check& check :
       cullingChecks(device(), qualityScene("head", QualityColor::Skin, 48), 96).checks) {
    std::printf("%s: %.3g %s, %s\n", check.name.c_str(), check.figure, check.unit.c_str(),
                check.where.c_str());
    EXPECT_TRUE(check.passed()) << check.name;
  }
}

}  // namespace
}  // namespace freevoxels
