// The sorted image on the device against the double-precision reference and Eq. 9.

#include <cmath>
#include <cstring>

#include "engine/reference/reference_sorted.h"
#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "engine/renderer.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

class SortedSplatsTest : public DeviceTest {
 protected:
  static void expectSameImage(const Volume& volume, const Camera& camera, glm::ivec2 size) {
    const Classification classification = coloured(volume);
    const FrameSettings settings{.size = size, .method = SplatSettings{.composite = Composite::Sorted}, .depth = true};
    Renderer renderer(device(), volume, classification, {});
    const Image image = renderer.render(camera, settings);
    const Image expected =
        referenceSortedImage(volume, classification, camera, settings, referenceVisibleVoxels(referenceExtinction(volume, classification)));
    double largest = 0.0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
      largest = std::max(largest, double(expected.pixels[i].a));
      ASSERT_EQ(std::isinf(image.depth[i]), image.pixels[i].a == 0.0f);
    }
    EXPECT_GE(largest, 0.2);
    EXPECT_LE(largestPixelDifference(image, expected), 1e-3);
    EXPECT_LE(worstRelativeDepth(image, expected), 1e-3);
    EXPECT_GE(psnr(image, expected), 90.0);
  }

  static constexpr glm::ivec3 kSize{11, 14, 9};
  static Volume volume(bool sheared) {
    return randomVolume(kSize, sheared ? shearedTransform(kSize) : cubeTransform(kSize), 0.6, 1.0);
  }
};

TEST_F(SortedSplatsTest, PerspectiveMatchesTheReference) {
  const Volume v = volume(false);
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.25, {}), {125, 100});
  expectSameImage(v, {.position = {0.0, 0.0, 2.5}, .lookAt = {}}, {100, 100});
}

TEST_F(SortedSplatsTest, ShearedVoxelsMatchTheReference) {
  const Volume v = volume(true);
  expectSameImage(v, framingCamera(v, -110.0, -40.0, 0.8, {}), {96, 120});
}

TEST_F(SortedSplatsTest, OrthographicMatchesTheReference) {
  Camera base;
  base.orthographic = true;
  const Volume v = volume(true);
  expectSameImage(v, framingCamera(v, 20.0, 60.0, 1.0, base), {100, 100});
  const Volume straight = volume(false);
  expectSameImage(straight, framingCamera(straight, 0.0, 0.0, 1.0, base), {100, 100});
}

TEST_F(SortedSplatsTest, VoxelsSmallerThanPixelsMatchTheReference) {
  const Volume v = volume(true);
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {7, 7});
}

TEST_F(SortedSplatsTest, SplatsLargerThanTheLargestPointMatchTheReference) {
  const Volume v = randomVolume({3, 3, 3}, cubeTransform({3, 3, 3}), 0.8, 1.0);
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {700, 700});
}

TEST_F(SortedSplatsTest, TheEyeInsideTheVolumeDrawsWhatIsInFront) {
  const Camera camera{.position = {0.03, 0.02, 0.01}, .lookAt = {0.3, 0.1, -0.4}, .verticalFov = 70.0};
  expectSameImage(volume(false), camera, {64, 64});
}

TEST_F(SortedSplatsTest, EmptyVolumeIsBackground) {
  const Volume v = makeVolume(kSize, cubeTransform(kSize), [](int, int, int) { return 0.0; });
  Renderer renderer(device(), v, {}, {});
  for (const bool depth : {false, true}) {
    const Image image = renderer.render(framingCamera(v, 35.0, 25.0, 1.0, {}),
                                        {.size = {32, 32}, .method = SplatSettings{.composite = Composite::Sorted}, .depth = depth});
    for (const glm::vec4& pixel : image.pixels) ASSERT_EQ(pixel, glm::vec4(0.0f));
    for (float distance : image.depth) ASSERT_TRUE(std::isinf(distance));
  }
}

/// One renderer, switching between composites: nothing of one frame is left in the next.
TEST_F(SortedSplatsTest, SameRenderTwiceIsBitIdentical) {
  const glm::ivec3 dimensions(40, 50, 45);
  const Volume v = randomVolume(dimensions, cubeTransform(dimensions), 0.7, 30.0);
  const Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  const FrameSettings settings{.size = {150, 150}, .method = SplatSettings{.composite = Composite::Sorted}};
  Renderer first(device(), v, {}, {}), second(device(), v, {}, {});
  const Image a = first.render(camera, settings), b = second.render(camera, settings);
  const Image sums = first.render(camera, {.size = {150, 150}, .method = SplatSettings{}});
  const Image c = first.render(camera, settings);
  const std::size_t bytes = a.pixels.size() * sizeof(glm::vec4);
  EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), bytes), 0);
  EXPECT_EQ(std::memcmp(a.pixels.data(), c.pixels.data(), bytes), 0);
  EXPECT_EQ(sums.pixels, second.render(camera, {.size = {150, 150}, .method = SplatSettings{}}).pixels);
  EXPECT_LT(psnr(sums, a), 60.0);
}

}  // namespace
}  // namespace freevoxels
