// Splat sums on the device against the double-precision reference: perspective and orthographic, any voxel
// shape, both kinds of primitive.

#include "engine/volume/subject.h"
#include "tests/device/splat_fixture.h"

namespace freevoxels {
namespace {

TEST_F(SplatTest, PerspectiveMatchesTheReference) {
  const Volume v = volume(false);
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.25, {}), {.size = {125, 100}, .method = SplatSettings{}});
}

TEST_F(SplatTest, ShearedVoxelsMatchTheReference) {
  const Volume v = volume(true);
  expectSameImage(v, framingCamera(v, -110.0, -40.0, 0.8, {}), {.size = {96, 120}, .method = SplatSettings{}});
}

TEST_F(SplatTest, OrthographicMatchesTheReference) {
  const Volume v = volume(true);
  Camera base;
  base.orthographic = true;
  expectSameImage(v, framingCamera(v, 20.0, 60.0, 1.0, base), {.size = {100, 100}, .method = SplatSettings{}});
  expectSameImage(v, framingCamera(v, 0.0, 0.0, 1.0, base), {.size = {100, 100}, .method = SplatSettings{}});
}

TEST_F(SplatTest, ThePapersSettingsMatchTheReference) {
  const Volume v = volume(false);
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}),
                  {.size = {90, 90}, .method = SplatSettings{.composite = Composite::Additive, .attenuation = AttenuationLookup::Nearest}},
                  {AttenuationCode::Linear8, false});
}

TEST_F(SplatTest, NinetyEightDirectionsMatchTheReference) {
  const Volume v = volume(true);
  const TableSettings table{.directions = DirectionSet::Directions98};
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.25, {}), {.size = {125, 100}, .method = SplatSettings{}}, table);
  expectSameImage(v, framingCamera(v, -110.0, -40.0, 1.0, {}),
                  {.size = {90, 90}, .method = SplatSettings{.attenuation = AttenuationLookup::Nearest}}, table);
}

TEST_F(SplatTest, WideAngleMatchesTheReference) {
  const Volume v = volume(false);
  Camera base;
  base.verticalFov = 110.0;
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, base), {.size = {120, 120}, .method = SplatSettings{}});
}

TEST_F(SplatTest, TelephotoMatchesTheReference) {
  const Volume v = volume(true);
  Camera base;
  base.verticalFov = 2.0;
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, base), {.size = {120, 120}, .method = SplatSettings{}});
}

TEST_F(SplatTest, ExtremelyWideImagesMatchTheReference) {
  const Volume v = volume(false);
  const Camera close{.position = {0.0, 0.0, 0.8}, .lookAt = {0.0, 0.0, -0.2}, .verticalFov = 60.0};
  expectSameImage(v, close, {.size = {8000, 4}, .method = SplatSettings{}});
  expectSameImage(v, close, {.size = {4, 3000}, .method = SplatSettings{}});
}

/// Where a pixel is 15° wide, the rim of a widened footprint is further away than its bounds in the middle say: a pixel's ray there is
/// nearer to the voxel than the distance on the image tells.
TEST_F(SplatTest, WidenedFootprintsReachTheirRimsInWidePixels) {
  const Volume v = volume(false);
  const Camera close{.position = {0.0, 0.0, 0.8}, .lookAt = {0.0, 0.0, -0.2}, .verticalFov = 60.0};
  const Classification classification = coloured(v, 0.5f);
  const FrameSettings settings{.size = {64, 4}, .method = SplatSettings{}, .lod = 0.0f};
  Renderer renderer(device(), v, classification, {});
  EXPECT_LE(largestPixelDifference(renderer.render(close, settings), reference(v, classification, {}, close, settings)), 5e-6);
}

TEST_F(SplatTest, VoxelsSmallerThanPixelsMatchTheReference) {
  const Volume v = volume(true);
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {7, 7}, .method = SplatSettings{}, .lod = 0.0f});
}

TEST_F(SplatTest, SplatsLargerThanTheLargestPointMatchTheReference) {
  const Volume v = randomVolume({3, 3, 3}, cubeTransform({3, 3, 3}), 0.8, 1.0);
  const int size =
      700;  // a voxel is over 100 pixels wide, its footprint nearly 400: more than points can be here
  expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {size, size}, .method = SplatSettings{}});
}

TEST_F(SplatTest, SplatsCentredOutsideTheImageStillReachIntoIt) {
  const Volume v = volume(false);
  Camera camera = framingCamera(v, 35.0, 25.0, 1.0, {});
  camera.verticalFov /= 6.0;
  camera.lookAt += glm::dvec3(0.2, 0.1, 0.0);
  expectSameImage(v, camera, {.size = {80, 80}, .method = SplatSettings{}});
}

TEST_F(SplatTest, OpaqueVolumesMatchTheReference) {
  const Volume v = randomVolume(kSize, shearedTransform(kSize), 1.0, 1.0);
  for (const AttenuationCode code : {AttenuationCode::Depth8, AttenuationCode::Linear8})
    expectSameImage(v, framingCamera(v, 35.0, 25.0, 1.0, {}), {.size = {90, 90}, .method = SplatSettings{}}, {.code = code}, 1.0f);
}

/// The table's depths end at 16, and a voxel of this medium has almost as much by itself: what is deep in it
/// is as dark at the rims of its splats as in their middles, as voxels and as blocks.
TEST_F(SplatTest, WhatIsDeepInAnOpaqueMediumDoesNotShine) {
  const glm::ivec3 dimensions(40);
  const Volume volume = makeVolume(dimensions, cubeTransform(dimensions), [&](int x, int y, int z) {
    const glm::ivec3 p(x, y, z), toFace = glm::min(p, dimensions - 1 - p);
    return std::min({toFace.x, toFace.y, toFace.z}) < 8 ? 1.0 : 2.0;
  });
  Classification classification;
  classification.transferFunction = TransferFunction{
      .opacity = {{0.0f, 1.0f}},
      .color = {{1.0f, {0.0f, 0.0f, 1.0f}}, {1.001f, {1.0f, 0.0f, 0.0f}}, {2.0f, {1.0f, 0.0f, 0.0f}}},
      .unitDistance = 0.7 * volume.voxelSize()};
  Renderer renderer(device(), volume, classification, {});
  for (const float lod : {0.0f, 9.0f}) {
    const Image image = renderer.render(framingCamera(volume, 35.0, 25.0, 1.0, {}),
                                        {.size = {96, 96}, .method = SplatSettings{.culling = false}, .lod = lod});
    float brightest = 0.0f;
    for (const glm::vec4& pixel : image.pixels) brightest = std::max(brightest, pixel.r);
    EXPECT_LT(brightest, 4e-3f) << "lod " << lod;
  }
}

}  // namespace
}  // namespace freevoxels
