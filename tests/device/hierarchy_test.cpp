// The octree on the device and the cuts through it: against double precision on the CPU, closed forms, and
// that every voxel is drawn once.

#include <cmath>
#include <cstring>

#include "engine/attenuation/attenuation_table.h"
#include "engine/attenuation/table_levels.h"
#include "engine/octree/medium_levels.h"
#include "engine/octree/volume_builder.h"
#include "engine/reference/reference_hierarchy.h"
#include "engine/reference/reference_splats.h"
#include "engine/renderer_stages.h"
#include "engine/validation/detail_quality.h"
#include "engine/validation/level_checks.h"
#include "engine/visibility/detail_rule.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

constexpr glm::ivec3 kOdd{37, 22, 51};

LevelData voxelLevel(Renderer& renderer, const Volume& volume, const Classification& classification) {
  const std::vector<float> extinction = RendererStages(renderer).downloadExtinction();
  return referenceVoxelLevel(volume, classification, {extinction.begin(), extinction.end()},
                             RendererStages(renderer).downloadTable());
}

void expectPassed(const Check& check) {
  EXPECT_TRUE(check.passed()) << check.name << ": " << check.figure << " at " << check.where;
}

class HierarchyTest : public DeviceTest {
 protected:
  void expectReferenceLevels(const Volume& volume, const Classification& classification,
                             const TableSettings& settings) {
    Renderer renderer(device(), volume, classification, settings);
    const LevelData voxels = voxelLevel(renderer, volume, classification);
    for (const Check& check : compareLevels(volume, voxels, RendererStages(renderer).downloadLevels(), settings, "test"))
      expectPassed(check);
  }

  /// Drawn by both from the device's levels and its choice of blocks, of which there are several levels.
  void expectReferenceImage(const Volume& volume, const Classification& classification, const Camera& camera, FrameSettings settings,
                            const TableSettings& table = {}) {
    settings.depth = true;
    settings.splats().culling = false;
    Renderer renderer(device(), volume, classification, table);
    const Image image = renderer.render(camera, settings);
    const std::vector<Block> drawn = RendererStages(renderer).downloadDrawnBlocks();
    EXPECT_GT(drawn.back().level, 0);
    const LevelData voxels = voxelLevel(renderer, volume, classification);
    const std::vector<LevelData> levels = RendererStages(renderer).downloadLevels();
    const auto sums = referenceBlockSums(
        volume, classification,
        {.extinction = voxels.extinction, .table = voxels.table, .tableSettings = table, .coarser = levels},
        camera, settings, drawn);
    const Image expected = referenceResolve(sums, settings);
    EXPECT_LE(largestPixelDifference(image, expected), 1e-4);
    EXPECT_LE(worstRelativeDepth(image, expected), 1e-3);
    EXPECT_GE(psnr(image, expected), 90.0);
  }
};

TEST_F(HierarchyTest, LevelsMatchTheReferenceAtOddDimensions) {
  const Volume volume = randomVolume(kOdd, shearedTransform(kOdd), 0.7, 1.0);
  for (const AttenuationCode code : {AttenuationCode::Depth8, AttenuationCode::Linear8})
    for (const HierarchyFilter filter : {HierarchyFilter::Geometric, HierarchyFilter::Arithmetic})
      expectReferenceLevels(volume, coloured(volume), {.code = code, .filter = filter});
  expectReferenceLevels(volume, {.densityScale = 9.0}, {.directions = DirectionSet::Directions98});
}

TEST_F(HierarchyTest, AVolumeOfOneVoxelHasNoLevels) {
  const Volume volume = makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), volume, {}, {});
  EXPECT_TRUE(RendererStages(renderer).downloadLevels().empty());
  renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}), {.size = {1, 1}, .method = SplatSettings{}, .lod = 100.0f});
  EXPECT_EQ(renderer.cutCounts().drawn, std::vector<std::uint64_t>{1});
}

