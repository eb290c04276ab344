// Whole images: closed forms, order independence, determinism.

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "engine/core/error.h"
#include "engine/renderer.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

using RendererTest = DeviceTest;

/// A smooth kernel cannot draw the box's sharp edges, whose silhouettes are all that limits the whole
/// image: most where a face is seen edge-on. Away from them the image is the closed form.
TEST_F(RendererTest, HomogeneousCubeIsBeerLambertFromAnyDirection) {
  const double sigma = 2.5;
  const glm::vec3 color(0.8f, 0.5f, 0.2f);
  const glm::ivec3 dimensions(64);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), volume, {.densityScale = sigma, .albedo = color}, {});
  const glm::ivec2 size(256);
  for (bool orthographic : {false, true})
    for (glm::dvec2 view :
         {glm::dvec2(35, 25), glm::dvec2(0, 0), glm::dvec2(90, 0), glm::dvec2(45, 0), glm::dvec2(45, 35.26),
          glm::dvec2(-160, -50), glm::dvec2(10, 80), glm::dvec2(200, 5)}) {
      Camera camera = framingCamera(volume, view.x, view.y, 1.0, {});
      camera.position = 3.0 * glm::normalize(camera.position);  // the cube's bounding sphere fits the image
      camera.orthographic = orthographic;
      camera.orthographicHeight = 1.8;
      const Image image = renderer.render(camera, {.size = size, .method = SplatSettings{}});
      const BoxImage box = boxImage(volume, sigma, color, camera, size);
      double worst = 0.0;
      for (std::size_t i = 0; i < box.interior.size(); ++i)
        for (int c = 0; c < 4 && box.interior[i]; ++c)
          worst = std::max(worst, double(std::abs(image.pixels[i][c] - box.image.pixels[i][c])));
      const double whole = psnr(image, box.image);
      const std::string name =
          fmt::format("from {},{} {}", view.x, view.y, orthographic ? "orthographic" : "perspective");
      const glm::dvec3 towardsEye = glm::abs(glm::normalize(camera.position));
      const bool edgeOn = std::min({towardsEye.x, towardsEye.y, towardsEye.z}) < 0.1;
      EXPECT_LE(worst, 1.5e-3) << name;
      EXPECT_GE(whole, edgeOn ? 28.0 : 55.0) << name;
      std::printf("homogeneous cube 64^3 %s: inside its edges at most %.1e off, whole image %.1f dB\n", name.c_str(), worst, whole);
    }
}

TEST_F(RendererTest, OpticalDepthAddsUpToBeerLambertInsideTheCube) {
  const double sigma = 1.7;
  const glm::ivec3 dimensions(48, 40, 32);
  const Volume volume =
      makeVolume(dimensions, shearedTransform(dimensions), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), volume, {.densityScale = sigma}, {});
  const Camera camera = framingCamera(volume, 50.0, 30.0, 1.0, {});
  const glm::ivec2 size(101);
  const Image image = renderer.render(camera, {.size = size, .method = SplatSettings{}});
  const Image expected = boxImage(volume, sigma, {}, camera, size).image;
  EXPECT_NEAR(image.pixels[50 * 101 + 50].a, expected.pixels[50 * 101 + 50].a, 1e-3);
}

TEST_F(RendererTest, EmptyVolumeIsBackground) {
  const glm::ivec3 dimensions(9);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 0.0; });
  Renderer renderer(device(), volume, {}, {});
  for (Composite composite : {Composite::Normalised, Composite::Additive}) {
    const Image image = renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}),
                                        {.size = {32, 32}, .method = SplatSettings{.composite = composite}, .depth = true});
    for (const glm::vec4& pixel : image.pixels) ASSERT_EQ(pixel, glm::vec4(0.0f));
    for (float depth : image.depth) ASSERT_TRUE(std::isinf(depth));
  }
}

TEST_F(RendererTest, SameRenderTwiceIsBitIdentical) {
  const glm::ivec3 dimensions(40, 50, 45);
  const Volume volume = randomVolume(dimensions, cubeTransform(dimensions), 0.7, 30.0);
  const FrameSettings settings{.size = {200, 150}, .method = SplatSettings{}};
  const Camera camera = framingCamera(volume, 35.0, 25.0, 200.0 / 150.0, {});
  Renderer first(device(), volume, {}, {});
  Renderer second(device(), volume, {}, {});
  const Image a = first.render(camera, settings), b = second.render(camera, settings),
              c = first.render(camera, settings);
  EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec4)), 0);
  EXPECT_EQ(std::memcmp(a.pixels.data(), c.pixels.data(), a.pixels.size() * sizeof(glm::vec4)), 0);
}

