// Frames by gathering: against closed forms, a plain sum on the CPU and the oracle, and what must not happen.

#include <algorithm>
#include <cmath>

#include "engine/gathering/gather_frame.h"
#include "engine/gathering/gather_stages.h"
#include "engine/image/metrics.h"
#include "engine/reference/reference_gather.h"
#include "engine/renderer_stages.h"
#include "engine/splatting/frame_constants.h"
#include "engine/validation/quality_scenes.h"
#include "engine/volume/voxel_classifier.h"
#include "shaders/gather_interface.h"
#include "tests/device/gather_fixture.h"

namespace freevoxels {
namespace {

TEST_F(GatherTest, HomogeneousBoxIsTheLawOfBeerAndLambert) {
  const Volume box = makeVolume({20, 20, 12}, cubeTransform({20, 20, 12}), [](int, int, int) { return 1.0; });
  const double voxel = glm::length(glm::dvec3(box.indexToWorld[2]));
  for (const double depth : {1e-4, 0.3, 3.0, 40.0}) {
    const Classification classification{.densityScale = depth / (12.0 * voxel), .albedo = glm::vec3(0.8f, 0.5f, 0.2f)};
    Renderer renderer(device(), box, classification, {});
    const glm::ivec2 size(31, 31);
    const Image image = renderer.render(alongZ(box, size, 3.0), gathering(size));
    const glm::vec4 middle = image.pixels[15 + 15 * 31];
    const double alpha = 1.0 - std::exp(-depth);
    // 1 - A of 32-bit floats is off by some 1e-7 a slice, whatever alpha is.
    EXPECT_NEAR(middle.a, alpha, 1e-3 * alpha + 2e-6) << depth;
    EXPECT_NEAR(middle.r, 0.8 * alpha, 2e-3 * alpha + 2e-6) << depth;
    EXPECT_NEAR(middle.b, 0.2 * alpha, 2e-3 * alpha + 2e-6) << depth;
  }
}

/// Along an axis, with a pixel a voxel in the middle of each, the stencil and the interpolation change nothing: front to
/// back compositing of the voxels behind the pixel.
TEST_F(GatherTest, MatchesTheSumAlongAnAxis) {
  const glm::ivec3 n(17, 13, 21);
  const Volume volume = randomVolume(n, cubeTransform(n), 0.6, 1.0);
  Classification classification = coloured(volume, 0.5f);
  classification.order = ClassificationOrder::Pre;
  Renderer renderer(device(), volume, classification, {});
  const glm::ivec2 size(n.x, n.y);
  FrameSettings settings = gathering(size);
  settings.gather().sampleTolerance = 0.0f;
  const GatherStages stages = RendererStages(renderer).renderGatherStages(alongZ(volume, size, 1.0), settings);
  ASSERT_EQ(stages.lattice.pitch, 0.5);
  const std::vector<double> extinction = referenceExtinction(volume, classification);
  const VoxelClassifier classifier(classification, volume);
  const double layer = glm::length(glm::dvec3(volume.indexToWorld[2]));
  for (int y = 0; y < n.y; ++y)
    for (int x = 0; x < n.x; ++x) {
      glm::dvec4 sum(0.0);
      for (int z = n.z - 1; z >= 0; --z) {
        const double opacity = 1.0 - std::exp(-layer * extinction[std::size_t(x + n.x * (y + n.y * z))]);
        const glm::dvec3 color(classifier.at({x, y, z}).color);
        sum += (1.0 - sum.a) * opacity * glm::dvec4(color, 1.0);
      }
      const glm::ivec2 sample = shader::kLatticeMargin + 2 * glm::ivec2(x, n.y - 1 - y);  // in the middle of a pixel and a voxel
      const GatherSums& sums = stages.gathered[std::size_t(sample.x + stages.lattice.samples.x * sample.y)];
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(c < 3 ? sums.color[c] : sums.energy, sum[c], 2e-3) << x << ' ' << y << ' ' << c;
    }
}

/// As the viewer draws while the camera moves: a sample a pixel or fewer, with all voxels and the light of the whole image.
TEST_F(GatherTest, DraftsHaveAsManySamplesAsTheirQualitySaysAndShowTheSame) {
  const QualityScene head = makeQualityScene({"head", QualityColor::Bone, false}, 64, makeProcedural("head", 64));
  Renderer renderer(device(), head.volume, head.classification, {});
  const Camera camera = framingCamera(head.volume, 35.0, 25.0, 1.0, {});
  FrameSettings settings = gathering({96, 96});
  settings.lighting = Lighting{.lights = {{.place = {1.0, 0.5, 0.5}}}, .ambient = glm::dvec3(0.2), .surface = 1.0};
  const Image whole = renderer.render(camera, settings);
  for (const double quality : {0.5, 0.25}) {
    FrameSettings draft = settings;
    draft.gather().sampleTolerance = 0.0f;
    draft.quality = quality;
    const GatherStages stages = RendererStages(renderer).renderGatherStages(camera, draft);
    EXPECT_EQ(stages.lattice.pitch, 0.5 / quality);
    EXPECT_GT(psnr(stages.image, whole), quality == 0.5 ? 33.0 : 26.0) << quality;
  }
}

TEST_F(GatherTest, IsAsNearToTheOracleAsSplats) {
  const QualityScene head =
      makeQualityScene({"head", QualityColor::Bone, false}, 48, makeProcedural("head", 48));
  const Scene scene{.volume = head.volume, .classification = head.classification};
  Camera orthographic;
  orthographic.orthographic = true;
  for (const Camera& base : {Camera{}, orthographic})
    for (const glm::dvec2 angles : {glm::dvec2(35.0, 25.0), {80.0, 10.0}, {200.0, 75.0}}) {
      const Camera camera = framingCamera(scene.volume, angles.x, angles.y, 1.0, base);
      const std::vector<double> quality =
          qualitiesOf(scene, camera, {{.size = {128, 128}, .method = SplatSettings{}}, gathering({128, 128})});
      EXPECT_GE(quality[1], quality[0] - 0.3) << angles.x << ' ' << angles.y;
      EXPECT_GE(quality[1], 40.0) << angles.x << ' ' << angles.y;
    }
}

/// A ramp of the scalar along z passes a peak of the transfer function between two voxels, neither of which is in it.
TEST_F(GatherTest, AThinPeakBetweenVoxelsHasItsWholeArea) {
  const Volume ramp = makeVolume({20, 20, 12}, cubeTransform({20, 20, 12}), [](int, int, int z) { return z; });
  const double voxel = glm::length(glm::dvec3(ramp.indexToWorld[2]));
  Classification classification;
  classification.transferFunction = TransferFunction{.opacity = {{5.3f, 0.0f}, {5.5f, 0.6f}, {5.7f, 0.0f}},
                                                     .color = {{0.0f, {1.0f, 0.0f, 0.0f}}, {11.0f, {0.0f, 1.0f, 0.0f}}},
                                                     .unitDistance = 0.1 * voxel};
  // Opacity rises to 0.6 and falls again, over 0.2 voxels each. Depth is the integral of -log(1 - opacity) over distance in units of
  // unitDistance, 0.1 voxels.
  const double depth = 0.4 * 10.0 * (1.0 + 0.4 / 0.6 * std::log(0.4));
  const glm::ivec2 size(31, 31);
  Renderer renderer(device(), ramp, classification, {});
  const glm::vec4 middle = renderer.render(alongZ(ramp, size, 3.0), gathering(size)).pixels[15 + 15 * 31];
  const double alpha = 1.0 - std::exp(-depth);
  EXPECT_NEAR(middle.a, alpha, 5e-3 * alpha);
  EXPECT_NEAR(middle.g, 5.5 / 11.0 * alpha, 1e-2 * alpha);
}

TEST_F(GatherTest, ClassifyingAfterInterpolationComesNearerToTheOracle) {
  QualityScene head = makeQualityScene({"head", QualityColor::Bone, false}, 48, makeProcedural("head", 48));
  head.classification.order = ClassificationOrder::Post;
  const Camera camera = framingCamera(head.volume, 80.0, 10.0, 1.0, {});
  const FrameSettings settings = gathering({128, 128});
  const Oracle oracle =
      renderOracle(head.volume, head.classification, camera, {.size = settings.size, .tolerance = 4e-3});
  const auto qualityOf = [&](ClassificationOrder order) {
    Classification classification = head.classification;
    classification.order = order;
    Renderer renderer(device(), head.volume, classification, {});
    return psnr(renderer.render(camera, settings), oracle.image);
  };
  const double post = qualityOf(ClassificationOrder::Post);
  EXPECT_GE(post, 42.0);
  EXPECT_GE(post, qualityOf(ClassificationOrder::Pre) + 6.0);
}

/// Sparse, sheared, lit, with coarse levels and the eye inside: all that classification after interpolation has to
/// agree with.
TEST_F(GatherTest, InterpolatedScalarsMatchTheOracleWhereverTheyAreRead) {
  const glm::ivec3 n(30, 26, 34);
  const auto blob = [](int x, int y, int z) {
    const double r = glm::length(glm::dvec3(x, y, z) - glm::dvec3(14.3, 12.1, 17.2)) / 12.0;
    return r > 1.0 ? double(kInactiveVoxel) : (1.0 - r) * (1.0 + 0.2 * std::sin(0.9 * x + 0.5 * y));
  };
  Scene scene{.volume = makeVolume(n, shearedTransform(n), blob), .classification = {}};
  scene.classification.transferFunction = TransferFunction{.opacity = {{0.1f, 0.0f}, {0.2f, 0.1f}, {0.5f, 0.05f}, {0.6f, 0.5f}},
                                                           .color = {{0.1f, {0.9f, 0.5f, 0.3f}}, {0.6f, {0.4f, 0.6f, 0.9f}}},
                                                           .unitDistance = scene.volume.voxelSize()};
  const Camera far = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  EXPECT_GE(qualityOf(scene, far, gathering({64, 64})), 42.0);
  FrameSettings lit = gathering({40, 40});
  lit.lighting = Lighting{.lights = {{}}};
  EXPECT_GE(qualityOf(scene, far, lit), 30.0);
  Camera inside;
  inside.position = glm::dvec3(scene.volume.indexToWorld * glm::dvec4(5.3, 12.1, 17.7, 1.0));
  inside.lookAt = glm::dvec3(scene.volume.indexToWorld * glm::dvec4(25.0, 12.0, 16.0, 1.0));
  inside.verticalFov = 70.0;
  EXPECT_GE(qualityOf(scene, inside, gathering({64, 64})), 38.0);
  Camera distant = far;
  distant.position = far.lookAt + 6.0 * (far.position - far.lookAt);
  FrameSettings coarse = gathering({96, 96});
  coarse.lod = 1.0f;
  EXPECT_GE(qualityOf(scene, distant, coarse), 38.0);
}

TEST_F(GatherTest, EyeInsideMatchesTheOracle) {
  const Scene scene = cloud(48);
  for (const glm::dvec3 direction : {glm::dvec3(0.2, -0.1, -1.0), {1.0, 0.4, 0.3}}) {
    Camera camera;
    camera.position = glm::dvec3(scene.volume.indexToWorld * glm::dvec4(22.3, 25.1, 30.7, 1.0));
    camera.lookAt = camera.position + direction;
    camera.verticalFov = 80.0;
    EXPECT_GE(qualityOf(scene, camera, gathering({96, 96})), 40.0);
  }
}

TEST_F(GatherTest, ShearedGridMatchesTheOracle) {
  Scene scene = cloud(32);
  scene.volume.indexToWorld = shearedTransform(scene.volume.dimensions);
  scene.classification.densityScale = automaticDensityScale(scene.volume, 2.0);
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  EXPECT_GE(qualityOf(scene, camera, gathering({96, 96})), 40.0);
}

TEST_F(GatherTest, CoarseLevelsLookLikeVoxels) {
  const Volume volume = makeProcedural("cloud", 96);
  const Classification classification{.densityScale = automaticDensityScale(volume, 2.0)};
  Renderer renderer(device(), volume, classification, {});
  Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  camera.position = camera.lookAt + 4.0 * (camera.position - camera.lookAt);
  FrameSettings settings = gathering({96, 96});
  const Image voxels = renderer.render(camera, settings);
  settings.lod = 1.0f;
  EXPECT_GE(psnr(renderer.render(camera, settings), voxels), 45.0);
}

/// Past 45 degrees rays march along another axis. Beyond 60 dB, an error of a thousandth, nothing is seen of a step.
TEST_F(GatherTest, CoarseBlocksAreWholeBeyondTheVolume) {
  const glm::ivec3 size(64, 64, 64);
  const Volume box = makeVolume(size, cubeTransform(size), [](int, int, int) { return 1.0; });
  const Classification classification{.densityScale = 2.0};
  const Camera camera = alongZ(box, {96, 96}, 0.5);
  FrameSettings settings = gathering({96, 96});
  settings.lod = 16.0f;
  Renderer renderer(device(), box, classification, {});
  const GatherStages stages = RendererStages(renderer).renderGatherStages(camera, settings);
  const ReferenceGather reference(box, classification, camera, settings);
  ASSERT_GE(reference.detail().coarsest, 4);
  const std::vector<GatherSums> samples = reference.samples(stages.blocks);
  ASSERT_EQ(stages.gathered.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_NEAR(stages.gathered[i].energy, samples[i].energy, 1e-4) << "sample " << i;
  const Image image = reference.image(reference.smoothed(samples));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) EXPECT_NEAR(stages.image.pixels[i].a, image.pixels[i].a, 1e-4) << "pixel " << i;
}

TEST_F(GatherTest, ATurntableShowsNoStepWhereTheAxisChanges) {
  const Scene scene = cloud(32);
  std::vector<Camera> cameras;
  for (const double azimuth : {43.0, 44.0, 44.9, 45.1, 46.0, 47.0}) cameras.push_back(framingCamera(scene.volume, azimuth, 10.0, 1.0, {}));
  const std::vector<double> found = qualities(scene, cameras, 64);
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_NEAR(std::min(found[i], 60.0), std::min(found[i - 1], 60.0), 0.5) << "frame " << i;
}

/// The octree's next level comes in slice by slice, over several per cent of the distance, and not at once.
TEST_F(GatherTest, ASlowZoomShowsNoStepWhereTheLevelChanges) {
  constexpr double kMaxChange = 1.0 / 8.0 / 255.0;  // of the error, RMSE: an eighth of a code of an 8-bit image
  const Scene scene = cloud(64);
  const Camera framed = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  std::vector<Camera> cameras;
  for (int i = 0; i < 10; ++i) {
    cameras.push_back(framed);
    cameras.back().position = framed.lookAt + 1.98 * std::pow(1.007, i) * (framed.position - framed.lookAt);
  }
  const std::vector<double> found = qualities(scene, cameras, 96);
  const auto error = [&](std::size_t i) { return std::pow(10.0, -0.05 * found[i]); };
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_NEAR(error(i), error(i - 1), kMaxChange) << "frame " << i;
  EXPECT_LT(found.back(), found.front() - 1.0);  // the level did change
}

/// So does it for an orthographic camera, to which all blocks of a level are equally small.
TEST_F(GatherTest, ASlowOrthographicZoomShowsNoStepWhereTheLevelChanges) {
  const Scene scene = cloud(64);
  Renderer renderer(device(), scene.volume, scene.classification, {});
  Camera camera;
  camera.orthographic = true;
  camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, camera);
  const double framed = camera.orthographicHeight;
  FrameSettings settings{.size = {96, 96}};
  Image last;
  double largestStep = 0.0, largestError = 0.0;
  for (int i = 0; i < 16; ++i) {
    camera.orthographicHeight = 1.88 * framed * std::pow(1.02, i);
    const auto render = [&](float lod) {
      settings.lod = lod;
      return renderer.render(camera, settings);
    };
    // The image less that of the voxels is the error of the levels. If the level changed at once, its first step would be all of it.
    Image error = render(1.0f);
    const Image voxels = render(0.0f);
    for (std::size_t p = 0; p < error.pixels.size(); ++p) error.pixels[p] -= voxels.pixels[p];
    const auto difference = [](const Image& a, const Image* b) {
      double sum = 0.0;
      for (std::size_t p = 0; p < a.pixels.size(); ++p) {
        const glm::vec4 d = a.pixels[p] - (b ? b->pixels[p] : glm::vec4(0.0f));
        sum += double(glm::dot(d, d)) / 4.0;
      }
      return std::sqrt(sum / double(a.pixels.size()));
    };
    if (i > 0) largestStep = std::max(largestStep, difference(error, &last));
    largestError = std::max(largestError, difference(error, nullptr));
    last = std::move(error);
  }
  EXPECT_GT(largestError, 0.0);
  EXPECT_LT(largestStep, 0.6 * largestError);
}

TEST_F(GatherTest, DistanceIsTheMeanOfWhatIsSeen) {
  const glm::ivec3 n(16, 16, 16);
  const Volume slice =
      makeVolume(n, cubeTransform(n), [](int, int, int z) { return z == 11 ? 1.0 : 0.0; });
  Renderer renderer(device(), slice, {.densityScale = 5.0}, {});
  const glm::ivec2 size(15, 15);
  FrameSettings settings = gathering(size);
  settings.depth = true;
  const Camera camera = alongZ(slice, size, 2.0);
  const Image image = renderer.render(camera, settings);
  const double z = (slice.indexToWorld * glm::dvec4(8.0, 8.0, 11.0, 1.0)).z;
  EXPECT_NEAR(image.depth[7 + 7 * 15], camera.position.z - z, 1e-3);
}

TEST_F(GatherTest, DistanceOfFaintPixelsIsWithinTheVolume) {
  const Scene scene = cloud(48);
  Renderer renderer(device(), scene.volume, scene.classification, {});
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 4.0 / 3.0, {});
  FrameSettings settings = gathering({160, 120});
  settings.depth = true;
  const Image image = renderer.render(camera, settings);
  const glm::dvec3 diagonal(glm::dmat3(scene.volume.indexToWorld) * glm::dvec3(scene.volume.dimensions));
  const double middle = glm::length(camera.lookAt - camera.position), reach = 0.5 * glm::length(diagonal);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (std::isinf(image.depth[i])) continue;
    EXPECT_GT(image.depth[i], middle - reach) << i << " with alpha " << image.pixels[i].a;
    EXPECT_LT(image.depth[i], middle + reach) << i << " with alpha " << image.pixels[i].a;
  }
}