/// The mean of the depths of a block's voxels in a homogeneous box, which the codes hold to rounding.
TEST_F(HierarchyTest, AHomogeneousBoxHasMeanDepths) {
  const double sigma = 2.0;
  const Volume volume = makeVolume(kOdd, shearedTransform(kOdd), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), volume, {.densityScale = sigma}, {});
  const std::vector<LevelData> levels = RendererStages(renderer).downloadLevels();
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (const int direction : {0, 4, 9, 13, 16, 22}) {
      const glm::ivec3 step = directionCell(DirectionSet::Directions26, direction);
      const double length = stepLength(volume.indexToWorld, glm::dvec3(step), true);
      const glm::ivec3 n = levels[i].dimensions;
      for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
          for (int x = 0; x < n.x; ++x) {
            const BlockBox box = boxOf({int(i) + 1, {x, y, z}}, kOdd);
            double mean = 0.0;
            for (int c = 0; c < box.extent.z; ++c)
              for (int b = 0; b < box.extent.y; ++b)
                for (int a = 0; a < box.extent.x; ++a)
                  mean += sigma * length * voxelsAhead(box.first + glm::ivec3(a, b, c), step, kOdd);
            const int expected = encodeOpticalDepth(AttenuationCode::Depth8, mean / box.voxels());
            const int code = levels[i].table[std::size_t(direction)][levels[i].at({x, y, z})];
            ASSERT_NEAR(code, expected, 2) << "level " << i + 1 << " at " << x << "," << y << "," << z;
          }
    }
}

/// What a homogeneous box sends to the eye does not depend on the size of its blocks, nor does its optical
/// depth, which no size changes in any volume.
TEST_F(HierarchyTest, BlocksSendWhatTheirVoxelsDo) {
  const glm::ivec3 even(32);
  const Volume uniform = makeVolume(even, cubeTransform(even), [](int, int, int) { return 1.0; });
  const Volume random = randomVolume(kOdd, shearedTransform(kOdd), 0.3, 1.0);
  const double sigma = 3.0, halfCode = std::sqrt(kMaxCodedDepth * sigma) / 255.0;  // at the far side
  for (const Volume* volume : {&uniform, &random}) {
    Renderer renderer(device(), *volume, {.densityScale = sigma}, {});
    Camera camera = framingCamera(*volume, 0.0, 0.0, 1.0, {.orthographic = true});
    camera.orthographicHeight *= 3.0;  // the kernels of large blocks are larger than the volume
    const double pixelsPerVoxel = 400.0 / camera.orthographicHeight * volume->voxelSize();
    glm::dvec2 finest(0.0);
    for (const int level : {0, 1, 2, 3, 4}) {
      const FrameSettings settings{.size = {400, 400},
                                   .method = SplatSettings{.gradient = false},  // which only the outermost see here
                                   .lod = float(1.6 * pixelsPerVoxel * (1 << level))};
      glm::dvec2 sums(0.0);  // optical depth and energy
      for (const SplatSums& pixel : RendererStages(renderer).renderSums(camera, settings)) sums += glm::dvec2(pixel.depth, pixel.energy);
      if (level == 0) finest = sums;
      EXPECT_EQ(renderer.cutCounts().drawn.size(), std::size_t(level) + 1);
      EXPECT_NEAR(sums.x / finest.x, 1.0, 1e-3) << "level " << level;
      if (volume == &uniform) {
        EXPECT_NEAR(sums.y / finest.y, 1.0, halfCode) << "level " << level;
      }
    }
  }
}

