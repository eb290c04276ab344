#include "apps/view/slice_view.h"

#include <gtest/gtest.h>

#include "engine/image/srgb.h"
#include "engine/volume/procedural.h"

namespace freevoxels {
namespace {

/// The grey of a texel.
int greyAt(const std::vector<std::uint8_t>& texels, int width, int column, int row) {
  return texels[4 * (std::size_t(row) * std::size_t(width) + std::size_t(column))];
}

/// Grey levels of sRGB that are in proportion to the values.
Classification greyFrom(float low, float high) {
  TransferFunction function{.opacity = {{low, 0.5f}}, .color = {}};
  for (int level = 0; level < 256; ++level) {
    const float part = float(level) / 255.0f;
    function.color.push_back({low + part * (high - low), glm::vec3(linearFromSrgb(part))});
  }
  return {.transferFunction = function};
}

TEST(SliceTexels, HaveTheValuesOfTheirVoxels) {
  Volume volume = makeVolume({5, 4, 3}, glm::dmat4(1.0), [](int x, int y, int z) {
    return x == 4 ? kInactiveVoxel : float(x + 4 * y + 16 * z);
  });
  volume.up = {0.0, 0.0, 1.0};
  const Classification grey = greyFrom(0.0f, 51.0f);  // 5 grey levels a unit
  const auto axial = sliceTexels(volume, grey, 2, 1), coronal = sliceTexels(volume, grey, 1, 2), sagittal = sliceTexels(volume, grey, 0, 3);
  ASSERT_EQ(axial.size(), 4u * 5u * 4u);
  EXPECT_EQ(greyAt(axial, 5, 2, 0), 5 * (2 + 4 * 3 + 16)) << "the top row has the largest y";
  EXPECT_EQ(greyAt(axial, 5, 0, 3), 5 * 16);
  EXPECT_EQ(greyAt(coronal, 5, 3, 2), 5 * (3 + 8)) << "z is upwards";
  EXPECT_EQ(greyAt(sagittal, 4, 1, 0), 5 * (3 + 4 + 32));
  EXPECT_NE(axial[4 * 4 + 2], axial[4 * 4]) << "a voxel without data is not grey";
  volume.up = {0.0, 1.0, 0.0};
  EXPECT_EQ(greyAt(sliceTexels(volume, grey, 0, 3), 3, 1, 0), 5 * (3 + 12 + 16)) << "y is upwards where it is up in the world";
}

TEST(SliceTexels, ValuesBeyondTheRangeAreBlackAndWhite) {
  const Volume volume = makeVolume({3, 1, 1}, glm::dmat4(1.0), [](int x, int, int) { return float(x); });
  const auto texels = sliceTexels(volume, greyFrom(0.9f, 1.1f), 2, 0);
  EXPECT_EQ(greyAt(texels, 3, 0, 0), 0);
  EXPECT_NEAR(greyAt(texels, 3, 1, 0), 127, 1);
  EXPECT_EQ(greyAt(texels, 3, 2, 0), 255);
}

TEST(SliceView, SidesOfAPatientAreThoseOfTheWorldOfScans) {
  Volume scan;
  scan.lengthUnit = "mm";
  scan.up = {0.0, 0.0, 1.0};
  scan.indexToWorld = glm::dmat4(glm::dmat3({0.1, 2.0, 0.0}, {-3.0, 0.2, 0.0}, {0.0, 0.3, -1.0}));
  EXPECT_EQ(patientSide(scan, 0, false), 'P');
  EXPECT_EQ(patientSide(scan, 0, true), 'A');
  EXPECT_EQ(patientSide(scan, 1, false), 'R');
  EXPECT_EQ(patientSide(scan, 1, true), 'L');
  EXPECT_EQ(patientSide(scan, 2, false), 'I');
  EXPECT_EQ(patientSide(scan, 2, true), 'S');
  scan.lengthUnit.clear();
  EXPECT_EQ(patientSide(scan, 2, true), 0) << "nobody lies in this world";
}

}  // namespace
}  // namespace freevoxels
