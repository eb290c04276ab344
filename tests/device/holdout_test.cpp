// Rays that end at the depths of surfaces from elsewhere: closed forms, and the oracle with the same depths.

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/renderer.h"
#include "engine/validation/stage_frames.h"
#include "tests/device/gather_fixture.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

class HoldoutTest : public GatherTest {
 protected:
  using Depths = std::vector<float>;

  static std::shared_ptr<const Holdout> holdout(glm::ivec2 size, const std::function<float(glm::ivec2)>& depthOf) {
    Holdout made{.size = size, .depths = {}};
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) made.depths.push_back(depthOf({x, y}));
    return std::make_shared<const Holdout>(std::move(made));
  }

  /// The ray of a pixel's middle in the world.
  static std::pair<glm::dvec3, glm::dvec3> rayOf(const Camera& camera, glm::ivec2 size, glm::ivec2 pixel) {
    const PixelRays rays = pixelRays(camera, size, glm::dmat4(1.0));
    const glm::dvec2 at = glm::dvec2(pixel) + 0.5;
    return {rays.origin + at.x * rays.originX + at.y * rays.originY, rays.direction + at.x * rays.directionX + at.y * rays.directionY};
  }

  /// A ball, and behind it a tilted plane that ends at half of the image's height.
  static std::shared_ptr<const Holdout> ballAndPlane(const Camera& camera, glm::ivec2 size, glm::dvec3 middle, double radius) {
    return holdout(size, [&](glm::ivec2 pixel) {
      const auto [origin, direction] = rayOf(camera, size, pixel);
      const glm::dvec3 from = origin - middle;
      const double a = glm::dot(direction, direction), b = glm::dot(from, direction), c = glm::dot(from, from) - radius * radius;
      const double root = b * b - a * c, near = root > 0.0 ? (-b - std::sqrt(root)) / a : -1.0;
      if (near > 0.0) return float(near);
      const glm::dvec3 normal(0.2, 1.0, 0.5);
      const double plane = glm::dot(middle + glm::dvec3(0.05, -0.1, 0.0) - origin, normal) / glm::dot(direction, normal);
      return pixel.y > size.y / 2 && plane > 0.0 ? float(plane) : kNothing;
    });
  }
  static glm::dvec3 middleOf(const Volume& volume) {
    return glm::dvec3(volume.indexToWorld * glm::dvec4(0.5 * glm::dvec3(volume.dimensions - 1), 1.0));
  }
  static Image oracleOf(const Scene& scene, const Camera& camera, const FrameSettings& settings) {
    return renderOracle(
               scene.volume, scene.classification, camera,
               {.size = settings.size, .tolerance = 4e-3, .maximumSamples = 8, .lighting = settings.lighting, .holdout = settings.holdout})
        .image;
  }
  /// PSNR to the oracle in front of a ball and a plane in the middle of the volume.
  static double quality(const Scene& scene, const Camera& camera, FrameSettings settings) {
    settings.holdout = ballAndPlane(camera, settings.size, middleOf(scene.volume), 0.22);
    const Image image = Renderer(device(), scene.volume, scene.classification, {}).render(camera, settings);
    return psnr(image, oracleOf(scene, camera, settings));
  }
};

/// Half of the pixels see what is in front of an exact depth.
TEST_F(HoldoutTest, AlphaOfFogIsThatOfItsLengthInFront) {
  const double sigma = 1.3;
  const Volume box = makeVolume(glm::ivec3(33), cubeTransform(glm::ivec3(33)), [](int, int, int) { return 1.0; });
  FrameSettings settings = gathering({24, 18});
  Camera camera = alongZ(box, settings.size, 1.2);
  const double voxel = box.voxelSize();
  for (const double length : {0.31, 0.5, 0.777}) {
    const double depth = 10.0 - 0.5 * 33 * voxel + length;  // behind the first face, which is half a voxel in front of the first centre
    settings.holdout = holdout(settings.size, [&](glm::ivec2 pixel) {
      return pixel.x < 11 ? float(depth) : pixel.x == 11 ? 0.0f : kNothing;
    });
    for (const ClassificationOrder order : {ClassificationOrder::Post, ClassificationOrder::Pre}) {
      Classification classification{.densityScale = sigma};
      if (order == ClassificationOrder::Post)
        classification = {.transferFunction =
                              TransferFunction{.opacity = {{0.0f, float(1.0 - std::exp(-sigma))}}, .color = {{0.0f, glm::vec3(1.0f)}}}};
      const Image image = Renderer(device(), box, classification, {}).render(camera, settings);
      const auto at = [&](int x, int y) { return image.pixels[std::size_t(y) * 24 + std::size_t(x)].a; };
      EXPECT_NEAR(at(5, 9), 1.0 - std::exp(-sigma * length), 1e-3) << length;
      EXPECT_NEAR(at(10, 8), 1.0 - std::exp(-sigma * length), 1e-3) << length;
      EXPECT_EQ(at(11, 8), 0.0f);
      EXPECT_NEAR(at(12, 8), 1.0 - std::exp(-sigma * 33 * voxel), 1e-3);
    }
  }
}