TEST_F(HierarchyTest, EveryVoxelIsDrawnOnceFromAnywhere) {
  const Volume volume = randomVolume(kOdd, shearedTransform(kOdd), 0.3, 1.0);
  const std::vector<float> scalars = denseScalars(volume);
  const std::vector<double> extinction(scalars.begin(), scalars.end());
  Renderer renderer(device(), volume, {.densityScale = 1.0}, {});
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::size_t severalLevels = 0;
  for (int i = 0; i < 30; ++i) {
    Camera camera{.position = {uniform(generator), uniform(generator), uniform(generator)},
                  .lookAt = {0.2, -0.1, 0.3},
                  .verticalFov = 60.0 + 50.0 * uniform(generator)};
    camera.orthographic = i % 10 == 9;
    const FrameSettings settings{
        .size = {24, 16}, .method = SplatSettings{.culling = false}, .lod = float(std::exp(3.0 * uniform(generator)))};
    renderer.render(camera, settings);
    const std::vector<Block> drawn = RendererStages(renderer).downloadDrawnBlocks();
    ASSERT_EQ(coverageErrors(volume, extinction, drawn), 0u) << "camera " << i;
    if (drawn.front().level != drawn.back().level) ++severalLevels;

    // The reference's cut may differ only where a size is the limit but for rounding.
    const std::vector<Block> expected = referenceCut(volume, extinction, camera, settings);
    const DetailRule rule =
        detailRule(HierarchyLayout(kOdd), pixelRays(camera, settings.size, volume.indexToWorld),
                   settings.size, settings.lod);
    for (const Block& block : drawn) {
      if (std::ranges::find(expected, block) != expected.end()) continue;
      const auto excess = [&](const Block& b) {
        return rule.edgePerDistance * rule.nearestDistance(b) / b.edge() - 1.0;
      };
      EXPECT_LT(std::min(std::abs(excess(block)), std::abs(excess(block.parent()))), 1e-4);
    }
  }
  EXPECT_GT(severalLevels, 10u);
}

TEST_F(HierarchyTest, CutsMatchTheReference) {
  const Volume volume = randomVolume(kOdd, shearedTransform(kOdd), 0.6, 1.0);
  Camera near = framingCamera(volume, 35.0, 25.0, 1.2, {});
  near.position = near.lookAt + 0.7 * (near.position - near.lookAt);
  expectReferenceImage(volume, coloured(volume), near, {.size = {60, 50}, .method = SplatSettings{}, .lod = 4.0f});
  expectReferenceImage(volume, {.densityScale = 9.0}, near,
                       {.size = {60, 50}, .method = SplatSettings{.composite = Composite::Additive, .gradient = false}, .lod = 3.0f},
                       {.code = AttenuationCode::Linear8, .pathLengthCorrection = false, .directions = DirectionSet::Directions98});
  expectReferenceImage(volume, {.densityScale = 9.0}, near, {.size = {14, 12}, .method = SplatSettings{}});
  expectReferenceImage(volume, {.densityScale = 9.0}, framingCamera(volume, -110.0, -40.0, 1.0, {.orthographic = true}),
                       {.size = {50, 50}, .method = SplatSettings{}, .lod = 5.0f});
}

TEST_F(HierarchyTest, TheSameCutTwiceIsBitIdentical) {
  const Volume volume = randomVolume(kOdd, cubeTransform(kOdd), 0.6, 9.0);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  const FrameSettings settings{.size = {64, 64}, .method = SplatSettings{}, .lod = 3.0f};
  Renderer first(device(), volume, {}, {}), second(device(), volume, {}, {});
  const Image a = first.render(camera, settings);
  first.render(camera, {.size = {64, 64}, .method = SplatSettings{}, .lod = 9.0f});
  for (const Image& b : {first.render(camera, settings), second.render(camera, settings)})
    EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec4)), 0);
}

TEST_F(HierarchyTest, VoxelsAreDrawnWhereTheyAreLargeOrSorted) {
  const Volume volume = randomVolume(kOdd, cubeTransform(kOdd), 0.6, 9.0);
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  Renderer renderer(device(), volume, {}, {});
  for (FrameSettings settings : {FrameSettings{.size = {16, 16}, .method = SplatSettings{}, .lod = 0.0f},
                                 FrameSettings{.size = {200, 200}, .method = SplatSettings{}},
                                 FrameSettings{.size = {16, 16}, .method = SplatSettings{.composite = Composite::Sorted}, .lod = 9.0f}}) {
    settings.splats().culling = false;
    renderer.render(camera, settings);
    EXPECT_EQ(renderer.cutCounts().drawn, std::vector{*renderer.occupiedVoxelCount()});
    for (const StageTime& stage : renderer.timings()) EXPECT_NE(stage.name, "octree table");
  }
}

