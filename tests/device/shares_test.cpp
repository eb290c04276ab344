// Frames that are drawn share by share: the same bits for any number of processes, and the same image as one that is drawn at once.

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/image/metrics.h"
#include "engine/renderer_stages.h"
#include "engine/volume/scan.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

class SharesTest : public DeviceTest {
 protected:
  struct Scene {
    std::string name;
    Volume volume;
    Classification classification;
    Camera camera;
    FrameSettings settings;
  };

  static FixedSums total(Renderer& renderer, const Scene& scene, int count) {
    FixedSums sums = renderer.renderShares(scene.camera, scene.settings, {0, count});
    for (int index = 1; index < count; ++index) sums += renderer.renderShares(scene.camera, scene.settings, {index, count});
    return sums;
  }

  /// Sparse fog with a shadow, and an environment's worth of ambient light.
  static Scene litFog() {
    Scene scene{.name = "lit fog", .volume = randomVolume({40, 36, 44}, cubeTransform({40, 36, 44}), 0.3, 20.0)};
    scene.camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
    scene.settings = {.size = {64, 56}, .method = SplatSettings{}, .depth = true, .lighting = Lighting{.ambient = glm::dvec3(0.2)}};
    scene.settings.lighting->lights = {{.place = {1.0, 0.7, 0.2}}, {.place = {0.1, 0.3, 0.9}, .atInfinity = false, .intensity = 2.0}};
    scene.settings.lighting->surface = 0.5;
    return scene;
  }
  /// Light of its own, seen from inside, near kernels cut by the eye plane.
  static Scene fireFromInside() {
    Scene scene{.name = "fire from inside", .volume = makeProcedural("fire", 32)};
    scene.classification = {.densityScale = 20.0, .emission = Emission{.strength = 5.0}};
    scene.camera.position = {0.03, -0.1, 0.02};
    scene.camera.lookAt = {-0.3, 0.2, -0.2};
    scene.camera.verticalFov = 70.0;
    scene.settings = {.size = {48, 48}, .method = SplatSettings{}};
    return scene;
  }
  /// A scan that is classified after interpolation, lit at samples, with surfaces.
  static Scene scan() {
    Scene scene{.name = "scan", .volume = makeProcedural("head", 40)};
    scene.classification.transferFunction = scanTransferFunction(scene.volume);
    scene.classification.order = ClassificationOrder::Post;
    scene.camera = framingCamera(scene.volume, 35.0, 20.0, 1.0, {});
    scene.settings = {.size = {72, 64}, .method = SplatSettings{}, .depth = true, .lighting = Lighting{.ambient = glm::dvec3(0.2)}};
    scene.settings.lighting->lights = {{.place = {1.0, 0.7, 0.2}}};
    scene.settings.lighting->surface = 0.5;
    return scene;
  }
  static std::vector<Scene> gathered() {
    std::vector<Scene> scenes{litFog(), fireFromInside(), levels(), scan()};
    for (Scene& scene : scenes) {
      scene.settings.method = GatherSettings{};
      scene.name += ", gathered";
    }
    return scenes;
  }
  static std::vector<Scene> all() {
    std::vector<Scene> scenes = gathered();
    for (Scene& scene : std::vector<Scene>{litFog(), fireFromInside(), levels()}) scenes.push_back(std::move(scene));
    return scenes;
  }
  /// Blocks of several levels in one frame, part of them outside of the image.
  static Scene levels() {
    Scene scene{.name = "levels", .volume = randomVolume({64, 64, 64}, cubeTransform({64, 64, 64}), 0.4, 8.0)};
    scene.camera.position = {0.2, 0.1, 0.9};
    scene.camera.lookAt = {0.2, 0.0, -0.5};
    scene.camera.verticalFov = 40.0;
    scene.settings = {.size = {56, 64}, .method = SplatSettings{.composite = Composite::Additive}, .lod = 3.0f};
    return scene;
  }
};

