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
