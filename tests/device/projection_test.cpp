// Projections of values and isosurfaces that are gathered: against the reference, whole and cube by cube, by shares, and from inside.

#include <cmath>
#include <limits>
#include <utility>

#include "engine/description/scene_description.h"
#include "engine/image/srgb.h"
#include "engine/renderer.h"
#include "engine/volume/scan.h"
#include "tests/device/gather_fixture.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

class ProjectionTest : public GatherTest {
 protected:
  static FrameSettings projecting(glm::ivec2 size, IntensityProjection projection) {
    FrameSettings settings = gathering(size);
    settings.gather().projection = projection;
    return settings;
  }
  /// Of a size that ends at no border of bricks and cubes.
  static Scene sceneOf(const char* name, int resolution, IntensityProjection projection) {
    Scene scene{.volume = makeProcedural(name, resolution), .classification = {}};
    scene.classification = ClassificationDescription().resolveProjected(scene.volume, projection);
    return scene;
  }
  /// Where a function whose opacity ascends has an opacity.
  static double scalarOf(const TransferFunction& function, double opacity) {
    for (std::size_t i = 1; i < function.opacity.size(); ++i) {
      const auto &a = function.opacity[i - 1], &b = function.opacity[i];
      if (opacity <= b.opacity) return a.scalar + (opacity - a.opacity) / (b.opacity - a.opacity) * (b.scalar - a.scalar);
    }
    return function.opacity.back().scalar;
  }
  static Image oracleOf(const Scene& scene, const Camera& camera, const FrameSettings& settings) {
    return renderOracle(scene.volume, scene.classification, camera,
                        {.size = settings.size, .depth = settings.depth, .tolerance = 4e-3, .maximumSamples = 8,
                         .projection = settings.gather().projection, .holdout = settings.holdout})
        .image;
  }
};

constexpr auto kBoth = {IntensityProjection::Maximum, IntensityProjection::Average};

/// The largest values of a shell as thin as a voxel are the hardest to meet.
TEST_F(ProjectionTest, MatchesTheReferenceFromOutsideAndInside) {
  for (const IntensityProjection projection : kBoth)
    for (const auto& [name, least] : {std::pair("cloud", 50.0), {"shells", 43.0}, {"head", 35.0}}) {
      const Scene scene = sceneOf(name, 45, projection);
      Renderer renderer(device(), scene.volume, scene.classification, {});
      FrameSettings settings = projecting({61, 47}, projection);
      settings.depth = true;
      Camera inside = framingCamera(scene.volume, 20, 10, 1.0, {});
      inside.position = glm::mix(inside.lookAt, inside.position, 0.1);
      inside.verticalFov = 90.0;
      Camera parallel = framingCamera(scene.volume, -50, 33, 1.0, {});
      parallel.orthographic = true;
      parallel.orthographicHeight = 1.1;
      for (const Camera& camera : {framingCamera(scene.volume, 35, 25, 61.0 / 47.0, {}), parallel, inside}) {
        const Image image = renderer.render(camera, settings), oracle = oracleOf(scene, camera, settings);
        const double decibels = psnr(image, oracle);
        std::printf("%s, projection %d: %.1f dB\n", name, int(projection), decibels);
        EXPECT_GT(decibels, least) << name << ' ' << int(projection);
      }
    }
}

TEST_F(ProjectionTest, CubesAndSharesHaveTheBitsOfTheWholeVolume) {
  for (const IntensityProjection projection : kBoth) {
    const Scene scene = sceneOf("cloud", 150, projection);
    const Camera camera = framingCamera(scene.volume, 35, 25, 1.0, {});
    FrameSettings settings = projecting({53, 53}, projection);
    settings.gather().sampleTolerance = 0.0f;
    Renderer whole(device(), scene.volume, scene.classification, {}), cubes(device(), scene.volume, scene.classification, {});
    const Image image = whole.render(camera, settings);
    cubes.requireCubes();
    const Image byCubes = cubes.render(camera, settings);
    EXPECT_TRUE(cubes.drewInCubes());
    if (projection == IntensityProjection::Maximum) {
      EXPECT_EQ(byCubes.pixels, image.pixels);
    } else {
      EXPECT_GT(psnr(byCubes, image), 100.0) << "sums in another order are rounded otherwise";
    }
    FixedSums sums = whole.renderShares(camera, settings, {.index = 0, .count = 3});
    for (const int part : {1, 2}) sums += whole.renderShares(camera, settings, {.index = part, .count = 3});
    EXPECT_GT(psnr(resolveSums(sums, settings.isNormalised()), image), 80.0);
  }
}