TEST_F(SharesTest, SumsHaveTheSameBitsForAnyNumberOfProcesses) {
  for (const Scene& scene : all()) {
    SCOPED_TRACE(scene.name);
    Renderer renderer(device(), scene.volume, scene.classification, {});
    const FixedSums whole = renderer.renderShares(scene.camera, scene.settings, {});
    for (const int count : {2, 3, 4, 7}) EXPECT_EQ(total(renderer, scene, count).values, whole.values) << count;
    EXPECT_EQ(Renderer(device(), scene.volume, scene.classification, {}).renderShares(scene.camera, scene.settings, {}).values,
              whole.values);
    std::vector<std::int64_t> none(whole.values.size(), 0);
    EXPECT_NE(whole.values, none);
  }
}

TEST_F(SharesTest, GatheredLightHasTheSameBitsFromAllSides) {
  const Volume cloud = makeProcedural("cloud", 64);
  const Classification fog{.densityScale = automaticDensityScale(cloud, 4.0)};
  Classification scan;
  scan.transferFunction = TransferFunction{.opacity = {{0.0f, 0.0f}, {0.4f, 0.2f}, {0.5f, 0.0f}}, .color = {{0.0f, glm::vec3(0.8f)}}};
  for (const Classification& classification : {fog, scan}) {
    Renderer renderer(device(), cloud, classification, {});
    FrameSettings settings{.size = {64, 64}};
    settings.lighting = Lighting{.lights = {{.place = {1.0, 0.7, 0.2}}}, .ambient = glm::dvec3(0.2)};
    for (int side = 0; side < 8; ++side) {
      SCOPED_TRACE(testing::Message() << "side " << side << (classification.transferFunction ? ", scan" : ", fog"));
      const Camera camera = framingCamera(cloud, 20.0 + 45.0 * side, side % 2 == 0 ? 15.0 : -50.0, 1.0, {});
      const FixedSums whole = renderer.renderShares(camera, settings, {});
      for (const int count : {2, 5}) {
        FixedSums sums = renderer.renderShares(camera, settings, {0, count});
        for (int index = 1; index < count; ++index) sums += renderer.renderShares(camera, settings, {index, count});
        EXPECT_EQ(sums.values, whole.values) << count << " shares";
      }
    }
  }
}

TEST_F(SharesTest, EachOfAllSharesAloneAddsUpToTheWhole) {
  Scene scene = litFog();
  scene.settings.lighting.reset();
  scene.settings.size = {24, 24};
  Renderer renderer(device(), scene.volume, scene.classification, {});
  for (const Draw draw : {Draw::Splats, Draw::Gather}) {
    if (draw == Draw::Gather) scene.settings.method = GatherSettings{};
    EXPECT_EQ(total(renderer, scene, kShares).values, renderer.renderShares(scene.camera, scene.settings, {}).values);
  }
}

TEST_F(SharesTest, TheImageIsThatOfAFrameThatIsDrawnAtOnce) {
  for (Scene scene : {litFog(), fireFromInside(), levels()}) {
    SCOPED_TRACE(scene.name);
    Renderer renderer(device(), scene.volume, scene.classification, {});
    const Image shared = resolveSums(renderer.renderShares(scene.camera, scene.settings, {}), scene.settings.isNormalised());
    const Image expected = renderer.render(scene.camera, scene.settings);
    float brightest = 0.0f;
    for (const glm::vec4& pixel : expected.pixels) brightest = std::max({brightest, pixel.r, pixel.g, pixel.b, pixel.a});
    EXPECT_LE(largestPixelDifference(shared, expected), 2e-5 * brightest);
    ASSERT_EQ(shared.depth.size(), expected.depth.size());
    for (std::size_t i = 0; i < shared.depth.size(); ++i)
      if (expected.pixels[i].a > 1e-4f) { EXPECT_NEAR(shared.depth[i], expected.depth[i], 1e-5 * expected.depth[i]); }
  }
}