TEST_F(GatherTest, IsTheSameToTheBitEveryTime) {
  const Volume volume = makeProcedural("cloud", 40);
  const Classification classification{.densityScale = automaticDensityScale(volume, 2.0)};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 1.0, {});
  FrameSettings settings = gathering({120, 90});
  settings.lighting = Lighting{.lights = {{}}};
  Renderer first(device(), volume, classification, {}), second(device(), volume, classification, {});
  const Image image = first.render(camera, settings);
  EXPECT_TRUE(image.pixels == first.render(camera, settings).pixels);
  EXPECT_TRUE(image.pixels == second.render(camera, settings).pixels);
}

/// Blocks of a cloud, interpolated scalars of a head, and flames without smoke, which have no energy.
TEST_F(GatherTest, RaysBetweenSmoothOnesAreInterpolatedWithoutATrace) {
  const auto check = [](const char* name, const Classification& classification) {
    SCOPED_TRACE(name);
    const Volume volume = makeProcedural(name, 64);
    Renderer renderer(device(), volume, classification, {});
    const Camera camera = framingCamera(volume, 35.0, 25.0, 4.0 / 3.0, {});
    FrameSettings settings = gathering({400, 300});
    const Image adaptive = renderer.render(camera, settings);
    settings.gather().sampleTolerance = 1e-30f;
    const Image listed = renderer.render(camera, settings);
    settings.gather().sampleTolerance = 0.0f;
    const Image whole = renderer.render(camera, settings);
    EXPECT_GT(std::ranges::count_if(whole.pixels, [](glm::vec4 pixel) { return pixel.r > 0.1f; }), 1000);
    EXPECT_GE(compareImages(adaptive, whole).psnr, 60.0);
    EXPECT_NE(adaptive.pixels, whole.pixels);
    EXPECT_GE(compareImages(listed, whole).psnr, 130.0);
  };
  check("cloud", {.densityScale = 10.0});
  check("head", coloured(makeProcedural("head", 64), 0.2f));
  check("fire", {.densityScale = 0.0, .emission = Emission{.strength = 5.0}});
}

