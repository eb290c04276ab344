// FrameSettings::clip: drafts of a volume whose rays are clipped, beside images of what is left of the volume.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/renderer.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"
#include "tests/image_measures.h"

namespace freevoxels {
namespace {

class RayClipTest : public DeviceTest {
 protected:
  /// What is clipped, in both forms.
  struct Cut {
    ClipPlane plane;
    RayClip rays;
  };

  RayClipTest() : volume(makeProcedural("head", 71)) {
    function.transferFunction = {.opacity = {{0.1f, 0.0f}, {0.2f, 0.3f}, {0.6f, 0.35f}, {1.0f, 0.9f}},
                                 .color = {{0.0f, {0.9f, 0.5f, 0.4f}}, {1.0f, {0.9f, 0.9f, 0.8f}}},
                                 .unitDistance = 0.03};
    densities.densityScale = 12.0f;
    dense = function;
    dense.transferFunction->unitDistance = 0.002;
  }

  /// A plane through a point of the volume, which is given in parts of its box.
  Cut cut(glm::dvec3 part, glm::dvec3 normal) const {
    const glm::dvec3 place = part * glm::dvec3(volume.dimensions - 1);
    Cut cut{.plane = {.point = glm::dvec3(volume.indexToWorld * glm::dvec4(place, 1.0)), .normal = normal},
            .rays = {.low = glm::dvec3(-0.5), .high = glm::dvec3(volume.dimensions) - 0.5}};
    const glm::dvec3 inIndexSpace = glm::normalize(glm::transpose(glm::dmat3(volume.indexToWorld)) * normal);
    cut.rays.normal = inIndexSpace;
    cut.rays.distance = glm::dot(inIndexSpace, place);
    return cut;
  }

  Image draw(const Volume& drawn, const Classification& classification, const FrameSettings& settings) {
    return Renderer(device(), drawn, classification, {}).render(camera(), settings);
  }
  /// Towards the sides that are cut.
  Camera camera() const { return framingCamera(volume, 35.0, 25.0, 1.1, {}); }

  static FrameSettings lit(FrameSettings settings, Light light, double surface) {
    settings.lighting.emplace();
    settings.lighting->lights = {light};
    settings.lighting->surface = surface;
    return settings;
  }

  const Volume volume;
  Classification function, densities, dense;
  const FrameSettings plain{.size = {110, 100}};
};

TEST_F(RayClipTest, DraftsResembleTheClippedVolumeWhateverLightsIt) {
  const std::vector<Cut> cuts{cut({0.5, 0.5, 0.5}, {0.4, 0.2, 1.0}), cut({0.6, 0.5, 0.6}, {1.0, 0.1, 0.2}),
                              cut({0.5, 0.65, 0.5}, {0.0, 1.0, 0.0})};
  const Light sun{.place = {0.6, 0.7, 0.9}};
  const Light lamp{.place = camera().position, .atInfinity = false, .intensity = 8.0};
  const std::vector<FrameSettings> kinds{plain, lit(plain, sun, 0.0), lit(plain, sun, 1.0), lit(plain, lamp, 0.0)};
  for (const Classification* classification : {&function, &dense, &densities})
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const Image uncut = draw(volume, *classification, kinds[kind]);
      Renderer renderer(device(), volume, *classification, {});
      for (std::size_t i = 0; i < cuts.size(); ++i) {
        const Image whole = draw(clippedVolume(volume, cuts[i].plane), *classification, kinds[kind]);
        FrameSettings draft = kinds[kind];
        draft.clip = cuts[i].rays;
        const double likeWhole = psnr(renderer.render(camera(), draft), whole), likeUncut = psnr(uncut, whole);
        const std::string what = fmt::format("{}, kind {}, cut {}",
                                             classification == &function ? "function"
                                             : classification == &dense  ? "dense function"
                                                                         : "densities",
                                             kind, i);
        // Depths end within dense material, so that what is behind it has no shadow.
        EXPECT_GT(likeWhole, classification == &dense ? 27.0 : 35.0) << what;
        if (classification == &dense) continue;
        EXPECT_GT(likeWhole, likeUncut + 6.0) << what;
      }
    }
}

TEST_F(RayClipTest, ABoxAroundTheVolumeChangesNothing) {
  for (const FrameSettings& kind : {plain, lit(plain, {.place = {0.6, 0.7, 0.9}}, 1.0)}) {
    FrameSettings clipped = kind;
    clipped.depth = true;
    clipped.clip = RayClip{.low = glm::dvec3(-2.0), .high = glm::dvec3(volume.dimensions + 1)};
    FrameSettings whole = kind;
    whole.depth = true;
    Renderer renderer(device(), volume, function, {});
    const Image a = renderer.render(camera(), whole), b = renderer.render(camera(), clipped);
    EXPECT_GT(psnr(b, a), 90.0);
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
      if (a.pixels[i].a < 0.5f) continue;
      ASSERT_NEAR(a.depth[i], b.depth[i], 1e-3) << i;
    }
  }
}