TEST_F(HoldoutTest, ACloudInFrontOfSurfacesMatchesTheOracle) {
  const Scene scene = cloud(37);
  const Camera outside = framingCamera(scene.volume, 35.0, 25.0, 1.25, {});
  EXPECT_GE(quality(scene, outside, gathering({55, 44})), 55.0);
  EXPECT_GE(quality(scene, outside, gathering({15, 12})), 42.0);
  EXPECT_GE(quality(scene, cameraInside(scene.volume, outside), gathering({40, 32})), 50.0);
  EXPECT_GE(quality(scene, framingCamera(scene.volume, 200.0, -50.0, 1.25, {.orthographic = true}), gathering({55, 44})), 55.0);
}

TEST_F(HoldoutTest, ALitScanInFrontOfSurfacesMatchesTheOracle) {
  Scene scene{.volume = makeProcedural("head", 24), .classification = {}};
  scene.classification = coloured(scene.volume, 0.4f);
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.25, {});
  FrameSettings settings = gathering({25, 20});
  EXPECT_GE(quality(scene, camera, settings), 48.0);
  settings.lighting = Lighting{.lights = {{.place = {0.4, 1.0, 0.3}}}, .scattering = 1};
  EXPECT_GE(quality(scene, camera, settings), 45.0);
}

TEST_F(HoldoutTest, FlamesInFrontOfSurfacesMatchTheOracle) {
  Scene scene{.volume = makeProcedural("fire", 32), .classification = {.densityScale = 4.0, .emission = Emission{.strength = 5.0}}};
  FrameSettings settings = gathering({40, 32});
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.25, {});
  EXPECT_GE(quality(scene, camera, settings), 50.0);
  settings.lighting = Lighting{.lights = {{.place = {0.4, 1.0, 0.3}}}, .scattering = 1};
  EXPECT_GE(quality(scene, camera, settings), 50.0);
}

/// Whole, cube by cube and as shares it is one image.
TEST_F(HoldoutTest, CubesAndSharesAreTheWholeImage) {
  const Scene scene = cloud(70);
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.25, {});
  FrameSettings settings{.size = {61, 47}, .depth = true};
  settings.holdout = ballAndPlane(camera, settings.size, middleOf(scene.volume), 0.2);
  Renderer renderer(device(), scene.volume, scene.classification, {});
  const Image whole = renderer.render(camera, settings);
  FixedSums sums = renderer.renderShares(camera, settings, {.index = 0, .count = 2});
  sums += renderer.renderShares(camera, settings, {.index = 1, .count = 2});
  const Image shared = resolveSums(sums, true);
  EXPECT_LE(largestPixelDifference(shared, whole), 2e-5);
  for (std::size_t i = 0; i < whole.depth.size(); ++i)
    if (settings.holdout->depths[i] < kNothing && std::isfinite(whole.depth[i])) {
      EXPECT_LE(whole.depth[i], settings.holdout->depths[i] * 1.0001f);
    }
  settings.gather().sampleTolerance = 0.0f;  // as cubes have every ray marched
  settings.lod = 0.0f;
  const Image marched = renderer.render(camera, settings);
  renderer.requireCubes();
  EXPECT_GE(psnr(renderer.render(camera, settings), marched), 90.0);
}