TEST_F(SharesTest, GatheredSharesAddUpToTheGatheredImage) {
  for (const Scene& scene : gathered()) {
    SCOPED_TRACE(scene.name);
    Renderer renderer(device(), scene.volume, scene.classification, {});
    const FixedSums sums = renderer.renderShares(scene.camera, scene.settings, {});
    ASSERT_TRUE(sums.lattice);
    const Image shared = resolveSums(sums, true), expected = renderer.render(scene.camera, scene.settings);
    float brightest = 0.0f;
    for (const glm::vec4& pixel : expected.pixels) brightest = std::max({brightest, pixel.r, pixel.g, pixel.b, pixel.a});
    EXPECT_LE(largestPixelDifference(shared, expected), 2e-5 * brightest);
    ASSERT_EQ(shared.depth.size(), expected.depth.size());
    for (std::size_t i = 0; i < shared.depth.size(); ++i)
      if (expected.pixels[i].a > 0.5f) {
        EXPECT_NEAR(shared.depth[i], expected.depth[i], 1e-3 * expected.depth[i]);
      }
  }
}

/// Seen from the outside and from the inside, along all axes.
TEST_F(SharesTest, GatheredSharesOfAHomogeneousBoxHaveItsTransmittance) {
  const double sigma = 2.0;
  const Volume box = makeVolume({32, 32, 32}, cubeTransform({32, 32, 32}), [&](int, int, int) { return 1.0; });
  Renderer renderer(device(), box, {.densityScale = sigma}, {});
  for (const glm::dvec3 way : {glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0)})
    for (const double distance : {0.2, 3.0}) {
      Camera camera{.position = distance * way, .lookAt = glm::dvec3(0.0), .up = {way.y, way.z, way.x}};
      camera.verticalFov = 5.0;
      FixedSums sums = renderer.renderShares(camera, {.size = {8, 8}}, {0, 2});
      sums += renderer.renderShares(camera, {.size = {8, 8}}, {1, 2});
      const double length = std::min(distance, 0.5) + 0.5;
      EXPECT_NEAR(resolveSums(sums, true).pixels[4 * 8 + 4].a, 1.0 - std::exp(-sigma * length), 0.01) << distance;
    }
}

/// The eye in the outermost half voxel of a box, or just outside of it, looking out: all that it sees lies beyond the last centres of voxels.
TEST_F(SharesTest, TheEyeInTheOutermostHalfVoxelSeesTheSameByShares) {
  for (const glm::ivec3 size : {glm::ivec3(8), glm::ivec3(33, 17, 40)}) {
    const Volume box = makeVolume(size, cubeTransform(size), [](int, int, int) { return 0.7; });
    const glm::dvec3 middle = 0.5 * glm::dvec3(size - 1);
    for (const ClassificationOrder order : {ClassificationOrder::Post, ClassificationOrder::Pre})
      for (int axis = 0; axis < 3; ++axis)
        for (const double beyond : {-0.4, 0.2, 0.45, 0.7})
          for (const float lod : {0.0f, 4.0f}) {
            SCOPED_TRACE(testing::Message() << size.x << " voxels, order " << int(order) << ", axis " << axis << ", " << beyond << ", lod " << lod);
            Classification classification = coloured(box, 0.6f);
            classification.order = order;
            Renderer renderer(device(), box, classification, {});
            glm::dvec3 eye = middle, way(0.0);
            eye[axis] = size[axis] - 1 + beyond;
            way[axis] = 1.0;
            way[(axis + 1) % 3] = 0.2;
            Camera camera{.position = glm::dvec3(box.indexToWorld * glm::dvec4(eye, 1.0))};
            camera.lookAt = camera.position + way;
            camera.up = {way.y, way.z, way.x};
            camera.verticalFov = 60.0;
            const FrameSettings settings{.size = {24, 24}, .lod = lod, .depth = true};
            FixedSums sums = renderer.renderShares(camera, settings, {0, 2});
            sums += renderer.renderShares(camera, settings, {1, 2});
            EXPECT_LE(largestPixelDifference(resolveSums(sums, true), renderer.render(camera, settings)), 2e-5);
          }
  }
}

