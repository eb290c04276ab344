// What the viewer shows in place of the volume, of boxes whose depths are known.

#include "apps/view/diagnosis.h"

#include <cmath>

#include "engine/scene/directions.h"
#include "engine/volume/procedural.h"
#include "tests/device/device_fixture.h"

namespace freevoxels {
namespace {

constexpr int kEdge = 16;
constexpr double kDepth = 2.0;  ///< of the whole box along an axis
constexpr double kHalfCode =
    0.0068;  ///< of a transmittance: sqrt(16 t) exp(-t) / 255 at t = 1/2, where it is most

class DiagnosisTest : public DeviceTest {
 protected:
  static int directionTowards(glm::dvec3 wanted) {
    for (int i = 0; i < directionCount(DirectionSet::Directions26); ++i)
      if (directionAt(DirectionSet::Directions26, i) == wanted) return i;
    return -1;
  }
  static glm::vec4 pixelAt(const Image& image, double x, double y) {
    const glm::ivec2 place(x * image.size.x, y * image.size.y);
    return image.pixels[std::size_t(place.x) + std::size_t(image.size.x) * std::size_t(place.y)];
  }
  Image diagnosis(const Diagnosis& shown, FrameSettings settings = {.size = {64, 64}, .method = SplatSettings{}}) {
    return diagnoser.make(shown, renderer, volume, {}, camera, settings);
  }

  /// Homogeneous, in a larger box that holds nothing at low x.
  const Volume volume = makeVolume(glm::ivec3(kEdge), glm::dmat4(1.0), [](int x, int, int) {
    return x < kEdge / 4 ? double(kInactiveVoxel) : 1.0;
  });
  const Camera camera{.position = {7.5, 7.5, 100.0},
                      .lookAt = {7.5, 7.5, 7.5},
                      .orthographic = true,
                      .orthographicHeight = double(kEdge)};
  Renderer renderer{device(), volume, {.densityScale = kDepth / kEdge}, {}};
  Diagnoser diagnoser{device()};
};

/// Across z, x is to the right and y upwards: the light falls from the right end on.
TEST_F(DiagnosisTest, ASliceOfTheTableHasTheTransmittancesToTheOutside) {
  const Image image =
      diagnosis({.shown = Shown::TableSlice, .direction = directionTowards({1.0, 0.0, 0.0}), .axis = 2});
  for (int x = kEdge / 4; x < kEdge; ++x)
    EXPECT_NEAR(pixelAt(image, (x + 0.5) / kEdge, 0.5).r, std::exp(-kDepth / kEdge * (kEdge - 1 - x)),
                kHalfCode)
        << x;
  const glm::vec4 nothing = pixelAt(image, 0.5 / kEdge, 0.5);
  EXPECT_NE(nothing.r, nothing.b) << "no grey where there is nothing";
  const Image upwards =
      diagnosis({.shown = Shown::TableSlice, .direction = directionTowards({0.0, 1.0, 0.0}), .axis = 2});
  EXPECT_NEAR(pixelAt(upwards, 0.5, 0.5 / kEdge).r, 1.0f, 1e-6f);
  EXPECT_NEAR(pixelAt(upwards, 0.5, 1.0 - 0.5 / kEdge).r, std::exp(-kDepth * (kEdge - 1) / kEdge), kHalfCode);
}

TEST_F(DiagnosisTest, TransmittanceIsThatOfTheBox) {
  const Image image = diagnosis({.shown = Shown::Transmittance});
  EXPECT_NEAR(pixelAt(image, 0.6, 0.5).r, std::exp(-kDepth), 2e-3);
  EXPECT_NEAR(pixelAt(image, 0.05, 0.5).r, 1.0f, 1e-6f);
}

TEST_F(DiagnosisTest, EnergyIsOverItsLargest) {
  const Image image = diagnosis({.shown = Shown::Energy});
  float largest = 0.0f;
  for (const glm::vec4& pixel : image.pixels) largest = std::max(largest, pixel.r);
  EXPECT_FLOAT_EQ(largest, 1.0f);
  EXPECT_GT(pixelAt(image, 0.6, 0.5).r, 0.9f);
  EXPECT_EQ(pixelAt(image, 0.05, 0.5).r, 0.0f);
}

/// From the light's side the volume is white, from the other dark.
TEST_F(DiagnosisTest, TheTableOnTheVolumeIsBrightWhereItsDirectionComesOut) {
  const Image towards =
      diagnosis({.shown = Shown::TableImage, .direction = directionTowards({0.0, 0.0, 1.0})});
  const Image away =
      diagnosis({.shown = Shown::TableImage, .direction = directionTowards({0.0, 0.0, -1.0})});
  EXPECT_GT(pixelAt(towards, 0.6, 0.5).r, 0.8f);
  EXPECT_LT(pixelAt(away, 0.6, 0.5).r, 0.3f);
}

/// All are left out by one that looks past them.
TEST_F(DiagnosisTest, BlocksAreThoseOfTheCameraTheyWereChosenFor) {
  const FrameSettings settings{.size = {64, 64}, .method = SplatSettings{}, .lod = 0.0f};
  const Image own = diagnosis({.shown = Shown::Blocks}, settings);
  EXPECT_GT(pixelAt(own, 0.6, 0.5).r + pixelAt(own, 0.6, 0.5).g + pixelAt(own, 0.6, 0.5).b, 0.1f);
  EXPECT_EQ(pixelAt(own, 0.05, 0.5), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  Camera elsewhere = camera;  // sees nothing of it
  elsewhere.lookAt.x += 1000.0;
  elsewhere.position.x += 1000.0;
  const Image none = diagnosis({.shown = Shown::Blocks, .chosenFor = elsewhere}, settings);
  const glm::vec4 leftOut = pixelAt(none, 0.6, 0.5);
  EXPECT_GT(leftOut.r, 2.0f * leftOut.g) << "dark red";
}

}  // namespace
}  // namespace freevoxels
