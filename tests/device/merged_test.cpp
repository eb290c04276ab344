// Several volumes in one image: against the oracle, which marches all of them, against their own images, and whatever their order.

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/gathering/merged_pass.h"
#include "engine/renderer.h"
#include "engine/validation/stage_frames.h"
#include "tests/device/gather_fixture.h"

namespace freevoxels {
namespace {

/// A scene of volumes in memory.
struct Media {
  std::vector<std::shared_ptr<const Volume>> volumes;
  std::vector<Classification> classifications;

  void add(Volume volume, const Classification& classification) {
    volumes.push_back(std::make_shared<const Volume>(std::move(volume)));
    classifications.push_back(classification);
  }
  std::vector<SceneVolume> scene(bool reversed = false) const {
    std::vector<SceneVolume> all;
    for (std::size_t k = 0; k < volumes.size(); ++k) {
      const std::size_t i = reversed ? volumes.size() - 1 - k : k;
      all.push_back({.source = std::make_shared<const VolumeInMemory>(volumes[i]), .classification = classifications[i]});
    }
    return all;
  }
  std::vector<PlacedMedium> placed() const {
    std::vector<PlacedMedium> all;
    for (std::size_t i = 0; i < volumes.size(); ++i) all.push_back({volumes[i].get(), &classifications[i]});
    return all;
  }
};

glm::dmat4 turned(double angle, glm::dvec3 offset, double scale = 1.0) {
  const double c = std::cos(angle), s = std::sin(angle);
  glm::dmat4 matrix(1.0);
  matrix[0] = {scale * c, 0.3 * scale * s, -scale * s, 0.0};
  matrix[1] = {0.0, scale, 0.2 * scale, 0.0};
  matrix[2] = {scale * s, -0.1 * scale, scale * c, 0.0};
  matrix[3] = glm::dvec4(offset, 1.0);
  return matrix;
}

class MergedTest : public GatherTest {
 protected:
  /// Fog of 40³ and of 29x23x31 voxels through each other, of other colours and sizes of voxels.
  static Media twoFogs() {
    Media media;
    Volume cloud = makeProcedural("cloud", 40);
    media.add(cloud, {.densityScale = automaticDensityScale(cloud, 1.5), .albedo = glm::vec3(0.9f, 0.4f, 0.2f)});
    const glm::ivec3 n(29, 23, 31);
    Volume ball = makeVolume(n, turned(0.6, {0.1, -0.05, 0.08}, 0.9) * cubeTransform(n), [n](int x, int y, int z) {
      const glm::dvec3 place = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(n) - 0.5;
      return std::max(0.0, 1.0 - 4.0 * glm::dot(place, place)) * (1.0 + 0.3 * std::sin(0.6 * x + 0.4 * z));
    });
    media.add(ball, {.densityScale = automaticDensityScale(ball, 1.5), .albedo = glm::vec3(0.2f, 0.5f, 0.9f)});
    return media;
  }
  static Camera viewOf(const Media& media, double aspect = 1.0) { return framingCamera(*media.volumes.front(), 35.0, 25.0, aspect, {}); }
  static double quality(const Media& media, const Camera& camera, const FrameSettings& settings) {
    Renderer renderer(device(), media.scene(), {});
    const Oracle oracle = renderOracle(media.placed(), camera,
                                       {.size = settings.size, .tolerance = 4e-3, .maximumSamples = 8, .lighting = settings.lighting});
    return psnr(renderer.render(camera, settings), oracle.image);
  }
};

TEST_F(MergedTest, TwoFogsThroughEachOtherMatchTheOracle) {
  const Media media = twoFogs();
  EXPECT_GE(quality(media, viewOf(media), gathering({48, 48})), 50.0);
  EXPECT_GE(quality(media, cameraInside(*media.volumes[0], viewOf(media)), gathering({48, 48})), 45.0);
}

/// Of rays that meet some of the volumes, the last one that they meet is now one volume and now another.
TEST_F(MergedTest, ThreeFogsMatchTheOracleInAnyOrder) {
  Media media = twoFogs();
  const glm::ivec3 n(17, 21, 19);
  Volume ball = makeVolume(n, turned(-0.4, {-0.3, 0.3, 0.35}, 0.6) * cubeTransform(n), [n](int x, int y, int z) {
    const glm::dvec3 place = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(n) - 0.5;
    return std::max(0.0, 1.0 - 4.0 * glm::dot(place, place));
  });
  media.add(ball, {.densityScale = automaticDensityScale(ball, 1.5), .albedo = glm::vec3(0.3f, 0.9f, 0.3f)});
  const FrameSettings settings = gathering({48, 48});
  EXPECT_GE(quality(media, viewOf(media), settings), 50.0);
  Renderer one(device(), media.scene(), {}), other(device(), media.scene(true), {});
  EXPECT_EQ(one.render(viewOf(media), settings).pixels, other.render(viewOf(media), settings).pixels);
}

/// Extinctions add up: what is interpolated between the voxels of a dense cloud, too.
TEST_F(MergedTest, TwoHalvesOfADenseCloudMatchTheOracleOfTheCloud) {
  const Volume cloud = makeProcedural("cloud", 24);
  Media media;
  for (int half = 0; half < 2; ++half) media.add(cloud, {.densityScale = 10.0});
  const Camera camera = viewOf(media);
  const FrameSettings settings = gathering({48, 40});
  Renderer renderer(device(), media.scene(), {});
  const Oracle whole = renderOracle(cloud, {.densityScale = 20.0}, camera, {.size = settings.size, .tolerance = 4e-3, .maximumSamples = 8});
  EXPECT_GE(psnr(renderer.render(camera, settings), whole.image), 50.0);
}

TEST_F(MergedTest, TwoFogsInALightMatchTheOracle) {
  const Media media = twoFogs();
  FrameSettings settings = gathering({40, 40});
  settings.lighting = Lighting{.lights = {{.place = {0.4, 1.0, 0.3}}}};
  EXPECT_GE(quality(media, viewOf(media), settings), 40.0);
}

/// A step at half of the range, and fog of other voxels turned into it: as near as the scan alone, whose edges are what is missed.
TEST_F(MergedTest, FogInAScanMatchesTheOracle) {
  Media media = twoFogs();
  Volume head = makeProcedural("head", glm::ivec3(37, 36, 41));
  Classification bone;
  bone.transferFunction = TransferFunction{.opacity = {{0.0f, 0.0f}, {0.45f, 0.0f}, {0.55f, 0.6f}, {1.0f, 0.8f}},
                                           .color = {{0.0f, {0.9f, 0.8f, 0.6f}}, {1.0f, {1.0f, 1.0f, 0.9f}}},
                                           .unitDistance = head.voxelSize()};
  media.volumes.front() = std::make_shared<const Volume>(std::move(head));
  media.classifications.front() = bone;
  const Media alone{.volumes = {media.volumes.front()}, .classifications = {bone}};
  const double ofScan = quality(alone, viewOf(media), gathering({64, 64}));
  EXPECT_GE(quality(media, viewOf(media), gathering({64, 64})), ofScan - 0.5);
}

/// Two volumes that no ray meets both of: their images are put together.
TEST_F(MergedTest, VolumesBesideEachOtherAreAsEachAlone) {
  Media media;
  for (const double x : {-0.8, 0.8}) {
    Volume cloud = makeProcedural("cloud", 24);
    cloud.indexToWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0.0, 0.0)) * cloud.indexToWorld;
    media.add(cloud, {.densityScale = automaticDensityScale(cloud, 2.0)});
  }
  Camera camera;
  camera.position = {0.0, 0.0, 6.0};
  const FrameSettings settings = gathering({96, 48});
  Renderer both(device(), media.scene(), {});
  Image sum = both.render(camera, settings);
  for (std::size_t i = 0; i < 2; ++i) {
    Renderer one(device(), *media.volumes[i], media.classifications[i], {});
    const Image alone = one.render(camera, settings);
    for (std::size_t p = 0; p < sum.pixels.size(); ++p) sum.pixels[p] -= alone.pixels[p];
  }
  Image nothing = sum;
  nothing.pixels.assign(sum.pixels.size(), glm::vec4(0.0f));
  EXPECT_GE(psnr(sum, nothing), 55.0);
}

