// Renderer::reclassify: frames with another transfer function are those of a new renderer.

#include <memory>
#include <vector>

#include "engine/core/error.h"
#include "engine/renderer.h"
#include "engine/volume/subject.h"
#include "engine/volume/transfer_table.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/image_measures.h"

namespace freevoxels {
namespace {

class ReclassifyTest : public DeviceTest {
 protected:
  /// A ball of scalars that fall from 1 in its middle to 0 and below outside, in a box whose last bricks and cells are not full.
  static Volume ball() {
    const glm::ivec3 dimensions(67, 50, 41);
    return makeVolume(dimensions, cubeTransform(dimensions), [](int x, int y, int z) {
      const glm::dvec3 place = glm::dvec3(x - 33, y - 25, z - 20) / glm::dvec3(33.0, 25.0, 20.0);
      return 1.0 - glm::length(place);
    });
  }
  /// Opaque from a scalar on.
  static Classification above(float scalar, glm::vec3 color = glm::vec3(0.9f, 0.6f, 0.3f)) {
    Classification classification;
    classification.transferFunction = {.opacity = {{scalar, 0.0f}, {scalar + 0.05f, 0.4f}},
                                       .color = {{0.0f, color}, {1.0f, glm::vec3(1.0f) - color}},
                                       .unitDistance = 0.02};
    return classification;
  }
  /// With surfaces that shadow each other and light that is scattered.
  static Lighting light() {
    Lighting lighting;
    lighting.lights = {{.place = {0.4, 0.8, 0.6}}};
    lighting.ambient = glm::dvec3(0.2);
    lighting.surface = 1.0;
    lighting.scattering = kAllOrders;
    return lighting;
  }
  static std::vector<FrameSettings> kindsOfFrames() {
    FrameSettings plain{.size = {90, 70}, .lod = 0.0f}, lit = plain, coarse = lit, projected = plain, perVoxel = plain;
    lit.lighting = light();
    coarse.lod = 8.0f;
    coarse.lighting = light();
    projected.gather().projection = IntensityProjection::Maximum;
    perVoxel.lighting = light();
    for (int i = 0; i < 5; ++i) perVoxel.lighting->lights.push_back({.place = {1.0, 0.2 * i, -0.5}, .intensity = 0.3});
    FrameSettings fog = perVoxel;
    fog.lighting->surface = 0.0;  // whose source terms are kept from frame to frame
    FrameSettings splats{.size = {90, 70}, .method = SplatSettings{}};
    FrameSettings sorted = splats;
    sorted.splats().composite = Composite::Sorted;
    sorted.lod = 0.0f;
    return {plain, lit, coarse, projected, perVoxel, fog, splats, sorted};
  }
  /// Begins a frame, and gives it up when its progress is reported for the time after `calls`.
  static void renderGivenUp(Renderer& renderer, const Camera& view, const FrameSettings& settings, int calls) {
    struct GivenUp {};
    int left = calls;
    try {
      renderer.render(view, settings, [&](std::string_view, double) {
        if (left-- == 0) throw GivenUp();
      });
    } catch (const GivenUp&) {
    }
  }
  static Camera camera(const Volume& volume, double azimuth) { return framingCamera(volume, azimuth, 20.0, 1.2, {}); }
};

TEST_F(ReclassifyTest, FramesAreThoseOfANewRendererWhateverWasDrawnBefore) {
  const Volume volume = ball();
  const std::vector<FrameSettings> kinds = kindsOfFrames();
  // Less and less is seen, then more, with bricks that are added; then as much in other colours.
  const std::vector<Classification> functions{above(0.5f), above(0.8f), above(0.3f), above(0.05f),
                                              above(0.05f, glm::vec3(0.1f, 0.8f, 0.2f))};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    Renderer renderer(device(), volume, functions.front(), {});
    for (std::size_t i = 0; i < functions.size(); ++i) {
      ASSERT_TRUE(renderer.reclassify(functions[i]));
      Renderer another(device(), volume, functions[i], {});
      // The second camera's rays have another axis, whose quads are older than the function where it was used before.
      for (double azimuth : i % 2 == 0 ? std::vector{10.0, 100.0} : std::vector{10.0})
        EXPECT_EQ(renderer.render(camera(volume, azimuth), kinds[kind]).pixels, another.render(camera(volume, azimuth), kinds[kind]).pixels)
            << "kind " << kind << ", function " << i << ", azimuth " << azimuth;
    }
  }
}

TEST_F(ReclassifyTest, FramesOfOtherKindsFollowEachOther) {
  const Volume volume = ball();
  const std::vector<FrameSettings> kinds = kindsOfFrames();
  Renderer renderer(device(), volume, above(0.6f), {});
  for (std::size_t i = 0; i < 2 * kinds.size(); ++i) {
    const Classification function = above(0.6f - 0.04f * float(i));
    ASSERT_TRUE(renderer.reclassify(function));
    const FrameSettings& settings = kinds[i % kinds.size()];
    Renderer another(device(), volume, function, {});
    const Camera view = camera(volume, 25.0 * double(i));
    EXPECT_EQ(renderer.render(view, settings).pixels, another.render(view, settings).pixels) << "frame " << i;
  }
}

TEST_F(ReclassifyTest, NarrowFunctionsGiveScalarsOtherCodes) {
  const Volume volume = ball();
  const FrameSettings settings{.size = {90, 70}, .lod = 0.0f, .lighting = light()};
  const Camera view = camera(volume, 40.0);
  Renderer renderer(device(), volume, above(0.4f), {});
  renderer.render(view, settings);
  for (const float width : {0.05f, 0.01f, 0.02f, 100.0f}) {
    Classification narrow = above(0.4f);
    narrow.transferFunction->opacity = {{0.4f, 0.0f}, {0.4f + width, 0.5f}};
    narrow.transferFunction->color = {{0.4f, glm::vec3(0.8f)}};
    const TransferTable table(*narrow.transferFunction, volume.minimum, volume.maximum);
    EXPECT_EQ(table.high() < volume.maximum, width < 0.1f);
    ASSERT_TRUE(renderer.reclassify(narrow));
    Renderer another(device(), volume, narrow, {});
    EXPECT_EQ(renderer.render(view, settings).pixels, another.render(view, settings).pixels) << width;
  }
}

TEST_F(ReclassifyTest, OldLightIsAllowedForDraftsAlone) {
  const Volume volume = ball();
  FrameSettings draft{.size = {90, 70}, .lod = 0.0f, .lighting = light()};
  const FrameSettings whole = draft;
  draft.allowsOldLight = true;
  const Camera view = camera(volume, 40.0);
  Renderer renderer(device(), volume, above(0.7f), {});
  renderer.render(view, whole);
  const Classification function = above(0.1f);
  ASSERT_TRUE(renderer.reclassify(function));
  const Image quick = renderer.render(view, draft), complete = renderer.render(view, whole);
  Renderer another(device(), volume, function, {});
  EXPECT_EQ(complete.pixels, another.render(view, whole).pixels);
  EXPECT_NE(quick.pixels, complete.pixels);
  EXPECT_GT(psnr(quick, complete), 15.0) << "the light of a smaller ball is not that of this one, but its surface is";
  // Light that is not old is not made again for a draft.
  EXPECT_EQ(renderer.render(view, draft).pixels, complete.pixels);
}

TEST_F(ReclassifyTest, LightOfVoxelsInADraftIsNotThatOfTheFrameAfterIt) {
  const Volume volume = ball();
  FrameSettings whole = kindsOfFrames()[5];
  FrameSettings draft = whole;
  draft.allowsOldLight = true;
  const Camera view = camera(volume, 40.0);
  Renderer renderer(device(), volume, above(0.3f), {});
  renderer.render(view, whole);
  const Classification function = above(0.6f);
  ASSERT_TRUE(renderer.reclassify(function));
  renderer.render(view, draft);
  Renderer another(device(), volume, function, {});
  EXPECT_EQ(renderer.render(view, whole).pixels, another.render(view, whole).pixels);
}

TEST_F(ReclassifyTest, ADraftFollowsAFrameThatWasGivenUp) {
  const Volume volume = ball();
  const FrameSettings whole{.size = {90, 70}, .lod = 0.0f, .lighting = light()};
  FrameSettings draft = whole;
  draft.allowsOldLight = true;
  const Camera view = camera(volume, 40.0);
  for (int calls = 0; calls < 8; ++calls) {
    Renderer renderer(device(), volume, above(0.7f), {});
    renderer.render(view, whole);
    ASSERT_TRUE(renderer.reclassify(above(0.4f)));
    renderGivenUp(renderer, view, whole, calls);
    ASSERT_TRUE(renderer.reclassify(above(0.2f)));
    EXPECT_NO_THROW(renderer.render(view, draft)) << "given up after " << calls << " calls";
    Renderer another(device(), volume, above(0.2f), {});
    EXPECT_EQ(renderer.render(view, whole).pixels, another.render(view, whole).pixels) << "given up after " << calls << " calls";
  }
}

TEST_F(ReclassifyTest, AFrameThatWasGivenUpLosesNothing) {
  const Volume volume = ball();
  const FrameSettings settings{.size = {90, 70}, .lod = 0.0f, .lighting = light()};
  const Camera view = camera(volume, 40.0);
  for (int calls = 0; calls < 6; ++calls) {
    Renderer renderer(device(), volume, above(0.7f), {});
    renderer.render(view, settings);
    const Classification function = above(0.2f);
    ASSERT_TRUE(renderer.reclassify(function));
    renderGivenUp(renderer, view, settings, calls);
    Renderer another(device(), volume, function, {});
    EXPECT_EQ(renderer.render(view, settings).pixels, another.render(view, settings).pixels) << "given up after " << calls << " calls";
  }
}

TEST_F(ReclassifyTest, OtherOrdersOfClassificationAreRefused) {
  const Volume volume = ball();
  Renderer renderer(device(), volume, above(0.5f), {});
  Classification pre = above(0.4f);
  pre.order = ClassificationOrder::Pre;
  EXPECT_FALSE(renderer.reclassify(pre));
  EXPECT_FALSE(renderer.reclassify({.densityScale = 3.0}));
  const FrameSettings settings{.size = {60, 50}, .lod = 0.0f};
  Renderer another(device(), volume, above(0.5f), {});
  const Camera view = camera(volume, 0.0);
  EXPECT_EQ(renderer.render(view, settings).pixels, another.render(view, settings).pixels) << "nothing has changed";
  Renderer before(device(), volume, pre, {});
  EXPECT_FALSE(before.reclassify(above(0.4f)));
}

}  // namespace
}  // namespace freevoxels