TEST_F(GatherTest, InterpolatedRaysKeepTheEdgesOfDepthBetweenSurfacesOfTheSameColour) {
  const glm::ivec3 size(24, 24, 24);
  const Volume steps = makeVolume(size, cubeTransform(size), [](int x, int y, int z) { return (x + y < 24 ? z < 20 : z < 8) ? 1.0 : 0.0; });
  Renderer renderer(device(), steps, {.densityScale = 2000.0}, {});
  const Camera camera = alongZ(steps, {96, 96}, 4.0);
  FrameSettings settings = gathering({96, 96});
  settings.depth = true;
  const Image adaptive = renderer.render(camera, settings);
  settings.gather().sampleTolerance = 0.0f;
  const Image whole = renderer.render(camera, settings);
  const auto [nearest, farthest] = std::ranges::minmax(whole.depth);
  const float voxel = float(glm::length(glm::dvec3(steps.indexToWorld[0])));
  EXPECT_GT(std::ranges::count_if(whole.depth, [&](float depth) { return depth > nearest + 8.0f * voxel; }), 1000);
  for (std::size_t i = 0; i < whole.depth.size(); ++i)
    if (std::isfinite(whole.depth[i]) || std::isfinite(adaptive.depth[i])) {
      EXPECT_NEAR(adaptive.depth[i], whole.depth[i], 0.25f * voxel) << "pixel " << i % 96 << ", " << i / 96;
    }
}