TEST_F(ProjectionTest, EndsAtAHoldout) {
  const glm::ivec3 size(9);
  Volume volume = makeVolume(size, cubeTransform(size), [](int, int, int z) { return 1.0 + z; });
  volume.isFog = true;
  for (const IntensityProjection projection : kBoth) {
    const Classification classification = ClassificationDescription().resolveProjected(volume, projection);
    FrameSettings settings = projecting({8, 8}, projection);
    const Camera camera = alongZ(volume, settings.size, 4.0);
    // Seen from +z, so that the first voxel has the largest value. The ray ends at the middle of the fifth.
    settings.holdout = std::make_shared<const Holdout>(Holdout{.size = settings.size, .depths = std::vector<float>(64, 10.0f)});
    const float alpha = Renderer(device(), volume, classification, {}).render(camera, settings).pixels[8 * 4 + 4].a;
    const double value = scalarOf(*classification.transferFunction, alpha);
    if (projection == IntensityProjection::Maximum) {
      EXPECT_NEAR(value, 9.0, 0.05);
    } else {
      EXPECT_NEAR(value, 7.1, 0.1) << "the mean of 9, 8, 7, 6 and half of 5, and of half a voxel in front of them";
    }
  }
}

TEST_F(ProjectionTest, RefusesSeveralVolumesLightsAndVoxelsWithoutValues) {
  const Scene scene = sceneOf("cloud", 20, IntensityProjection::Maximum);
  const Camera camera = framingCamera(scene.volume, 35, 25, 1.0, {});
  FrameSettings settings = projecting({8, 8}, IntensityProjection::Maximum);
  Renderer density(device(), scene.volume, {.densityScale = 3.0}, {});
  test::expectRefusal([&] { density.render(camera, settings); }, ErrorKind::Usage, {"mode", "transfer function"});
  Renderer renderer(device(), scene.volume, scene.classification, {});
  settings.lighting = Lighting{.ambient = glm::dvec3(1.0)};
  test::expectRefusal([&] { renderer.render(camera, settings); }, ErrorKind::Usage, {"mode", "light"});
}

/// A ball's silhouette and the colour of its surface, without light.
TEST_F(ProjectionTest, AnIsosurfaceOfADistanceIsABall) {
  const glm::ivec3 size(31);
  const double radius = 9.3;
  const Volume volume = makeVolume(size, cubeTransform(size), [&](int x, int y, int z) {
    return 20.0 - glm::length(glm::dvec3(x, y, z) - 15.0);
  });
  const Classification classification{.transferFunction = isoFunction({.value = 20.0 - radius, .color = {0.3, 0.5, 0.7}}, volume)};
  FrameSettings settings = gathering({81, 81});
  settings.depth = true;
  const Image image = Renderer(device(), volume, classification, {}).render(alongZ(volume, settings.size, 2.5), settings);
  for (int y = 0; y < 81; ++y)
    for (int x = 0; x < 81; ++x) {
      const double away = glm::length((glm::dvec2(x, y) - 40.0) / 2.5);
      const glm::vec4 pixel = image.pixels[std::size_t(x + 81 * y)];
      if (away > radius + 1.5) {
        ASSERT_LT(pixel.a, 1e-3f) << x << ' ' << y;
      }
      if (away > radius - 1.0) continue;  // the image rings beside its edge
      ASSERT_NEAR(pixel.a, 1.0, 2e-3) << x << ' ' << y;
      ASSERT_NEAR(pixel.b, 0.7, 2e-3) << x << ' ' << y;
      if (away < 0.7 * radius) {
        ASSERT_NEAR(image.depth[std::size_t(x + 81 * y)], 10.0 - std::sqrt(radius * radius - away * away) * volume.voxelSize(),
                    0.3 * volume.voxelSize());
      }
    }
}

}  // namespace
}  // namespace freevoxels
