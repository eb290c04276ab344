#include "engine/image/metrics.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

namespace freevoxels {
namespace {

Image uniformImage(glm::vec4 pixel, glm::ivec2 size = {6, 4}) {
  return {size, std::vector<glm::vec4>(std::size_t(size.x * size.y), pixel), {}};
}

Image makeNoise(glm::ivec2 size, std::uint32_t seed) {
  Image image = uniformImage({}, size);
  for (glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 4; ++c) pixel[c] = float((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0f;
  return image;
}

TEST(Metrics, EqualImagesHaveNoErrorAndInfinitePsnr) {
  const Image image = makeNoise({50, 30}, 1);
  const ImageMetrics metrics = compareImages(image, image);
  EXPECT_EQ(metrics.rmse, 0.0);
  EXPECT_EQ(metrics.psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(metrics.maximum, 0.0);
}

TEST(Metrics, AConstantErrorIsItsOwnRootMeanSquare) {
  const ImageMetrics metrics = compareImages(uniformImage({0.6f, 0.6f, 0.6f, 1.0f}), uniformImage({0.5f, 0.5f, 0.5f, 1.0f}));
  EXPECT_FALSE(metrics.countsAlpha);
  EXPECT_NEAR(metrics.rmse, 0.1, 1e-7);
  EXPECT_NEAR(metrics.psnr, 20.0, 1e-5);
  EXPECT_NEAR(metrics.maximum, 0.1, 1e-7);
}

TEST(Metrics, AlphaCountsAsAFourthChannelUnlessAllIsOpaque) {
  const Image opaque = uniformImage({0.5f, 0.5f, 0.5f, 1.0f});
  Image lessOpaque = opaque;
  for (glm::vec4& pixel : lessOpaque.pixels) pixel.a = 0.8f;
  const ImageMetrics alphaOnly = compareImages(lessOpaque, opaque);
  EXPECT_TRUE(alphaOnly.countsAlpha);
  EXPECT_NEAR(alphaOnly.rmse, std::sqrt(0.04 / 4.0), 1e-7);
  EXPECT_EQ(alphaOnly.where.channel, 3);

  Image red = opaque;
  for (glm::vec4& pixel : red.pixels) pixel.r = 0.8f;
  EXPECT_NEAR(compareImages(red, opaque).rmse, std::sqrt(0.09 / 3.0), 1e-7);
}

TEST(Metrics, OneWrongPixelIsFoundWhereItIs) {
  const Image reference = uniformImage({0.25f, 0.25f, 0.25f, 0.5f}, {40, 30});
  Image test = reference;
  test.pixels[17 * 40 + 31].b = -1.75f;
  test.pixels[3 * 40 + 2].r = 1.0f;
  const ImageMetrics metrics = compareImages(test, reference);
  EXPECT_EQ(metrics.maximum, 2.0);
  EXPECT_EQ(metrics.where.pixel, glm::ivec2(31, 17));
  EXPECT_EQ(metrics.where.channel, 2);
  EXPECT_NEAR(metrics.rmse, std::sqrt((4.0 + 0.5625) / (4.0 * 1200.0)), 1e-12);
  EXPECT_EQ(compareImages(reference, test).rmse, metrics.rmse);
}

TEST(Metrics, OfEqualMaximaTheFirstInReadingOrderIsNamed) {
  const Image reference = uniformImage({0, 0, 0, 1});
  Image test = reference;
  test.pixels[4].g = test.pixels[4].b = test.pixels[9].r = 0.5f;
  const ImageMetrics metrics = compareImages(test, reference);
  EXPECT_EQ(metrics.where.pixel, glm::ivec2(4, 0));
  EXPECT_EQ(metrics.where.channel, 1);
}

TEST(Metrics, ThreadsDoNotChangeABit) {
  const Image a = makeNoise({333, 257}, 1), b = makeNoise({333, 257}, 2);
  const double parallel = compareImages(a, b).rmse;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(compareImages(a, b).rmse, parallel);
  EXPECT_NEAR(parallel, std::sqrt(1.0 / 6.0), 0.002);  // of two uniform random numbers
}

TEST(Metrics, FindsNanAndInfinity) {
  Image image = uniformImage({0.1f, 0.2f, 0.3f, 1.0f}, {7, 5});
  EXPECT_FALSE(findNonFinite(image));
  image.pixels[3 * 7 + 4].g = std::numeric_limits<float>::quiet_NaN();
  image.pixels[4 * 7].r = -std::numeric_limits<float>::infinity();
  const auto found = findNonFinite(image);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pixel, glm::ivec2(4, 3));
  EXPECT_EQ(found->channel, 1);
}

TEST(Metrics, CompositesOverABackground) {
  const glm::vec3 background(1.0f, 0.5f, 0.0f);
  Image image{{3, 1}, {{0.2f, 0.2f, 0.2f, 0.5f}, {0, 0, 0, 0}, {0.5f, 0.5f, 2.0f, 3.0f}}, {1, 2, 3}};
  const Image opaque = compositeOver(image, background);
  EXPECT_EQ(opaque.pixels[0], glm::vec4(0.7f, 0.45f, 0.2f, 1.0f));
  EXPECT_EQ(opaque.pixels[1], glm::vec4(1.0f, 0.5f, 0.0f, 1.0f));
  EXPECT_EQ(opaque.pixels[2], glm::vec4(0.5f, 0.5f, 2.0f, 1.0f));  // alpha above 1 counts as 1
}

TEST(Metrics, AbsoluteDifferenceOfEveryChannel) {
  const Image difference = absoluteDifference(uniformImage({0.5f, 0.25f, 1.0f, 1.0f}), uniformImage({1.0f, 0.25f, 0.5f, 0.25f}));
  for (const glm::vec4& pixel : difference.pixels) EXPECT_EQ(pixel, glm::vec4(0.5f, 0.0f, 0.5f, 0.75f));
}

}  // namespace
}  // namespace freevoxels