TEST_F(GatherTest, NothingIsDrawnOfAnEmptyVolume) {
  const Volume empty = makeVolume({9, 9, 9}, cubeTransform({9, 9, 9}), [](int, int, int) { return 0.0; });
  Renderer renderer(device(), empty, {.densityScale = 1.0}, {});
  for (const glm::vec4& pixel : renderer.render(alongZ(empty, {20, 20}, 2.0), gathering({20, 20})).pixels)
    EXPECT_EQ(pixel, glm::vec4(0.0f));
}

/// Single blocks at the far corner are small enough for the next level long before a whole slice of them is. To classify all voxels for a
/// level that no ray reads takes many times as long as the frame.
TEST_F(GatherTest, ScalarsAreNotMadeIntoBlocksForALevelThatNoRayReads) {
  const Volume head = makeProcedural("head", 64);
  Classification classification = coloured(head, 0.3f);
  classification.order = ClassificationOrder::Post;
  const Camera camera = framingCamera(head, 45.0, 35.0, 1.0, {});
  const DeviceVolume outline = outlineOnDevice(head, classification);
  int unread = 0, read = 0;
  for (int pixels = 96; pixels > 16; pixels -= 4) {
    FrameSettings settings = gathering(glm::ivec2(pixels));
    settings.lod = 1.0f;
    const FrameConstants constants = makeFrameConstants(device(), outline, {}, camera, settings);
    const int coarsest = makeGatherFrame(outline, camera, settings, constants.detail, constants.endTransmittance).coarsest;
    const bool differs = constants.detail.coarsest > 0 && coarsest == 0;
    int& tried = differs ? unread : read;
    if (constants.detail.coarsest == 0 || tried > 0) continue;
    ++tried;
    Renderer renderer(device(), head, classification, {});
    renderer.render(camera, settings);
    EXPECT_EQ(std::ranges::count(renderer.frameTimings(), "pack", &StageTime::name), coarsest > 0 ? 1 : 0) << pixels;
    settings.lod = 0.0f;
    if (differs) {
      const Image fine = Renderer(device(), head, classification, {}).render(camera, settings);
      settings.lod = 1.0f;
      EXPECT_EQ(renderer.render(camera, settings).pixels, fine.pixels);
    }
  }
  EXPECT_EQ(unread, 1);
  EXPECT_EQ(read, 1);
}

}  // namespace
}  // namespace freevoxels
