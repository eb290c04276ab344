// Slices against closed forms, and the side on which what is seen is.
#include "engine/volume/slice.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "engine/description/scene_description.h"
#include "engine/volume/channels.h"
#include "engine/volume/procedural.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

/// Colours that are the values themselves, from `low` to `high`; opacities differ, which do not matter.
Classification linear(float low, float high) {
  Classification classification;
  classification.transferFunction =
      TransferFunction{.opacity = {{low, 0.0f}, {high, 0.3f}}, .color = {{low, glm::vec3(0.0f)}, {high, glm::vec3(1.0f)}}};
  return classification;
}

Image draw(const Volume& volume, const Classification& classification, const SlicePlane& plane, glm::ivec2 size) {
  const Camera camera = sliceCamera(plane, volume.up, worldBox(volume), size);
  return drawSlice(volume, classification, slicePixels(volume, camera, size), size);
}

glm::vec4 at(const Image& image, int x, int y) {
  return image.pixels[std::size_t(y) * std::size_t(image.size.x) + std::size_t(x)];
}

/// Voxels of 2 x 1 x 0.5 whose box begins at (10, -3, 4).
glm::dmat4 place() {
  glm::dmat4 matrix(1.0);
  for (int axis = 0; axis < 3; ++axis) matrix[axis][axis] = std::array{2.0, 1.0, 0.5}[std::size_t(axis)];
  matrix[3] = {11.0, -2.5, 4.25, 1.0};
  return matrix;
}

TEST(Slice, ALinearFieldIsLinearInWorldUnitsAndPerCent) {
  Volume volume = makeVolume({10, 12, 16}, place(), [](int x, int y, int z) { return float(x + 2 * y + 3 * z); });
  volume.up = {0.0, 0.0, 1.0};
  const float most = 9 + 2 * 11 + 3 * 15;
  const glm::ivec2 size(80, 48);  // 4 pixels a world unit: the box is 20 x 12 across z
  for (const SlicePlane& plane : {SlicePlane{.axis = 2, .position = 7.0}, SlicePlane{.axis = 2, .position = 37.5, .isPercent = true}}) {
    const Image image = draw(volume, linear(0.0f, most), plane, size);
    for (const glm::ivec2 pixel : {glm::ivec2(10, 20), glm::ivec2(41, 7), glm::ivec2(70, 40)}) {
      const glm::dvec3 voxel((pixel.x + 0.5) / 8.0 - 0.5, (pixel.y + 0.5) / 4.0 - 0.5, (7.0 - 4.25) / 0.5);
      const glm::vec4 shown = at(image, pixel.x, pixel.y);
      EXPECT_NEAR(shown.r * most, voxel.x + 2.0 * voxel.y + 3.0 * voxel.z, 1e-3) << pixel.x << " " << pixel.y;
      EXPECT_EQ(shown.a, 1.0f) << "opacities do not count";
    }
  }
}

TEST(Slice, PixelsThatAreLargerThanVoxelsAreMeans) {
  Volume volume = makeVolume({64, 64, 1}, glm::dmat4(1.0), [](int x, int y, int) { return float((x + y) % 2); });
  volume.up = {0.0, 0.0, 1.0};
  const Image image = draw(volume, linear(0.0f, 1.0f), {.axis = 2, .position = 0.0}, {16, 16});
  for (const glm::vec4& pixel : image.pixels) EXPECT_NEAR(pixel.g, 0.5f, 1e-5f);
}

/// The only bright voxel is at the largest x, y and z: left, back and top of a patient.
TEST(Slice, ShowsScansAsRadiologyDoes) {
  Volume volume = makeVolume({3, 4, 5}, glm::dmat4(1.0), [](int x, int y, int z) { return x == 2 && y == 3 && z == 4 ? 1.0f : 0.0f; });
  volume.up = {0.0, 0.0, 1.0};
  const auto brightest = [&](int axis, glm::ivec2 size) {
    const Image image = draw(volume, linear(0.0f, 1.0f), {.axis = axis, .position = 100.0, .isPercent = true}, size);
    glm::ivec2 found(0);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (at(image, x, y).r > at(image, found.x, found.y).r) found = {x, y};
    return found;
  };
  EXPECT_EQ(brightest(2, {3, 4}), glm::ivec2(2, 3)) << "axial: the left on the right, the back at the bottom";
  EXPECT_EQ(brightest(1, {3, 5}), glm::ivec2(2, 0)) << "coronal: the left on the right, the head at the top";
  EXPECT_EQ(brightest(0, {4, 5}), glm::ivec2(3, 0)) << "sagittal: the back on the right, the head at the top";
  volume.up = {0.0, 1.0, 0.0};
  EXPECT_EQ(brightest(1, {3, 5}), glm::ivec2(2, 0)) << "from below, where up is +y: +z at the top";
  EXPECT_EQ(brightest(2, {3, 4}), glm::ivec2(2, 0)) << "from +z";
  EXPECT_EQ(brightest(0, {5, 4}), glm::ivec2(0, 0)) << "from +x: +z on the left";
  volume.up = {0.0, -1.0, 0.0};
  EXPECT_EQ(brightest(2, {3, 4}), glm::ivec2(2, 3)) << "rows of an image go down";
}

TEST(Slice, FitsTheBoxAndLeavesTheRestEmpty) {
  Volume volume = makeVolume({4, 2, 2}, glm::dmat4(1.0), [](int, int, int) { return 1.0f; });
  volume.up = {0.0, 0.0, 1.0};
  const Image image = draw(volume, linear(0.0f, 1.0f), {.axis = 2, .position = 0.5}, {8, 8});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(at(image, x, y).a, y >= 2 && y < 6 ? 1.0f : 0.0f) << x << " " << y;
}

