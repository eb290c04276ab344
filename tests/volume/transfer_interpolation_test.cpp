#include "engine/volume/transfer_interpolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "tests/not_finite.h"

namespace freevoxels {
namespace {

const glm::dvec3 kBlue(0.0, 0.0, 1.0), kRed(1.0, 0.0, 0.0);

void expectColor(glm::dvec3 made, glm::dvec3 expected, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(made[i], expected[i], tolerance) << "component " << i;
}

double linearFrom(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

glm::dvec3 linearFrom(glm::dvec3 c) {
  return {linearFrom(c.r), linearFrom(c.g), linearFrom(c.b)};
}

glm::dvec3 colorAt(const TransferCurves& curves, double x) {
  for (std::size_t i = 0; i + 1 < curves.color.size(); ++i) {
    const auto &a = curves.color[i], &b = curves.color[i + 1];
    if (x >= a.x && x <= b.x) return glm::mix(a.color, b.color, (x - a.x) / (b.x - a.x));
  }
  return curves.color.back().color;
}

double opacityOf(const TransferCurves& curves, double x) {
  for (std::size_t i = 0; i + 1 < curves.opacity.size(); ++i) {
    const auto &a = curves.opacity[i], &b = curves.opacity[i + 1];
    if (x >= a.x && x <= b.x) return std::lerp(a.opacity, b.opacity, (x - a.x) / (b.x - a.x));
  }
  return curves.opacity.back().opacity;
}

TEST(ShapedPlace, IsALineWithoutSharpness) {
  for (const double place : {0.0, 0.3, 0.5, 0.9, 1.0}) EXPECT_DOUBLE_EQ(shapedPlace(place, 0.5, 0.0), place);
}

TEST(ShapedPlace, IsOneHalfAtTheMidpoint) {
  for (const double midpoint : {0.1, 0.5, 0.8})
    for (const double sharpness : {0.0, 0.3, 0.9}) EXPECT_NEAR(shapedPlace(midpoint, midpoint, sharpness), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(shapedPlace(0.05, 0.1, 0.0), 0.25);
  EXPECT_DOUBLE_EQ(shapedPlace(0.9, 0.8, 0.0), 0.75);
}

TEST(ShapedPlace, IsAPowerAndACubicWithSharpness) {
  // s = 0.5 * (2 * 0.25)^(1 + 10 * 0.1) = 0.125; ramp = 3 s^2 - 2 s^3; bump = 2 s^3 - 3 s^2 + s.
  const double s = 0.125, ramp = 3.0 * s * s - 2.0 * s * s * s;
  EXPECT_NEAR(shapedPlace(0.25, 0.5, 0.1), ramp + 0.9 * (s - ramp), 1e-12);
}

TEST(ShapedPlace, IsAStepWithFullSharpness) {
  EXPECT_EQ(shapedPlace(0.299, 0.3, 1.0), 0.0);
  EXPECT_EQ(shapedPlace(0.301, 0.3, 1.0), 1.0);
}

TEST(InterpolatedColor, OfHsvGoesThroughTheHues) {
  expectColor(interpolatedColor(ColorSpace::Hsv, kBlue, kRed, 0.5), {0.0, 1.0, 0.0});
  expectColor(interpolatedColor(ColorSpace::Hsv, kBlue, kRed, 0.25), {0.0, 1.0, 1.0});
  expectColor(interpolatedColor(ColorSpace::HsvWrapped, kBlue, kRed, 0.5), {1.0, 0.0, 1.0});
  expectColor(interpolatedColor(ColorSpace::Hsv, {1.0, 0.5, 0.5}, {0.5, 0.0, 0.0}, 0.5), {0.75, 0.1875, 0.1875});
}

TEST(InterpolatedColor, OfLabIsEvenInLightness) {
  // Between black and white lightness is 50, of which the luminance is ((50 + 16) / 116)^3 = 0.184187.
  const glm::dvec3 middle = linearFrom(interpolatedColor(ColorSpace::Lab, glm::dvec3(0.0), glm::dvec3(1.0), 0.5));
  expectColor(middle, glm::dvec3(0.184187), 2e-4);
  for (const double end : {0.0, 1.0})
    expectColor(interpolatedColor(ColorSpace::Lab, {0.2, 0.4, 0.9}, {0.9, 0.3, 0.1}, end),
                end == 0.0 ? glm::dvec3(0.2, 0.4, 0.9) : glm::dvec3(0.9, 0.3, 0.1), 2e-3);
}

TEST(InterpolatedColor, OfADivergingMapIsGreyInTheMiddle) {
  // Moreland 2009: cool to warm has (221, 221, 221) there.
  const glm::dvec3 cool(59.0 / 255.0, 76.0 / 255.0, 192.0 / 255.0), warm(180.0 / 255.0, 4.0 / 255.0, 38.0 / 255.0);
  expectColor(interpolatedColor(ColorSpace::Diverging, cool, warm, 0.5), glm::dvec3(221.0 / 255.0), 3e-3);
  expectColor(interpolatedColor(ColorSpace::Diverging, cool, warm, 0.0), cool, 2e-3);
  expectColor(interpolatedColor(ColorSpace::Diverging, cool, warm, 1.0), warm, 2e-3);
}

TEST(CurvesOfAFile, FollowDisplayValuesInLinearLight) {
  const TransferCurves curves = curvesOf("f", {.color = {{10.0, glm::dvec3(0.0)}, {20.0, {1.0, 0.5, 0.0}}}});
  EXPECT_EQ(curves.window, (ValueWindow{10.0, 20.0}));
  EXPECT_GT(curves.color.size(), 4u);
  for (double x = 0.0; x <= 1.0; x += 0.01) expectColor(colorAt(curves, x), linearFrom(glm::dvec3(x, 0.5 * x, 0.0)), 2e-3);
}

TEST(CurvesOfAFile, FollowHuesAndSharpnesses) {
  const FileFunction file{.opacity = {{0.0, 0.0, 0.3, 0.7}, {1.0, 1.0}}, .color = {{0.0, kBlue, 0.4, 0.2}, {1.0, kRed}}, .space = ColorSpace::Hsv};
  const TransferCurves curves = curvesOf("f", file);
  for (double x = 0.0; x <= 1.0; x += 0.01) {
    expectColor(colorAt(curves, x), linearFrom(interpolatedColor(ColorSpace::Hsv, kBlue, kRed, shapedPlace(x, 0.4, 0.2))), 4e-3);
    EXPECT_NEAR(opacityOf(curves, x), shapedPlace(x, 0.3, 0.7), 2e-3);
  }
}

TEST(CurvesOfAFile, HaveJumpsWhereItSteps) {
  const FileFunction file{.opacity = {{0.0, 0.2, 0.5, 1.0}, {10.0, 0.8}, {10.0, 0.4}, {20.0, 0.4}}};
  const TransferCurves curves = curvesOf("f", file);
  EXPECT_NEAR(opacityOf(curves, 0.2499), 0.2, 1e-3);
  EXPECT_NEAR(opacityOf(curves, 0.2501), 0.8, 1e-3);
  EXPECT_NEAR(opacityOf(curves, 0.4999), 0.8, 1e-3);
  EXPECT_NEAR(opacityOf(curves, 0.5001), 0.4, 1e-3);
  for (std::size_t i = 1; i < curves.opacity.size(); ++i) EXPECT_LT(curves.opacity[i - 1].x, curves.opacity[i].x);
  const TransferCurves steps = curvesOf("f", {.color = {{0.0, kRed}, {1.0, kBlue}, {2.0, kRed}}, .space = ColorSpace::Step});
  expectColor(colorAt(steps, 0.25), kBlue, 1e-3);
  expectColor(colorAt(steps, 0.75), kRed, 1e-3);
}

TEST(CurvesOfAFile, OfAMapHaveARamp) {
  const TransferCurves curves = curvesOf("f", {.color = {{0.0, kRed}, {1.0, kBlue}}});
  EXPECT_EQ(opacityOf(curves, 0.5), 0.5 * kMapOpacity);
  EXPECT_EQ(curves.unitShare, kMapUnitShare);
}

TEST(CurvesOfAFile, LeaveOutPointsOnALine) {
  FileFunction file;
  for (int i = 0; i <= 1000; ++i) file.opacity.push_back({double(i), 0.001 * double(i)});
  const TransferCurves curves = curvesOf("f", file);
  EXPECT_LT(curves.opacity.size(), 30u);
  EXPECT_NEAR(opacityOf(curves, 0.337), 0.337, 1e-3);
}

TEST(CurvesOfAFile, AreSortedAndLimited) {
  const TransferCurves curves = curvesOf("f", {.opacity = {{5.0, 1.5}, {-5.0, -0.5}}});
  EXPECT_EQ(curves.window, (ValueWindow{-5.0, 5.0}));
  EXPECT_EQ(curves.opacity.front().opacity, 0.0);
  EXPECT_EQ(curves.opacity.back().opacity, 1.0);
}

TEST(CurvesOfAFile, RefuseWhatIsNoFunction) {
  EXPECT_THROW(curvesOf("f", {}), Error);
  for (const double wrong : {test::kNan, test::kInfinity, 1e200}) {
    EXPECT_THROW(curvesOf("f", {.opacity = {{wrong, 0.5}}}), Error);
    if (wrong != 1e200) { EXPECT_THROW(curvesOf("f", {.opacity = {{0.0, wrong}}}), Error); }
  }
  FileFunction large;
  large.opacity.resize(kMaxFilePoints + 1, {0.0, 0.0});
  EXPECT_THROW(curvesOf("f", large), Error);
}

}  // namespace
}  // namespace freevoxels