/// The device's stencil and interpolation against those of the host, which parts are resolved with.
TEST_F(SharesTest, HostResolvesALatticeAsTheDeviceDoes) {
  for (const Scene& scene : {gathered()[0], gathered()[3]}) {
    SCOPED_TRACE(scene.name);
    Renderer renderer(device(), scene.volume, scene.classification, {});
    FrameSettings settings = scene.settings;
    settings.size *= 4;
    const GatherStages stages = RendererStages(renderer).renderGatherStages(scene.camera, settings);
    const SampleLattice lattice = *renderer.renderShares(scene.camera, settings, {0, kShares}).lattice;
    std::vector<LatticeSample> samples;
    for (const GatherSums& sum : stages.gathered) samples.push_back({{sum.color, sum.energy}, sum.distance});
    const Image image = resolveLattice(lattice, settings.size, samples);
    EXPECT_LE(largestPixelDifference(image, stages.image), 2e-5);
    for (std::size_t i = 0; i < image.depth.size(); ++i)
      if (image.pixels[i].a > 0.01f) { EXPECT_NEAR(image.depth[i], stages.image.depth[i], 1e-3 * image.depth[i]); }
  }
}

/// Images of several bands of rows, in some of which there is nothing: above the volume, and below it.
TEST_F(SharesTest, AHighImageIsThatOfItsSharesWhereverTheVolumeIs) {
  const glm::ivec3 size(16, 1000, 16);
  const Volume column = makeVolume(size, cubeTransform(size), [](int, int y, int) { return 0.5 + 0.4 * std::sin(0.1 * y); });
  Renderer renderer(device(), column, {.densityScale = 20.0}, {});
  const FrameSettings settings{.size = {16, 1500}, .depth = true};
  for (const double above : {0.0, 0.18, -0.18}) {
    SCOPED_TRACE(above);
    Camera camera{.position = {0.0, above, 2.5}, .lookAt = {0.0, above, 0.0}};
    camera.verticalFov = 28.0;
    const Image image = renderer.render(camera, settings), shared = resolveSums(renderer.renderShares(camera, settings, {}), true);
    EXPECT_LE(largestPixelDifference(image, shared), 2e-5);
    for (std::size_t i = 0; i < image.depth.size(); ++i)
      if (image.pixels[i].a > 0.01f) {
        EXPECT_NEAR(image.depth[i], shared.depth[i], 1e-3 * shared.depth[i]);
      }
  }
}

/// A dozen voxels, of one after another view with the same renderer: most of an image is empty, and is not drawn.
TEST_F(SharesTest, AnImageOfFewVoxelsIsThatOfItsShares) {
  const glm::ivec3 size(50, 47, 53);
  const Volume stars =
      makeVolume(size, cubeTransform(size), [](int x, int y, int z) { return (31 * x + 1017 * y + 7 * z) % 9973 == 0 ? 1.0 : 0.0; });
  const TransferFunction function{.opacity = {{0.0f, 0.0f}, {1.0f, 0.9f}}, .color = {{0.0f, {0.9f, 0.5f, 0.2f}}}, .unitDistance = 0.02};
  for (const ClassificationOrder order : {ClassificationOrder::Pre, ClassificationOrder::Post}) {
    Renderer renderer(device(), stars, {.transferFunction = function, .order = order}, {});
    std::ptrdiff_t seen = 0;
    for (int view = 0; view < 24; ++view) {
      const double fov = std::array{4.0, 14.0, 35.0, 110.0}[std::size_t(view % 4)];  // samples from 8 pixels to half a pixel apart
      const glm::ivec2 pixels = view % 3 == 0 ? glm::ivec2(97, 61) : glm::ivec2(203, 330);
      SCOPED_TRACE(fmt::format("order {}, view {}", int(order), view));
      Camera camera = framingCamera(stars, 15.0 * view, 5.0 * view - 60.0, 1.0, {});
      camera.verticalFov = fov;
      const FrameSettings settings{.size = pixels, .depth = true};
      const Image image = renderer.render(camera, settings), shared = resolveSums(renderer.renderShares(camera, settings, {}), true);
      EXPECT_LE(largestPixelDifference(image, shared), 2e-5);
      for (std::size_t i = 0; i < image.depth.size(); ++i)
        if (image.pixels[i].a > 0.01f) {
          ++seen;
          EXPECT_NEAR(image.depth[i], shared.depth[i], 1e-3 * shared.depth[i]);
        }
    }
    EXPECT_GT(seen, 500);
  }
}

