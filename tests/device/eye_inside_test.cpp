// Eyes inside the volume: against the reference, closed forms and the oracle, and what must not happen on the
// way.

#include <cmath>
#include <vector>

#include "engine/image/metrics.h"
#include "engine/reference/oracle.h"
#include "engine/scene/footprint.h"
#include "engine/validation/fly_through_quality.h"
#include "tests/device/splat_fixture.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

class EyeInsideTest : public SplatTest {
 protected:
  /// Looks along `direction` (world) from a position in index space.
  static Camera at(const Volume& volume, glm::dvec3 index, glm::dvec3 direction, double fov = 70.0) {
    Camera camera;
    camera.position = glm::dvec3(volume.indexToWorld * glm::dvec4(index, 1.0));
    camera.lookAt = camera.position + direction;
    camera.verticalFov = fov;
    return camera;
  }
  static Classification physical(double densityScale, glm::vec3 albedo = glm::vec3(0.9f)) {
    return {.densityScale = densityScale, .albedo = albedo};
  }
};

TEST_F(EyeInsideTest, MatchesTheReferenceWhereverItIs) {
  const Volume v = volume(true);
  const glm::dvec3 directions[] = {{1.0, 0.3, -0.4}, {-0.2, -1.0, 0.3}, {0.1, 0.2, 1.0}};
  for (const glm::dvec3 direction : directions) {
    expectSameImage(v, at(v, {5.31, 6.63, 4.17}, direction), {.size = {48, 40}, .method = SplatSettings{}});
    expectSameImage(v, at(v, {-1.17, 5.93, 3.36}, direction), {.size = {48, 40}, .method = SplatSettings{}});  // kernels reach it
  }
}

/// At a voxel, between eight, in a plane, on a face, at a corner. Of unit voxels, for which device and
/// reference agree to the last bit on what is as far along one axis as along another.
TEST_F(EyeInsideTest, MatchesTheReferenceAtPlacesOfTheLattice) {
  const Volume v = randomVolume(kSize, glm::dmat4(1.0), 0.6, 1.0);
  for (const glm::dvec3 place :
       {glm::dvec3(5.0, 7.0, 4.0), {5.5, 6.5, 3.5}, {5.0, 6.5, 4.25}, {-0.5, 6.25, 4.125}, {10.5, 13.5, 8.5}})
    expectSameImage(v, at(v, place, glm::dvec3(5.0, 6.0, 4.0) - 0.5 * place), {.size = {40, 32}, .method = SplatSettings{}});
}

TEST_F(EyeInsideTest, MatchesTheReferenceInAllDirectionsAndMethods) {
  const Volume v = volume(false);
  const glm::dvec3 place(5.31, 6.63, 4.17);
  for (const glm::dvec3 direction : {glm::dvec3(1, 0.01, 0), {-1, 0.01, 0}, {0.01, 0, 1}, {0.01, 0, -1}}) {
    expectSameImage(v, at(v, place, direction), {.size = {40, 40}, .method = SplatSettings{.composite = Composite::Additive}});
    for (const AttenuationLookup lookup : {AttenuationLookup::Bilinear, AttenuationLookup::Nearest})
      expectSameImage(v, at(v, place, direction), {.size = {40, 40}, .method = SplatSettings{.attenuation = lookup}});
  }
  expectSameImage(v, at(v, place, {1, 0.5, 0}, 150.0), {.size = {64, 48}, .method = SplatSettings{.gradient = false}});
}

/// Voxels just in front of the eye plane overflow nothing, and voxels beside the image stay beside it.
TEST_F(EyeInsideTest, LargeImagesOfNearVoxelsMatchTheReference) {
  const Volume v = volume(false);
  expectSameImage(v, at(v, {5.31, 6.63, 4.17}, {1.0, 0.2, 0.1}, 20.0), {.size = {200, 160}, .method = SplatSettings{}});
}

TEST_F(EyeInsideTest, AnOrthographicEyePlaneInsideMatchesTheReference) {
  const Volume v = volume(true);
  Camera camera = at(v, {5.31, 6.63, 4.17}, {0.5, 0.3, -1.0});
  camera.orthographic = true;
  camera.orthographicHeight = 1.0;
  expectSameImage(v, camera, {.size = {60, 60}, .method = SplatSettings{}});
}

TEST_F(EyeInsideTest, NothingBehindTheEyeShows) {
  const glm::ivec3 dimensions(16);
  const Volume v =
      makeVolume(dimensions, cubeTransform(dimensions), [](int x, int, int) { return x < 6 ? 1.0 : 0.0; });
  Renderer renderer(device(), v, physical(100.0), {});
  for (const Composite composite : {Composite::Normalised, Composite::Additive, Composite::Sorted})
    for (const double fov : {60.0, 120.0}) {
      const FrameSettings settings{.size = {32, 32}, .method = SplatSettings{.composite = composite}};
      const Image away = renderer.render(at(v, {7.0, 7.6, 7.7}, {1, 0, 0}, fov), settings);
      for (const glm::vec4& pixel : away.pixels) ASSERT_EQ(pixel, glm::vec4(0.0f));
      const Image towards = renderer.render(at(v, {7.0, 7.6, 7.7}, {-1, 0, 0}, fov), settings);
      EXPECT_GT(towards.pixels[16 * 32 + 16].a, 0.9f);
    }
}

