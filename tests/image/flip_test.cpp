#include "engine/image/flip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace freevoxels {
namespace {

/// From a function of the pixel's column and row.
template <typename Color>
Image makeImage(glm::ivec2 size, Color&& color) {
  Image image;
  image.size = size;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) image.pixels.emplace_back(glm::vec3(color(x, y)), 1.0f);
  return image;
}

Image makeConstant(glm::vec3 color, glm::ivec2 size = {20, 12}) {
  return makeImage(size, [&](int, int) { return color; });
}

/// Squares of random colours.
Image makeBlocks(glm::ivec2 size, int side, std::uint32_t seed) {
  const glm::ivec2 blocks = (size + side - 1) / side;
  std::vector<glm::vec3> colors(std::size_t(blocks.x * blocks.y));
  const auto random = [&seed] { return float((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0f; };
  for (glm::vec3& color : colors)
    for (int c = 0; c < 3; ++c) color[c] = random();
  return makeImage(size, [&](int x, int y) { return colors[std::size_t(y / side * blocks.x + x / side)]; });
}

template <typename Function>
Image transformed(const Image& image, Function&& function) {
  return makeImage(image.size, [&](int x, int y) {
    return function(glm::vec3(image.pixels[std::size_t(y * image.size.x + x)]));
  });
}

Image mirrored(const Image& image) {
  return makeImage(image.size, [&](int x, int y) {
    return glm::vec3(image.pixels[std::size_t(y * image.size.x + image.size.x - 1 - x)]);
  });
}

Image transposed(const Image& image) {
  return makeImage({image.size.y, image.size.x},
                   [&](int x, int y) { return glm::vec3(image.pixels[std::size_t(x * image.size.x + y)]); });
}

float at(const FlipMap& map, int x, int y) {
  return map.values[std::size_t(y * map.size.x + x)];
}

void expectConstant(const FlipMap& map, double value, double tolerance) {
  for (const float v : map.values) ASSERT_NEAR(v, value, tolerance);
}

/// The pairs below, as the authors' program sees them (flip-evaluator 1.7, which adds up in floats).
struct Pair {
  Image reference = makeBlocks({150, 90}, 5, 1), test = makeBlocks({150, 90}, 7, 2);

  Pair nearer() const {
    Pair pair = *this;
    for (std::size_t i = 0; i < test.pixels.size(); ++i)
      pair.test.pixels[i] = 0.75f * reference.pixels[i] + 0.25f * test.pixels[i];
    return pair;
  }
  Pair highRange() const {
    const auto stretch = [](glm::vec3 c) { return 16.0f * c * c * c * c; };
    return {transformed(reference, stretch), transformed(test, stretch)};
  }
};

struct AuthorsValues {
  double mean, at5x7, at100x40, maximum;
};

void expectAuthors(const FlipMap& map, const AuthorsValues& expected) {
  EXPECT_NEAR(map.mean(), expected.mean, 2e-4);
  EXPECT_NEAR(at(map, 5, 7), expected.at5x7, 1e-4);
  EXPECT_NEAR(at(map, 100, 40), expected.at100x40, 1e-4);
  EXPECT_NEAR(*std::ranges::max_element(map.values), expected.maximum, 1e-4);
}

TEST(LdrFlip, AgreesWithTheAuthorsProgram) {
  const Pair pair;
  expectAuthors(ldrFlip(pair.test, pair.reference), {0.781991, 0.888119, 0.622555, 0.990588});
  expectAuthors(ldrFlip(pair.test, pair.reference, 30.0), {0.845192, 0.980690, 0.873417, 0.994175});
  const Pair nearer = pair.nearer();
  expectAuthors(ldrFlip(nearer.test, nearer.reference), {0.368299, 0.440859, 0.262155, 0.811421});
}

TEST(HdrFlip, AgreesWithTheAuthorsProgram) {
  const Pair pair = Pair().nearer().highRange();
  const Exposures exposures = flipExposures(pair.reference);
  EXPECT_NEAR(exposures.start, -2.789623, 1e-3);
  EXPECT_NEAR(exposures.stop, -0.072413, 1e-3);
  EXPECT_EQ(exposures.count, 3);
  expectAuthors(hdrFlip(pair.test, pair.reference, exposures), {0.499353, 0.547142, 0.416169, 0.971779});
  const Exposures given = exposuresBetween(-2.0, 2.0);
  EXPECT_EQ(given.count, 4);
  expectAuthors(hdrFlip(pair.test, pair.reference, given), {0.533547, 0.446920, 0.424244, 0.980332});
}

/// Constant images pass the filters as they are and have no features: their FLIP is the redistributed HyAB
/// distance, worked out here by hand from CIELAB values in the literature (D65).
double byHand(double lightness, double chroma) {
  // Green is (87.73, -86.18, 83.18), blue (32.30, 79.19, -107.86); Hunt scales a and b by 0.01 L.
  const double greenToBlue =
      (87.73 - 32.30) + std::hypot(-0.8773 * 86.18 - 0.3230 * 79.19, 0.8773 * 83.18 + 0.3230 * 107.86);
  const double largest = std::pow(greenToBlue, 0.7), value = std::pow(lightness + chroma, 0.7);
  if (value < 0.4 * largest) return 0.95 * value / (0.4 * largest);
  return 0.95 + 0.05 * (value - 0.4 * largest) / (0.6 * largest);
}

TEST(LdrFlip, ConstantImagesAreAsFarApartAsTheirColours) {
  const Image black = makeConstant({0, 0, 0}), white = makeConstant({1, 1, 1});
  expectConstant(ldrFlip(white, black), byHand(100.0, 0.0), 1e-4);
  expectConstant(ldrFlip(makeConstant({0, 0, 1}), makeConstant({0, 1, 0})), 1.0, 1e-5);
  // Linear 0.18 is L = 49.496; red is (53.24, 80.09, 67.20).
  expectConstant(ldrFlip(makeConstant(glm::vec3(0.18f)), black), byHand(49.496, 0.0), 1e-4);
  expectConstant(ldrFlip(makeConstant({1, 0, 0}), black), byHand(53.24, 0.5324 * std::hypot(80.09, 67.20)),
                 1e-4);
  // Grey differences that are small: L(0.5) = 76.069, L(0.4) = 69.470.
  expectConstant(ldrFlip(makeConstant(glm::vec3(0.4f)), makeConstant(glm::vec3(0.5f))),
                 byHand(76.0693 - 69.4695, 0.0), 1e-4);
}

TEST(Flip, EqualImagesDifferNowhere) {
  const Image image = makeBlocks({150, 40}, 3, 5);
  expectConstant(ldrFlip(image, image), 0.0, 0.0);
  expectConstant(hdrFlip(image, image, flipExposures(image)), 0.0, 0.0);
}

TEST(LdrFlip, CannotSeeBeyondWhatADisplayShows) {
  expectConstant(ldrFlip(makeConstant(glm::vec3(7.0f)), makeConstant(glm::vec3(1.0f))), 0.0, 0.0);
  expectConstant(ldrFlip(makeConstant(glm::vec3(-1.0f)), makeConstant(glm::vec3(0.0f))), 0.0, 0.0);
}

TEST(HdrFlip, SeesWhatIsBrighterThanADisplay) {
  const Image bright = makeConstant(glm::vec3(7.0f)), brighter = makeConstant(glm::vec3(9.0f));
  EXPECT_GT(hdrFlip(brighter, bright, flipExposures(bright)).mean(), 0.05);
}

TEST(Flip, DoesNotDependOnWhichImageIsWhich) {
  const Pair pair = Pair().nearer();
  EXPECT_EQ(ldrFlip(pair.test, pair.reference).values, ldrFlip(pair.reference, pair.test).values);
}

TEST(Flip, TurnsWithTheImages) {
  const Pair pair = Pair().nearer();
  const FlipMap map = ldrFlip(pair.test, pair.reference);
  const FlipMap mirror = ldrFlip(mirrored(pair.test), mirrored(pair.reference));
  const FlipMap turned = ldrFlip(transposed(pair.test), transposed(pair.reference));
  for (int y = 0; y < map.size.y; ++y)
    for (int x = 0; x < map.size.x; ++x) {
      ASSERT_NEAR(at(map, x, y), at(mirror, map.size.x - 1 - x, y), 1e-4);
      ASSERT_NEAR(at(map, x, y), at(turned, y, x), 1e-4);
    }
}

TEST(Flip, OnePixelIsSeenNearItAndNowhereElse) {
  // Across a corner where four tiles meet, so that a seam between tiles would show.
  const glm::ivec2 size(256, 256), spot(127, 128);
  const Image reference = makeConstant(glm::vec3(0.2f), size);
  Image test = reference;
  test.pixels[std::size_t(spot.y * size.x + spot.x)] = glm::vec4(1.0f);
  const FlipMap map = ldrFlip(test, reference);
  const int reach = 10;  // ceil(3 sigma) of the widest filter at 67 pixels a degree
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::ivec2 from = glm::abs(glm::ivec2(x, y) - spot);
      if (std::max(from.x, from.y) > reach)
        ASSERT_EQ(at(map, x, y), 0.0f) << x << ", " << y;
      else if (std::max(from.x, from.y) < reach / 2) {
        ASSERT_GT(at(map, x, y), 0.0f) << x << ", " << y;
        ASSERT_NEAR(at(map, x, y), at(map, 2 * spot.x - x, 2 * spot.y - y), 1e-4);
      }
    }
}

TEST(Flip, DetailThatIsTooFineToSeeCountsLessFromFurtherAway) {
  const Image grey = makeConstant(glm::vec3(0.5f), {64, 64});
  const Image checkers =
      makeImage({64, 64}, [](int x, int y) { return glm::vec3((x + y) % 2 == 0 ? 0.7f : 0.3f); });
  const double near = ldrFlip(checkers, grey, 10.0).mean(), far = ldrFlip(checkers, grey, 120.0).mean();
  EXPECT_GT(near, 0.3);
  EXPECT_LT(far, 0.1 * near);
}

TEST(Flip, ThreadsDoNotChangeABit) {
  const Pair pair = Pair().highRange();
  const FlipMap parallel = hdrFlip(pair.test, pair.reference, {-1.0, 1.0, 3});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(hdrFlip(pair.test, pair.reference, {-1.0, 1.0, 3}).values, parallel.values);
}

TEST(HdrFlip, IsTheLargestOverTheExposures) {
  const Pair pair = Pair().highRange();
  const FlipMap both = hdrFlip(pair.test, pair.reference, {-3.0, 1.0, 2});
  const FlipMap dark = hdrFlip(pair.test, pair.reference, {-3.0, -3.0, 1});
  const FlipMap bright = hdrFlip(pair.test, pair.reference, {1.0, 1.0, 1});
  EXPECT_NE(dark.values, bright.values);
  for (std::size_t i = 0; i < both.values.size(); ++i)
    ASSERT_EQ(both.values[i], std::max(dark.values[i], bright.values[i]));
}

TEST(HdrFlip, ExposuresComeFromTheBrightestAndTheMedianPixel) {
  // Luminances 1/8, 2/8, ... 8/8 have the (upper) median 5/8. At the exposure of white, the ACES fit maps to
  // 0.85: x = 2.1188, 1.0833 stops, by the quadratic formula.
  const Image ramp = makeImage({8, 1}, [](int x, int) { return glm::vec3(float(x + 1) / 8.0f); });
  const Exposures exposures = flipExposures(ramp);
  EXPECT_NEAR(exposures.start, 1.083297, 1e-5);
  EXPECT_NEAR(exposures.stop, 1.083297 - std::log2(5.0 / 8.0), 1e-5);
  EXPECT_EQ(exposures.count, 2);
  // A thousand times brighter: ten stops less.
  const Image bright = transformed(ramp, [](glm::vec3 c) { return 1024.0f * c; });
  EXPECT_NEAR(flipExposures(bright).start, exposures.start - 10.0, 1e-5);
}

TEST(HdrFlip, BlackReferencesHaveFiniteExposures) {
  Image mostlyBlack = makeConstant(glm::vec3(0.0f), {9, 8});
  mostlyBlack.pixels[3] = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  const Exposures exposures = flipExposures(mostlyBlack);
  EXPECT_NEAR(exposures.start, 2.083297, 1e-5);
  EXPECT_NEAR(exposures.stop, 24.083297, 1e-5);

  const Image black = makeConstant(glm::vec3(0.0f));
  const FlipMap map = hdrFlip(makeConstant(glm::vec3(0.1f)), black, flipExposures(black));
  expectConstant(map, byHand(100.0, 0.0), 1e-4);  // the faintest light is white at that exposure
}

TEST(HdrFlip, HugeValuesStayFinite) {
  const Image huge = makeConstant(glm::vec3(1e38f)), dark = makeConstant(glm::vec3(1e-3f));
  expectConstant(hdrFlip(huge, dark, {0.0, 24.0, 24}), byHand(100.0, 0.0), 0.01);
}

TEST(FlipMap, MeanAndMagmaColours) {
  FlipMap map{{3, 1}, {0.0f, 1.0f, 0.5f}};
  EXPECT_DOUBLE_EQ(map.mean(), 0.5);
  const Image image = magmaImage(map);
  ASSERT_EQ(image.size, glm::ivec2(3, 1));
  const auto luminance = [&](std::size_t i) { return image.pixels[i].r + image.pixels[i].g; };
  EXPECT_LT(luminance(0), 0.01f);
  EXPECT_GT(luminance(1), 1.9f);
  // matplotlib's magma(0.5) is (183, 55, 121).
  EXPECT_NEAR(image.pixels[2].r, std::pow((183.0 / 255.0 + 0.055) / 1.055, 2.4), 0.01);
  EXPECT_NEAR(image.pixels[2].b, std::pow((121.0 / 255.0 + 0.055) / 1.055, 2.4), 0.01);
}

}  // namespace
}  // namespace freevoxels