/// More than 24 bricks of air between them.
TEST_F(RayClipTest, AWallStaysInTheShadowOfAScreenFarAway) {
  const glm::ivec3 dimensions(290, 24, 24);
  const Volume room = makeVolume(dimensions, cubeTransform(dimensions), [](int x, int y, int z) {
    const bool isInside = std::min(y, z) > 3 && std::max(y, z) < 20;
    return isInside && ((x > 4 && x < 10 && y < 12) || (x > 275 && x < 285)) ? 1.0 : double(kInactiveVoxel);
  });
  Classification solid;
  solid.transferFunction = {.opacity = {{0.0f, 0.0f}, {1.0f, 0.9f}}, .color = {{0.0f, glm::vec3(0.8f)}}, .unitDistance = 0.004};
  FrameSettings settings = lit({.size = {60, 60}, .lod = 0.0f}, {.place = {-1.0, 0.0, 0.0}}, 0.0);
  const Camera view{.position = {-0.2, 0.3, 0.1}, .lookAt = {0.48, 0.0, 0.0}, .verticalFov = 10.0};
  Renderer renderer(device(), room, solid, {});
  const Image whole = renderer.render(view, settings);
  settings.clip = RayClip{.low = glm::dvec3(-0.5), .high = glm::dvec3(dimensions) - 0.5};
  const Image clipped = renderer.render(view, settings);
  EXPECT_GT(whole.pixels[30 * 60 + 30].a, 0.9f) << "the wall is seen";
  EXPECT_GT(psnr(clipped, whole), 40.0);
  settings.clip->low.x = 20.0;  // without the screen
  EXPECT_LT(psnr(renderer.render(view, settings), whole), 30.0);
}

TEST_F(RayClipTest, DistancesOfAProjectionCountFromTheEye) {
  FrameSettings projected{.size = {40, 40}, .lod = 0.0f, .depth = true};
  for (const IntensityProjection projection : {IntensityProjection::Maximum, IntensityProjection::Average}) {
    projected.gather().projection = projection;
    Renderer renderer(device(), volume, function, {});
    projected.clip.reset();
    const Image whole = renderer.render(camera(), projected);
    projected.clip = RayClip{.low = glm::dvec3(-0.5), .high = glm::dvec3(volume.dimensions) - 0.5};
    const Image clipped = renderer.render(camera(), projected);
    for (std::size_t i = 0; i < whole.depth.size(); ++i) {
      if (whole.pixels[i].a < 0.5f) continue;
      ASSERT_NEAR(clipped.depth[i], whole.depth[i], 0.05 * whole.depth[i]) << i;
    }
  }
}

/// Half of a box of fog, from the side of the cut and from behind, in a volume of other edges along each axis.
TEST_F(RayClipTest, HasTheOpacityOfWhatIsLeftByBeerLambert) {
  const glm::ivec3 dimensions(64, 40, 24);
  const Volume box = makeVolume(dimensions, cubeTransform(dimensions), [](int, int, int) { return 1.0; });
  Classification fog;
  fog.densityScale = 3.0f;
  for (const double azimuth : {0.0, 180.0, 90.0}) {
    const Camera view = framingCamera(box, azimuth, 0.0, 1.0, {.orthographic = true});
    FrameSettings settings{.size = {64, 64}, .lod = 0.0f};
    Renderer renderer(device(), box, fog, {});
    const auto depthOf = [&](const std::optional<RayClip>& clip) {
      settings.clip = clip;
      return -std::log1p(-double(renderer.render(view, settings).pixels[32 * 64 + 32].a));
    };
    RayClip half{.low = glm::dvec3(-0.5), .high = glm::dvec3(dimensions) - 0.5};
    const bool alongX = azimuth == 90.0;
    half.high[alongX ? 0 : 2] = 0.5 * dimensions[alongX ? 0 : 2] - 0.5;
    EXPECT_NEAR(depthOf(half) / depthOf({}), 0.5, 0.04) << azimuth;
  }
}

}  // namespace
}  // namespace freevoxels