/// Two clouds through each other.
TEST_F(HoldoutTest, SeveralVolumesInFrontOfSurfacesMatchTheOracle) {
  const Scene one = cloud(33);
  Volume moved = one.volume;
  moved.indexToWorld[3] += glm::dvec4(0.21, 0.13, -0.08, 0.0);
  const std::array<const Volume*, 2> volumes{&one.volume, &moved};
  std::vector<SceneVolume> scene;
  std::vector<PlacedMedium> placed;
  for (const Volume* volume : volumes) {
    scene.push_back(
        {.source = std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(*volume)), .classification = one.classification});
    placed.push_back({volume, &one.classification});
  }
  const Camera camera = framingCamera(one.volume, 35.0, 25.0, 1.0, {});
  FrameSettings settings = gathering({40, 40});
  settings.holdout = ballAndPlane(camera, settings.size, middleOf(one.volume), 0.2);
  const Oracle oracle =
      renderOracle(placed, camera, {.size = settings.size, .tolerance = 4e-3, .maximumSamples = 8, .holdout = settings.holdout});
  EXPECT_GE(psnr(Renderer(device(), scene, {}).render(camera, settings), oracle.image), 48.0);
}

/// The depth that one render writes is a holdout of another: a thin opaque shell holds out all that is behind it.
TEST_F(HoldoutTest, DepthOfOneImageHoldsOutAnother) {
  const Scene scene = cloud(33);
  const glm::ivec3 n(33);
  const Volume ball = makeVolume(n, scene.volume.indexToWorld, [n](int x, int y, int z) {
    return glm::length(glm::dvec3(x, y, z) - 0.5 * glm::dvec3(n - 1)) < 8.0 ? 1.0 : 0.0;
  });
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  FrameSettings settings = gathering({48, 48});
  settings.depth = true;
  const Image opaque = Renderer(device(), ball, {.densityScale = 1e4}, {}).render(camera, settings);
  const double radius = 8.0 * scene.volume.voxelSize();
  const auto expected = ballAndPlane(camera, settings.size, middleOf(ball), radius);
  EXPECT_NEAR(opaque.depth[24 * 48 + 24], expected->depths[24 * 48 + 24], scene.volume.voxelSize());
  settings.holdout = std::make_shared<const Holdout>(Holdout{.size = settings.size, .depths = opaque.depth});
  Renderer renderer(device(), scene.volume, scene.classification, {});
  EXPECT_GE(psnr(renderer.render(camera, settings), oracleOf(scene, camera, settings)), 48.0);
}

/// Edges lie between pixels, whatever the size of voxels: beyond them nothing changes.
TEST_F(HoldoutTest, PixelsDoNotDependOnTheDepthsOfOthers) {
  const Scene scene = cloud(20);
  const Camera camera = framingCamera(scene.volume, 35.0, 25.0, 1.0, {});
  FrameSettings settings = gathering({48, 48});
  settings.gather().sampleTolerance = 0.0f;
  Renderer renderer(device(), scene.volume, scene.classification, {});
  settings.holdout = holdout(settings.size, [](glm::ivec2) { return kNothing; });
  const Image open = renderer.render(camera, settings);
  settings.holdout = holdout(settings.size, [](glm::ivec2 pixel) { return (pixel.x + pixel.y) % 2 == 0 ? 0.0f : kNothing; });
  const Image checkered = renderer.render(camera, settings);
  for (int i = 0; i < 48 * 48; ++i)
    EXPECT_EQ(checkered.pixels[std::size_t(i)], (i % 48 + i / 48) % 2 == 0 ? glm::vec4(0.0f) : open.pixels[std::size_t(i)]);
  settings.holdout = nullptr;
  EXPECT_GE(psnr(open, renderer.render(camera, settings)), 48.0);
}

TEST_F(HoldoutTest, WhatHasNoRaysOrAnotherSizeIsRefused) {
  const Scene scene = cloud(8);
  FrameSettings settings = gathering({4, 5});
  Renderer renderer(device(), scene.volume, scene.classification, {});
  settings.holdout = holdout({5, 4}, [](glm::ivec2) { return kNothing; });
  test::expectRefusal([&] { renderer.render({}, settings); }, ErrorKind::Usage, {"5x4 pixels", "4x5"});
  settings.size = {5, 4};
  settings.method = SplatSettings{};
  test::expectRefusal([&] { renderer.render({}, settings); }, ErrorKind::Usage, {"holdout", "splats"});
}

}  // namespace
}  // namespace freevoxels