TEST_F(HierarchyTest, TheChecksNoticeWhatIsWrong) {
  const Volume volume = randomVolume({9, 8, 11}, cubeTransform({9, 8, 11}), 0.6, 1.0);
  const Classification classification = coloured(volume);
  Renderer renderer(device(), volume, classification, {});
  const LevelData voxels = voxelLevel(renderer, volume, classification);
  const std::vector<LevelData> levels = RendererStages(renderer).downloadLevels();
  const auto failures = [&](auto spoil) {
    std::vector<LevelData> spoilt = levels;
    spoil(spoilt);
    return std::ranges::count_if(compareLevels(volume, voxels, spoilt, {}, "test"),
                                 [](const Check& check) { return !check.passed(); });
  };
  EXPECT_EQ(failures([](auto&) {}), 0);
  EXPECT_GE(failures([](auto& l) { l.back().extinction[0] *= 1.001; }), 1);
  EXPECT_GE(failures([](auto& l) { l[0].colors[7].g += 0.01; }), 1);
  EXPECT_EQ(failures([](auto& l) { l.back().table[5][0] ^= 2; }), 1);

  std::vector<Block> blocks =
      referenceCut(volume, voxels.extinction, framingCamera(volume, 0.0, 0.0, 1.0, {}), {.size = {4, 4}, .method = SplatSettings{}});
  EXPECT_EQ(coverageErrors(volume, voxels.extinction, blocks), 0u);
  blocks.push_back(blocks.front());
  EXPECT_GT(coverageErrors(volume, voxels.extinction, blocks), 0u);
  blocks.erase(blocks.begin(), blocks.begin() + 2);
  EXPECT_GT(coverageErrors(volume, voxels.extinction, blocks), 0u);
}

void expectPassedAndPrint(const ReportSection& section) {
  for (const Check& check : section.checks) {
    std::printf("%s: %s: %.4g %s, %s\n", section.title.c_str(), check.name.c_str(), check.figure,
                check.unit.c_str(), check.where.c_str());
    expectPassed(check);
  }
}

TEST_F(HierarchyTest, LevelOfDetailOneIsHardToTellFromVoxels) {
  for (const QualitySubject& subject : kQualitySubjects)
    if (!subject.thin)
      expectPassedAndPrint(
          detailQuality(device(), makeQualityScene(subject, 64, makeProcedural(subject.procedural, 64))));
}

TEST_F(HierarchyTest, AZoomShowsNoPop) {
  const QualitySubject& head = kQualitySubjects.front();
  expectPassedAndPrint(
      zoomQuality(device(), makeQualityScene(head, 32, makeProcedural(head.procedural, 32))));
}

/// As a CPU and as a GPU makes them.
TEST_F(HierarchyTest, TablesAreTheSameHoweverManyDirectionsAThreadHas) {
  const Volume volume = randomVolume(kOdd, shearedTransform(kOdd), 0.4, 8.0);
  for (const DirectionSet set : {DirectionSet::Directions26, DirectionSet::Directions98}) {
    const TableSettings settings{.directions = set};
    std::vector<StageTime> times;
    const BuiltVolume built = buildVolume(device(), volume, {.densityScale = 1.0}, times);
    const auto levelsOf = [&](std::uint32_t directionsPerThread, LevelDispatches dispatches) {
      const AttenuationTable table = makeTable(device(), built.volume, settings);
      AttenuationSweep sweep(device(), settings);
      Commands commands(device());
      commands.beginPass("clear");
      for (const Buffer& plane : table.planes) commands.clear(plane);  // which may have the memory of an earlier table
      sweep.record(commands, built.volume, table);
      TableLevels(device(), settings, directionsPerThread, dispatches).record(commands, built.volume, built.lists.steps, table);
      commands.submitAndWait();
      std::vector<std::vector<std::vector<std::uint8_t>>> levels;
      for (int level = 1; level <= built.volume.hierarchy.top(); ++level) {
        levels.push_back(downloadTable(device(), built.volume, table, level));
        levels.push_back(downloadBounds(device(), built.volume, table, level));
      }
      return std::pair(levels, downloadLargestDepths(device(), table));
    };
    EXPECT_TRUE(levelsOf(shader::kDirectionsPerLevelPass, LevelDispatches::Single) ==
                levelsOf(kDirectionsPerGpuThread, LevelDispatches::Joined))
        << directionCount(set);
  }
}

}  // namespace
}  // namespace freevoxels