/// Alpha is 1 - exp(-sigma times the way to the boundary), whatever is near to the eye.
TEST_F(EyeInsideTest, AHomogeneousCubeIsBeerLambertFromWithin) {
  const glm::ivec3 dimensions(24);
  const double sigma = 3.0;
  const Volume v = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), v, physical(sigma, glm::vec3(0.5f)), {});
  for (const glm::dvec3 place : {glm::dvec3(11.5), {12.0, 12.0, 12.0}, {9.3, 13.6, 10.8}}) {
    const Camera camera = at(v, place, {0.0, 0.0, -1.0}, 50.0);
    const glm::ivec2 size(40);
    const Image image = renderer.render(camera, {.size = size, .method = SplatSettings{}});
    const PixelRays rays = pixelRays(camera, size, v.indexToWorld);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const glm::dvec3 ray = rays.direction + (x + 0.5) * rays.directionX + (y + 0.5) * rays.directionY;
        const double length = (rays.origin.z + 0.5) / -ray.z * glm::length(glm::dmat3(v.indexToWorld) * ray);
        const glm::vec4 pixel = image.pixels[std::size_t(y * size.x + x)];
        ASSERT_NEAR(pixel.a, -std::expm1(-sigma * length), 2e-3) << x << "," << y;
        ASSERT_NEAR(pixel.g, 0.5 * pixel.a, 1e-5);
      }
  }
}

/// A hollow in walls that nothing shines through, red within and blue without. No table can tell the walls'
/// layers apart from here.
TEST_F(EyeInsideTest, InAnOpaqueCavityOnlyItsInnerWallShows) {
  const glm::ivec3 dimensions(24);
  const Volume v = makeVolume(dimensions, cubeTransform(dimensions), [](int x, int y, int z) {
    const int deep = std::min({x, y, z, 23 - x, 23 - y, 23 - z});
    return deep >= 8 ? 0.0 : deep >= 4 ? 0.5 : 1.0;
  });
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{0.0f, 0.0f}, {0.4f, 0.98f}, {1.0f, 0.98f}},
                       .color = {{0.5f, {0.9f, 0.1f, 0.0f}}, {1.0f, {0.0f, 0.1f, 0.9f}}},
                       .unitDistance = v.voxelSize()};
  classification.order = ClassificationOrder::Pre;
  Renderer renderer(device(), v, classification, {});
  const glm::ivec2 size(40);
  for (const glm::dvec3 direction : {glm::dvec3(1.0, 0.2, 0.1), {-0.5, -1.0, 0.6}}) {
    const Camera camera = at(v, {10.8, 11.9, 12.4}, direction, 80.0);
    const Image image = renderer.render(camera, {.size = size});
    for (const glm::vec4& pixel : image.pixels) {
      ASSERT_GT(pixel.a, 0.999f);
      ASSERT_GT(pixel.r, 0.85f);
      ASSERT_LT(pixel.b, 0.05f);
    }
    EXPECT_GE(psnr(image, renderOracle(v, classification, camera, {.size = size}).image), 40.0);
  }
}

/// A voxel at the eye itself lies in no direction.
TEST_F(EyeInsideTest, ASingleVoxelSeenFromItsMiddleIsHalfAVoxelDeep) {
  const Volume v = makeVolume({1, 1, 1}, glm::dmat4(1.0), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), v, physical(0.5), {});
  for (const glm::dvec3 direction : {glm::dvec3(1.0, 0.2, 0.1), {-0.1, -1.0, 0.3}})
    for (const AttenuationLookup lookup : {AttenuationLookup::Bilinear, AttenuationLookup::Nearest}) {
      const Image image =
          renderer.render(at(v, glm::dvec3(0.0), direction), {.size = {9, 9}, .method = SplatSettings{.attenuation = lookup}});
      for (const glm::vec4& pixel : image.pixels) ASSERT_NEAR(pixel.a, -std::expm1(-0.5 * kFootprintPeak / 2.0), 1e-5);
    }
}

/// No step of a hundredth of a voxel changes the image more than its neighbours do.
TEST_F(EyeInsideTest, SmallStepsOfTheEyeChangeTheImageALittle) {
  const Volume v = volume(false);
  Renderer renderer(device(), v, physical(20.0), {});
  std::vector<Image> images;
  for (int i = 0; i < 60; ++i)  // past voxels' centres and the planes between them
    images.push_back(
        renderer.render(at(v, {4.7 + 0.01 * i, 6.8 + 0.01 * i, 4.0}, {1.0, 0.2, 0.1}), {.size = {24, 24}, .method = SplatSettings{}}));
  double least = 1.0, most = 0.0;
  for (std::size_t i = 1; i < images.size(); ++i) {
    const double change = largestPixelDifference(images[i], images[i - 1]);
    least = std::min(least, change);
    most = std::max(most, change);
  }
  EXPECT_GT(least, 1e-5);
  EXPECT_LT(most, 0.02);
}

}  // namespace
}  // namespace freevoxels