TEST(Slice, VoxelsWithoutDataDoNotCount) {
  Volume volume = makeVolume({4, 1, 1}, glm::dmat4(1.0), [](int x, int, int) { return x < 2 ? 0.5f : kInactiveVoxel; });
  volume.up = {0.0, 0.0, 1.0};
  const Image image = draw(volume, linear(0.0f, 1.0f), {.axis = 2, .position = 0.0}, {8, 2});
  EXPECT_EQ(at(image, 1, 0), glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  EXPECT_NEAR(at(image, 3, 0).a, 0.75f, 1e-6f);
  EXPECT_NEAR(at(image, 3, 0).r, 0.5f * 0.75f, 1e-6f) << "premultiplied, of the value of those that have data";
  EXPECT_EQ(at(image, 6, 0), glm::vec4(0.0f));
}

TEST(Slice, AnObliqueVolumeIsCutInTheWorld) {
  const double c = std::sqrt(0.5);
  glm::dmat4 turned(glm::dvec4(c, c, 0, 0), glm::dvec4(-c, c, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, 0, 0, 1));
  Volume volume = makeVolume({9, 9, 3}, turned, [](int x, int, int) { return float(x); });
  volume.up = {0.0, 0.0, 1.0};
  const glm::ivec2 size(40, 40);
  const Camera camera = sliceCamera({.axis = 2, .position = 1.0}, volume.up, worldBox(volume), size);
  const Image image = drawSlice(volume, linear(0.0f, 8.0f), slicePixels(volume, camera, size), size);
  EXPECT_EQ(at(image, 0, 0).a, 0.0f) << "the corner of the square that stands on a corner";
  EXPECT_NEAR(at(image, 19, 19).r * 8.0f, 4.0f, 0.3f);
}

TEST(Slice, LabelsHaveTheirColoursAndAreNotInterpolated) {
  Volume volume = makeVolume({12, 8, 8}, glm::dmat4(1.0), [](int x, int, int) { return x < 3 ? 0.0f : x < 6 ? 2.0f : 4.0f; });
  showLabels(volume, Labels{.styles = {{2, {.color = glm::vec3(1, 0, 0)}}, {4, {.color = glm::vec3(0, 0, 1), .opacity = 0.5f}}}});
  volume.up = {0.0, 0.0, 1.0};
  const Image image = draw(volume, ClassificationDescription().resolveSliced(volume), {.axis = 2, .position = 4.0}, {24, 16});
  for (int x = 0; x < 24; ++x)
    EXPECT_EQ(at(image, x, 8), x < 6 ? glm::vec4(0.0f) : x < 12 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1)) << x;
}

TEST(Slice, ChannelsAreSumsOfTheirColoursOverBlack) {
  for (const bool emits : {false, true}) {
    Volume volume = makeVolume({8, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return 0.0f; });
    const auto filled = [&](float value, int from) {
      return ScalarBricks::make(volume.dimensions, [=](glm::ivec3 voxel) { return voxel.x < from ? 0.0f : value; });
    };
    mixChannels(volume,
                {{.name = "a", .color = glm::vec3(1, 0, 0), .window = std::array{0.0f, 1.0f}, .emits = emits},
                 {.name = "b", .color = glm::vec3(0, 1, 0), .window = std::array{0.0f, 1.0f}, .emits = emits}},
                {filled(0.5f, 0), filled(0.25f, 4)});
    volume.up = {0.0, 0.0, 1.0};
    const Image image = draw(volume, ClassificationDescription().resolveSliced(volume), {.axis = 2, .position = 2.0}, {8, 4});
    EXPECT_NEAR(glm::distance(at(image, 1, 1), glm::vec4(0.5f, 0.0f, 0.0f, 1.0f)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(at(image, 6, 1), glm::vec4(0.5f, 0.25f, 0.0f, 1.0f)), 0.0f, 1e-6f);
  }
}

TEST(Slice, APlaneBesideTheVolumeIsRefused) {
  const Volume volume = makeVolume({4, 4, 4}, glm::dmat4(1.0), [](int, int, int) { return 1.0f; });
  for (const SlicePlane& plane : {SlicePlane{.axis = 1, .position = 3.75}, SlicePlane{.axis = 1, .position = 100.5, .isPercent = true}})
    test::expectRefusal(
        [&] {
          sliceCamera(plane, volume.up, worldBox(volume), {8, 8});
        },
        ErrorKind::Usage, {"slice", "-0.5", "3.5", "along y", "y:50%"});
}

TEST(Slice, WithoutATransferFunctionValuesAreGrey) {
  const Volume volume = makeVolume({32, 8, 8}, glm::dmat4(1.0), [](int x, int, int) { return float(x) - 10.0f; });
  const Classification plain = ClassificationDescription().resolveSliced(volume);
  ASSERT_TRUE(plain.transferFunction);
  EXPECT_LT(classify(plain, -10.0f).color.r, 0.01f);
  EXPECT_GT(classify(plain, 21.0f).color.r, 0.99f);
  ClassificationDescription given{.transferFunction = "viridis", .window = ValueWindow{0.0, 1.0}, .invert = true};
  const Classification classification = given.resolveSliced(volume);
  EXPECT_GT(classify(classification, 0.0f).color.g, classify(classification, 1.0f).color.g);
}

}  // namespace
}  // namespace freevoxels