TEST_F(SharesTest, NoShareIsEmptyAndNoneIsLeftOutUnnoticed) {
  const Scene scene = levels();
  Renderer renderer(device(), scene.volume, scene.classification, {});
  const FixedSums whole = renderer.renderShares(scene.camera, scene.settings, {});
  FixedSums fewer = renderer.renderShares(scene.camera, scene.settings, {0, 3});
  EXPECT_NE(std::ranges::count_if(fewer.values, [](std::int64_t value) { return value != 0; }), 0);
  fewer += renderer.renderShares(scene.camera, scene.settings, {2, 3});
  EXPECT_NE(fewer.values, whole.values);
}

/// A part's own chunks and the few blocks above them: a 64th of the shares has a 64th of 512 chunks.
TEST_F(SharesTest, APartLooksAtItsOwnBlocksOnly) {
  const Scene scene = levels();
  Renderer renderer(device(), scene.volume, scene.classification, {});
  renderer.renderShares(scene.camera, scene.settings, {});
  const CutCounts whole = renderer.cutCounts();
  renderer.renderShares(scene.camera, scene.settings, {5, 64});
  EXPECT_LT(renderer.cutCounts().considered, whole.considered / 16);
  EXPECT_GT(renderer.cutCounts().considered, 0u);
}

TEST_F(SharesTest, RectangleHoldsAllThatIsDrawn) {
  Scene scene = litFog();
  scene.camera.verticalFov *= 4.0;  // the volume in the middle of a larger image
  scene.settings.size = {128, 96};
  Renderer renderer(device(), scene.volume, scene.classification, {});
  const FixedSums sums = renderer.renderShares(scene.camera, scene.settings, {});
  EXPECT_LT(sums.pixelCount(), std::size_t(128 * 96 / 4));
  EXPECT_LE(largestPixelDifference(resolveSums(sums, true), renderer.render(scene.camera, scene.settings)), 2e-5);
}

/// Half a unit of each of 256 shares, against the frame's largest sums.
TEST_F(SharesTest, RoundingIsBelowATenMillionthOfTheBrightest) {
  for (const Scene& scene : all()) {
    SCOPED_TRACE(scene.name);
    Renderer renderer(device(), scene.volume, scene.classification, {});
    const FixedSums sums = renderer.renderShares(scene.camera, scene.settings, {});
    for (int channel = 0; channel < sums.channels; ++channel) {
      double largest = 0.0;
      for (std::size_t i = 0; i < sums.pixelCount(); ++i) largest = std::max(largest, sums.value(SumChannel(channel), i));
      EXPECT_LT(0.5 * kShares * std::ldexp(1.0, -sums.digits[std::size_t(channel)]), 1e-7 * largest) << channel;
    }
  }
}

/// An opaque block, of which a single share has an optical depth beyond the range, and a volume with nothing in it.
TEST_F(SharesTest, OpaqueAndEmptyVolumesResolveAsTheyAre) {
  const auto cube = [](double density) { return makeVolume({20, 20, 20}, cubeTransform({20, 20, 20}), [&](int, int, int) { return density; }); };
  const Volume opaque = cube(1e6), empty = cube(0.0);
  const Camera camera = framingCamera(opaque, 35.0, 25.0, 1.0, {});
  Renderer ofOpaque(device(), opaque, {}, {}), ofEmpty(device(), empty, {}, {});
  for (const Draw draw : {Draw::Splats, Draw::Gather}) {
    FrameSettings settings{.size = {32, 32}, .method = GatherSettings{.endTransmittance = 0.0f}};
    if (draw == Draw::Splats) settings.method = SplatSettings{};
    const Image image = resolveSums(ofOpaque.renderShares(camera, settings, {}), true);
    EXPECT_NEAR(image.pixels[32 * 16 + 16].a, 1.0f, 2e-6f);  // the stencil knows no less transmittance than 1e-6
    EXPECT_LE(largestPixelDifference(image, ofOpaque.render(camera, settings)), draw == Draw::Splats ? 1e-4 : 5e-4);
    for (const glm::vec4& pixel : resolveSums(ofEmpty.renderShares(camera, settings, {1, 2}), true).pixels) EXPECT_EQ(pixel, glm::vec4(0.0f));
  }
}

}  // namespace
}  // namespace freevoxels
