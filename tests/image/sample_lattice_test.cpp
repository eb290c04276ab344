#include "engine/image/sample_lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace freevoxels {
namespace {

SampleLattice lattice() {
  SampleLattice lattice{.samples = {12, 10}, .pitch = 1.7, .first = {-9.3, -7.1}, .depth = true};
  lattice.axes[0] = {{0.1, 1.0 / 3.0, -0.2}, {0.5, -0.25}, 1e-9};
  lattice.axes[2] = {{1.0, 0.0, 0.01}, {2.0, 1.5}, -0.125};
  lattice.seenLow = {-1e9, -4.0};
  lattice.seenHigh = {1e9, 4.5};
  return lattice;
}

TEST(SampleLattice, TextMakesAnEqualLattice) {
  EXPECT_EQ(latticeOf(latticeText(lattice())), lattice());
}

TEST(SampleLattice, DamagedTextsAreRefused) {
  const std::string text = latticeText(lattice());
  SampleLattice tooFine = lattice();
  tooFine.pitch = 1e-3;
  for (const std::string& damaged :
       {std::string(), text.substr(0, text.size() / 2), "x" + text, "-3" + text, "1e9" + text, text + " 1", latticeText(tooFine)})
    EXPECT_THROW(latticeOf(damaged), std::invalid_argument) << damaged;
}

/// 16 million samples where that is at least one a pixel, and never more than 64 million.
TEST(SampleLattice, LargeImagesHaveWideLattices) {
  for (const int x : {1, 2, 100, 1000, 2048, 2500, 4096, 5000, 8192, 10'001, 16384})
    for (const int y : {1, 3, 640, 2048, 3001, 4096, 8191, 11'000, 16384}) {
      const double pitch = leastPitch({x, y}), pixels = double(x) * y;
      EXPECT_EQ(pitch * 1024.0, std::round(pitch * 1024.0));
      EXPECT_GE(pitch, 0.5);
      if (pixels <= double(1 << 22)) {
        EXPECT_EQ(pitch, 0.5);
      }
      if (pixels >= double(1 << 24) && pixels <= double(1 << 26)) {
        EXPECT_EQ(pitch, 1.0);
      }
      const glm::dvec2 samples(latticeSamples({x, y}, pitch));
      EXPECT_LE((samples.x - 5.0) * (samples.y - 5.0), 1.002 * std::max(double(1 << 24), std::min(pixels, double(1 << 26)))) << x << 'x' << y;
    }
}

TEST(SampleLattice, EqualSamplesBecomeEqualPixels) {
  const std::vector<LatticeSample> samples(120, {{0.1, 0.2, 0.3, 0.6}, 0.6 * 4.0});
  const Image image = resolveLattice(lattice(), {16, 12}, samples);
  ASSERT_EQ(image.pixels.size(), 192u);
  for (const glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(pixel[c], glm::vec4(0.1f, 0.2f, 0.3f, 0.6f)[c], 1e-6);
  for (const float depth : image.depth) EXPECT_NEAR(depth, 4.0f, 1e-5f);
}

TEST(SampleLattice, EmptySamplesHaveNoDepth) {
  const Image image = resolveLattice(lattice(), {16, 12}, std::vector<LatticeSample>(120));
  for (const glm::vec4& pixel : image.pixels) EXPECT_EQ(pixel, glm::vec4(0.0f));
  for (const float depth : image.depth) EXPECT_TRUE(std::isinf(depth));
}

}  // namespace
}  // namespace freevoxels