TEST_F(RendererTest, MoreSplatsThanOneChunkAreAllDrawn) {
  const glm::ivec3 dimensions(112, 104, 100);  // 1,164,800 voxels, and a chunk is 1,048,576
  const double sigma = 3.0;
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), volume, {.densityScale = sigma}, {});
  EXPECT_EQ(*renderer.occupiedVoxelCount(), volume.voxelCount());
  const Camera camera = framingCamera(volume, 0.0, 0.0, 1.0, {});
  const glm::ivec2 size(128);
  EXPECT_GE(psnr(renderer.render(camera, {.size = size, .method = SplatSettings{}}),
                 boxImage(volume, sigma, glm::vec3(0.9f), camera, size).image),
            40.0);
}

TEST_F(RendererTest, MirroredCameraMirrorsTheImage) {
  const glm::ivec3 dimensions(20);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int x, int y, int z) {
    return double(y) / 20.0 + (std::abs(x - 9.5) < 4 ? 1.0 : 0.0) + (z > 9 ? 0.3 : 0.0);  // symmetric in x
  });
  Renderer renderer(device(), volume, {.densityScale = 5.0}, {});
  const glm::ivec2 size(60, 60);
  const Image right = renderer.render(framingCamera(volume, 40.0, 15.0, 1.0, {}), {.size = size, .method = SplatSettings{}});
  const Image left = renderer.render(framingCamera(volume, -40.0, 15.0, 1.0, {}), {.size = size, .method = SplatSettings{}});
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::vec4 a = right.pixels[std::size_t(y * size.x + x)],
                      b = left.pixels[std::size_t(y * size.x + size.x - 1 - x)];
      for (int c = 0; c < 4; ++c) ASSERT_NEAR(a[c], b[c], 2e-3) << x << "," << y;
    }
}

TEST_F(RendererTest, TheImageIsTheRightWayRound) {
  const glm::ivec3 dimensions(24);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int x, int y, int) {
    return x > 17 && y > 17 ? 1.0 : 0.0;  // a bar along z, at large x and y
  });
  Renderer renderer(device(), volume, {.densityScale = 20.0}, {});
  const glm::ivec2 size(40);
  // Seen from +z with y up, x grows to the right; row 0 is the top.
  const Image image = renderer.render(framingCamera(volume, 0.0, 0.0, 1.0, {}), {.size = size, .method = SplatSettings{}});
  const auto alpha = [&](int x, int y) { return image.pixels[std::size_t(y * size.x + x)].a; };
  EXPECT_GT(alpha(32, 7), 0.5f);
  EXPECT_LT(alpha(7, 7), 0.01f);
  EXPECT_LT(alpha(32, 32), 0.01f);
  EXPECT_LT(alpha(7, 32), 0.01f);
}

TEST_F(RendererTest, AbsurdDensitiesAreOpaqueNotEmpty) {
  const glm::ivec3 dimensions(6);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 3.0; });
  for (double scale : {1e10, 1e38, 1e300}) {
    Renderer renderer(device(), volume, {.densityScale = scale}, {});
    const Image image = renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}), {.size = {21, 21}, .method = SplatSettings{}});
    EXPECT_EQ(image.pixels[10 * 21 + 10].a, 1.0f) << scale;
    for (const glm::vec4& pixel : image.pixels) ASSERT_TRUE(std::isfinite(pixel.r + pixel.a)) << scale;
  }
}

TEST_F(RendererTest, TooLargeAnImageIsRefusedBeforeAllocation) {
  const glm::ivec3 dimensions(2);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 1.0; });
  Renderer renderer(device(), volume, {}, {});
  try {
    renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}), {.size = {1'000'000, 1'000'000}, .method = SplatSettings{}});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::OutOfMemory);
  }
}

TEST_F(RendererTest, TooLargeAVolumeIsRefusedBeforeAllocation) {
  Volume volume;
  volume.dimensions = {40000, 40000, 40000};
  Renderer renderer(device(), volume, {}, {});
  try {
    renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}), {.size = {16, 16}, .method = SplatSettings{}});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::OutOfMemory);
    EXPECT_NE(std::string(error.what()).find("40000x40000x40000 voxels"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace freevoxels