TEST_F(MergedTest, PartsAddUpToTheSameBits) {
  const Media media = twoFogs();
  FrameSettings settings = gathering({56, 48});
  settings.depth = true;
  Renderer renderer(device(), media.scene(), {});
  const FixedSums whole = renderer.renderShares(viewOf(media), settings, {});
  FixedSums sums = renderer.renderShares(viewOf(media), settings, {0, 3});
  for (int part = 1; part < 3; ++part) sums += renderer.renderShares(viewOf(media), settings, {part, 3});
  EXPECT_EQ(sums.values, whole.values);
  EXPECT_GE(psnr(resolveSums(whole, true), renderer.render(viewOf(media), settings)), 80.0);
}

TEST_F(MergedTest, TintedLightOfAllOrdersMatchesTheOracle) {
  const Media media = twoFogs();
  FrameSettings settings = gathering({24, 24});
  settings.lighting = Lighting{.lights = {{.place = {0.4, 1.0, 0.3}}, {.place = {1.5, 0.2, 0.4}, .atInfinity = false, .intensity = 3.0}},
                               .ambient = glm::dvec3(0.3),
                               .tint = {0.7, 1.0, 1.5},
                               .phaseG = 0.4,
                               .scattering = kAllOrders};
  EXPECT_GE(quality(media, viewOf(media), settings), 40.0);
}

TEST(SlabPlan, CoversAllVolumesWithTheThinnestSlabsWhereTheyOverlap) {
  const std::array<SlabExtent, 3> extents{{{1.0, 5.0, 0.5}, {3.0, 7.0, 0.25}, {9.0, 10.0, 1.0}}};
  const SlabPlan plan = planSlabs(extents);
  ASSERT_EQ(plan.intervals.size(), 4u);
  EXPECT_EQ(plan.slabs, 4 + 8 + 8 + 1);
  EXPECT_FLOAT_EQ(plan.intervals[1].perUnit, 4.0f);
  EXPECT_FLOAT_EQ(plan.intervals[3].begin, 9.0f);
  EXPECT_FLOAT_EQ(plan.intervals[3].first, 20.0f);
}

TEST(SlabPlan, HasNoMoreSlabsThanCanBeNumbered) {
  const std::array<SlabExtent, 2> extents{{{0.0, 1.0, 1e-6}, {1e6, 2e6, 0.1}}};
  EXPECT_LE(planSlabs(extents).slabs, shader::kMaxSlabs);
}

TEST_F(MergedTest, TheOrderOfVolumesChangesNoBit) {
  const Media media = twoFogs();
  FrameSettings settings = gathering({40, 32});
  settings.lighting = Lighting{.lights = {{.place = {0.4, 1.0, 0.3}}}, .ambient = glm::dvec3(0.2), .scattering = kAllOrders};
  Renderer one(device(), media.scene(), {}), other(device(), media.scene(true), {});
  EXPECT_EQ(one.render(viewOf(media), settings).pixels, other.render(viewOf(media), settings).pixels);
}

}  // namespace
}  // namespace freevoxels
