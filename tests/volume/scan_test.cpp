#include "engine/volume/scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/volume/procedural.h"
#include "engine/volume/transfer_curves.h"

namespace freevoxels {
namespace {

/// Boxes in one another, a quarter, a half and all of the edge, of these values from the outside in; values differ by +-2 % of
/// the range, as measured ones do.
Volume nested(float outer, float middle, float inner, float core) {
  return makeVolume({32, 32, 32}, glm::dmat4(1.0), [=](int x, int y, int z) {
    const int ring = std::min({x, 31 - x, y, 31 - y, z, 31 - z});
    const float noise = 0.02f * std::abs(core - outer) * std::sin(float(7 * x + 13 * y + 29 * z));
    return noise + (ring < 6 ? outer : ring < 10 ? middle : ring < 13 ? inner : core);
  });
}

float opacityAt(const TransferFunction& function, float scalar) {
  const auto& points = function.opacity;
  if (scalar <= points.front().scalar) return points.front().opacity;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (scalar > points[i].scalar) continue;
    const float part = (scalar - points[i - 1].scalar) / (points[i].scalar - points[i - 1].scalar);
    return points[i - 1].opacity + part * (points[i].opacity - points[i - 1].opacity);
  }
  return points.back().opacity;
}

void expectValid(const Volume& volume) {
  const TransferFunction function = scanTransferFunction(volume);
  for (std::size_t i = 1; i < function.opacity.size(); ++i)
    EXPECT_LT(function.opacity[i - 1].scalar, function.opacity[i].scalar);
  for (std::size_t i = 1; i < function.color.size(); ++i) EXPECT_LT(function.color[i - 1].scalar, function.color[i].scalar);
  const TransferFunction again = fitted(parseTransferCurves("inline", transferFunctionJson(function)), volume);
  ASSERT_EQ(again.opacity.size(), function.opacity.size());
  for (std::size_t i = 0; i < function.opacity.size(); ++i) {
    EXPECT_EQ(again.opacity[i].scalar, function.opacity[i].scalar);
    EXPECT_EQ(again.opacity[i].opacity, function.opacity[i].opacity);
  }
  ASSERT_EQ(again.color.size(), function.color.size());
  for (std::size_t i = 0; i < function.color.size(); ++i) {
    EXPECT_EQ(again.color[i].scalar, function.color[i].scalar);
    EXPECT_EQ(again.color[i].color, function.color[i].color);
  }
  EXPECT_EQ(again.unitDistance, function.unitDistance);
}

TEST(Scan, FullBoxesAndNegativeValuesLookLikeOne) {
  EXPECT_TRUE(looksLikeScan(nested(0.0f, 40.0f, 90.0f, 255.0f)));
  EXPECT_TRUE(looksLikeScan(makeVolume({20, 20, 20}, glm::dmat4(1.0), [](int x, int y, int) {
    return x > 5 ? kInactiveVoxel : float(y) - 10.0f;
  })));
}

TEST(Scan, WhatTheFileCallsFogIsNoneHoweverFullItIs) {
  Volume fog = nested(0.0f, 0.4f, 0.9f, 2.55f);
  fog.isFog = true;
  fog.negativeVoxels = 0;
  EXPECT_FALSE(looksLikeScan(fog));
  fog.negativeVoxels = fog.activeVoxels / 10;
  EXPECT_TRUE(looksLikeScan(fog)) << "densities are not negative";
}

/// A cylinder of air, with a body in it, in a box that is filled up with one value.
Volume padded(glm::ivec3 size, float padding, float air, float body) {
  return makeVolume(size, glm::dmat4(1.0), [=](int x, int y, int z) {
    const glm::dvec2 place = 2.0 * glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(size) - 1.0;
    float noise = 0.0f;  // with most values near 0, as measurements have it
    for (const float wave : {7.3f, 11.9f, 3.7f, 17.1f}) noise += 0.005f * std::abs(body - air) * std::sin(wave * float(x + 3 * y + 7 * z));
    const double distance = glm::length(place);
    return distance > 1.0 ? padding : noise + (distance > 0.6 ? air : body);
  });
}

TEST(Scan, PaddingIsRecognisedByItsShareOfTheSidesAndItsDistance) {
  for (const glm::ivec3 size : {glm::ivec3(32, 32, 20), glm::ivec3(61, 47, 33)}) {
    for (const float padding : {-2000.0f, -3024.0f, -32768.0f, 32767.0f, -9999.0f, 9.97e36f})
      EXPECT_EQ(paddingOf(padded(size, padding, -1000.0f, 60.0f)), padding) << padding;
    Volume metal = padded(size, -2000.0f, -1000.0f, 60.0f);
    for (int i = 0; i < 40; ++i) metal.scalars.set(size / 2 + glm::ivec3(i % 4, i / 4 % 4, i / 16) - 2, 1000.0f + 50.0f * float(i));
    summariseValues(metal);
    EXPECT_EQ(paddingOf(metal), -2000.0f) << "metal is far away, too";
    EXPECT_EQ(paddingOf(padded(size, -1000.0f, -1000.0f, 60.0f)), std::nullopt) << "it is air";
    EXPECT_EQ(paddingOf(padded(size, -1024.0f, -1000.0f, 60.0f)), std::nullopt) << "it is drawn as air";
    EXPECT_EQ(paddingOf(padded(size, 0.0f, 300.0f, 1000.0f)), std::nullopt) << "0 may be air";
  }
  const Volume labels =
      makeVolume({20, 20, 20}, glm::dmat4(1.0), [](int x, int y, int z) { return float(1 + (x > 6) + 4 * (y > 9) * (z > 3)); });
  EXPECT_TRUE(looksLikeScan(labels));
  EXPECT_EQ(paddingOf(labels), std::nullopt) << "few different values are labels";
  Volume fog = padded({32, 32, 20}, 9.0f, 1.0f, 2.0f);
  fog.isFog = true;
  EXPECT_EQ(paddingOf(fog), std::nullopt);
}

TEST(Scan, WithoutItsPaddingAScanHasTransparentAir) {
  Volume scan = padded({48, 48, 30}, -3024.0f, -1000.0f, 600.0f);
  ASSERT_EQ(paddingOf(scan), -3024.0f);
  settleNoData(scan, {});
  EXPECT_EQ(scan.padding, -3024.0f);
  EXPECT_TRUE(looksLikeScan(scan));
  EXPECT_GT(scan.minimum, -1100.0f);
  const TransferFunction function = scanTransferFunction(scan);
  EXPECT_EQ(opacityAt(function, -1000.0f), 0.0f);
  EXPECT_GT(opacityAt(function, 600.0f), 0.1f);
}

TEST(Scan, FogUniformVolumesAndLevelSetsAreNone) {
  EXPECT_FALSE(looksLikeScan(makeVolume({20, 20, 20}, glm::dmat4(1.0), [](int x, int y, int) {
    return x > 15 ? kInactiveVoxel : float(y);
  })));
  EXPECT_FALSE(looksLikeScan(makeVolume({20, 20, 20}, glm::dmat4(1.0), [](int, int, int) { return 1.0f; })));
  Volume levelSet = nested(0.0f, 0.3f, 0.6f, 1.0f);
  levelSet.isSolid = true;
  EXPECT_FALSE(looksLikeScan(levelSet));
}

TEST(Scan, TransferFunctionIsTransparentOutsideAndMoreOpaqueFromClassToClass) {
  const TransferFunction function = scanTransferFunction(nested(-1000.0f, -100.0f, 60.0f, 1200.0f));
  EXPECT_EQ(opacityAt(function, -1000.0f), 0.0f);
  EXPECT_EQ(opacityAt(function, -100.0f), 0.03f);
  EXPECT_EQ(opacityAt(function, 60.0f), 0.12f);
  EXPECT_EQ(opacityAt(function, 1200.0f), 0.6f);
  EXPECT_EQ(function.unitDistance, 32.0 / 128.0);
}

TEST(Scan, TransferFunctionOfDarkThingsInBrightOnesIsTransparentOutsideToo) {
  const TransferFunction function = scanTransferFunction(nested(255.0f, 200.0f, 90.0f, 0.0f));
  EXPECT_EQ(opacityAt(function, 255.0f), 0.0f);
  EXPECT_EQ(opacityAt(function, 200.0f), 0.03f);
  EXPECT_EQ(opacityAt(function, 90.0f), 0.12f);
  EXPECT_EQ(opacityAt(function, 0.0f), 0.6f);
}

TEST(Scan, TransferFunctionOfSidesOfAllClassesIsTransparentAtTheLowest) {
  const Volume ramp = makeVolume({64, 8, 8}, glm::dmat4(1.0), [](int x, int, int) { return float(x); });
  const TransferFunction function = scanTransferFunction(ramp);
  EXPECT_EQ(opacityAt(function, 2.0f), 0.0f);
  EXPECT_EQ(opacityAt(function, 62.0f), 0.6f);
}

TEST(Scan, AFunctionOfOtherValuesDrawsTheAir) {
  const auto draws = [](const Volume& volume, float first, float last) {
    const TransferFunction function{.opacity = {{first, 0.0f}, {last, 0.5f}}, .color = {{first, glm::vec3(1.0f)}}, .unitDistance = 1.0};
    return drawsAir(volume, function);
  };
  const Volume scan = nested(300.0f, 340.0f, 700.0f, 1200.0f);
  EXPECT_TRUE(draws(scan, 0.0f, 1000.0f)) << "as the air is 300";
  EXPECT_FALSE(draws(scan, 400.0f, 1000.0f));
  EXPECT_FALSE(draws(makeVolume({32, 32, 32}, glm::dmat4(1.0), [](int x, int y, int z) { return float((x * 7 + y * 5 + z * 3) % 100); }),
                     -100.0f, 100.0f))
      << "without air, what is on the sides is meant";
  EXPECT_FALSE(draws(nested(1.0f, 1.0f, 1.0f, -0.5f), 0.0f, 1.0f)) << "dark things in bright ones";
}

TEST(Scan, TransferFunctionLeavesOutliersAside) {
  const Volume usual = nested(0.0f, 40.0f, 90.0f, 200.0f);
  const Volume volume = makeVolume({32, 32, 32}, glm::dmat4(1.0), [&](int x, int y, int z) {
    std::vector<float> row(32);
    usual.scalars.copyRow(y, z, row);
    return x == 16 && y == 16 && z == 16 ? 1e4f : row[std::size_t(x)];
  });
  const TransferFunction function = scanTransferFunction(volume);
  EXPECT_EQ(opacityAt(function, 0.0f), 0.0f);
  EXPECT_EQ(opacityAt(function, 90.0f), 0.12f);
  EXPECT_EQ(opacityAt(function, 200.0f), 0.6f);
}

TEST(Scan, TransferFunctionIsValidForFewOrNearlyEqualValues) {
  expectValid(nested(-1000.0f, -100.0f, 60.0f, 1200.0f));
  expectValid(nested(0.0f, 0.0f, 1.0f, 1.0f));
  expectValid(makeVolume({9, 9, 9}, glm::dmat4(1.0), [](int x, int, int) { return x == 4 ? 1.0f : 0.0f; }));
  expectValid(makeVolume({9, 9, 9}, glm::dmat4(1.0), [](int x, int, int) { return x == 4 ? std::nextafter(1.0f, 2.0f) : 1.0f; }));
}

}  // namespace
}  // namespace freevoxels
