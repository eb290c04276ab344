// Single rays of gathered frames: what they add up depends neither on the rays beside them nor on what of the volume is skipped.

#include <algorithm>
#include <numeric>
#include <random>

#include "engine/renderer_stages.h"
#include "engine/volume/scan.h"
#include "tests/device/gather_fixture.h"

namespace freevoxels {
namespace {

class GatherRaysTest : public GatherTest {
 protected:
  /// Opaque from a scalar on, within two thousandths.
  static TransferFunction step(double at) {
    const auto edge = float(at);
    return {.opacity = {{0.0f, 0.0f}, {edge, 0.0f}, {edge + 0.002f, 0.9f}, {1.0f, 0.9f}},
            .color = {{0.0f, {0.9f, 0.5f, 0.2f}}, {1.0f, {0.3f, 0.6f, 1.0f}}},
            .unitDistance = 1.0 / 64.0};
  }
  /// Opacity that grows slowly, of which a stretch into 0.7 has to have all.
  static TransferFunction ramp() {
    TransferFunction function = step(0.0);
    function.opacity = {{0.0f, 0.0f}, {0.1f, 0.0f}, {0.5f, 0.6f}, {1.0f, 0.6f}};
    return function;
  }
  /// Opaque between two scalars that are near each other.
  static TransferFunction shell(double at) {
    TransferFunction function = step(at);
    const auto edge = float(at);
    function.opacity = {{0.0f, 0.0f}, {edge, 0.0f}, {edge + 0.001f, 0.5f}, {edge + 0.02f, 0.5f}, {edge + 0.021f, 0.0f}, {1.0f, 0.0f}};
    return function;
  }
  static Scene scene(Volume volume, TransferFunction function, ClassificationOrder order = ClassificationOrder::Post) {
    Scene made{.volume = std::move(volume), .classification = {}};
    made.classification.transferFunction = std::move(function);
    made.classification.order = order;
    return made;
  }
  /// Smooth blobs with voxels that have no data between them; no edge is a multiple of a brick's.
  static Volume blobs(glm::ivec3 size) {
    return makeVolume(size, shearedTransform(size), [](int x, int y, int z) {
      const double value = 0.4 + 0.2 * std::sin(0.31 * x + 0.2 * z) + 0.2 * std::sin(0.23 * y - 0.17 * x) + 0.2 * std::sin(0.29 * z + 0.11 * y);
      return value < 0.25 ? double(kInactiveVoxel) : value;
    });
  }
  static Lighting lights(int count, double surface) {
    Lighting lighting{.ambient = glm::dvec3(0.2), .surface = surface};
    for (int i = 0; i < count; ++i) lighting.lights.push_back({.place = {1.0 - 0.4 * i, 0.7, 0.3 * i - 0.2}});
    return lighting;
  }
};

/// In the frame's order, in another one, and alone: a vector of a CPU's lanes has other rays each time, which leave its loops at other
/// times.
TEST_F(GatherRaysTest, HaveTheSameBitsBesideOtherRaysAndAlone) {
  const std::vector<Scene> scenes{scene(makeProcedural("cloud", 64), shell(0.3)),
                                  scene(makeProcedural("head", 72), step(0.35)),
                                  scene(blobs({61, 47, 70}), shell(0.5)),
                                  scene(blobs({33, 64, 41}), step(0.6), ClassificationOrder::Pre),
                                  cloud(56),
                                  {.volume = makeProcedural("fire", 48), .classification = {.densityScale = 20.0, .emission = Emission{.strength = 5.0}}}};
  const std::vector<std::optional<Lighting>> lightings{{}, lights(1, 0.0), lights(2, 0.6), lights(5, 0.0)};
  std::mt19937 generator(5);
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    Renderer renderer(device(), scenes[s].volume, scenes[s].classification, {});
    for (std::size_t l = 0; l < lightings.size(); ++l) {
      SCOPED_TRACE(testing::Message() << "scene " << s << ", lighting " << l);
      FrameSettings settings = gathering({120, 104});
      settings.lighting = lightings[l];
      settings.gather().sampleTolerance = 0.0f;
      settings.lod = l == 1 ? 3.0f : 0.0f;
      Camera base;
      base.orthographic = (s + l) % 2 == 1;
      const Camera camera = framingCamera(scenes[s].volume, 35.0 + 50.0 * double(l), 25.0, 120.0 / 104.0, base);
      const std::vector<GatherSums> whole = RendererStages(renderer).renderGatherStages(camera, settings).gathered;
      std::vector<std::uint32_t> seen;
      for (std::size_t i = 0; i < whole.size(); ++i)
        if (whole[i].energy > 0.0) seen.push_back(std::uint32_t(i));
      ASSERT_GT(seen.size(), 1000u);
      const auto expectSame = [&](const std::vector<std::uint32_t>& places) {
        const std::vector<GatherSums> sums = RendererStages(renderer).marchListed(camera, settings, places);
        for (const std::uint32_t i : places) {
          ASSERT_EQ(sums[i].energy, whole[i].energy) << "sample " << i;
          ASSERT_EQ(sums[i].color, whole[i].color) << "sample " << i;
          ASSERT_EQ(sums[i].distance, whole[i].distance) << "sample " << i;
        }
      };
      std::ranges::shuffle(seen, generator);
      expectSame(seen);
      for (std::size_t i = 0; i < 3; ++i) expectSame({seen[i]});
    }
  }
}

/// Columns of 8² voxels along an axis, opaque up to a slice that differs from column to column, then 0 or without data. Next neighbours
/// along the positive sides end earlier, so that they do not keep rays from skipping.
Volume staircase(int axis, int slices, bool fromBelow, bool dense) {
  constexpr int kColumns = 6;
  glm::ivec3 size(8 * kColumns);
  size[axis] = slices;
  return makeVolume(size, cubeTransform(glm::ivec3(64)), [&](int x, int y, int z) {
    const glm::ivec3 voxel(x, y, z);
    const int column = voxel[(axis + 1) % 3] / 8 + kColumns * (voxel[(axis + 2) % 3] / 8);
    const int end = 7 + kColumns * kColumns - 1 - column;
    const int slice = fromBelow ? slices - 1 - voxel[axis] : voxel[axis];
    return slice < end ? 0.7 : dense ? 0.0 : double(kInactiveVoxel);
  });
}

/// Material that ends on every slice of groups that are skipped together, of bricks and of blocks' cells: all columns look the same. Groups
/// end at the same slices as cells if the volume's last slice is a cell's.
TEST_F(GatherRaysTest, EndWithTheSameLightWhereverMaterialBegins) {
  const auto check = [](const Scene& stairs, glm::dvec3 way, const std::optional<Lighting>& lighting) {
    Renderer renderer(device(), stairs.volume, stairs.classification, {});
    const glm::dvec3 middle = 0.5 * glm::dvec3(stairs.volume.dimensions - 1);
    Camera camera{.lookAt = glm::dvec3(stairs.volume.indexToWorld * glm::dvec4(middle, 1.0))};
    camera.position = camera.lookAt + 4.0 * way;
    camera.up = {way.y, way.z, way.x};
    camera.orthographic = true;
    camera.orthographicHeight = 48.0 / 64.0;
    FrameSettings settings = gathering({192, 192});
    settings.lighting = lighting;
    const Image image = renderer.render(camera, settings);
    const glm::vec4 first = image.pixels[16 + 192 * 16];
    EXPECT_GT(first.a, 0.95f);
    EXPECT_GT(first.r, 0.1f);
    for (int column = 1; column < 36; ++column) {
      const glm::vec4 pixel = image.pixels[std::size_t(16 + 32 * (column % 6) + 192 * (16 + 32 * (column / 6)))];
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(pixel[c], first[c], 1e-3f) << "column " << column << ", channel " << c;
    }
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int slices : {44, 45})
      for (const bool fromBelow : {false, true})
        for (const bool dense : {false, true})
          for (const ClassificationOrder order : {ClassificationOrder::Post, ClassificationOrder::Pre}) {
            SCOPED_TRACE(testing::Message() << "order " << int(order) << ", axis " << axis << ", " << slices << " slices"
                                            << (fromBelow ? " from below" : " from above") << (dense ? ", dense" : ", sparse"));
            const Scene stairs = scene(staircase(axis, slices, fromBelow, dense), ramp(), order);
            glm::dvec3 way(0.0);
            way[axis] = fromBelow ? -1.0 : 1.0;
            check(stairs, way, std::nullopt);
            check(stairs, way, Lighting{.lights = {{.place = way}}});
          }
}

/// Obliquely onto the end of the material, and from nearby: as near to the oracle wherever the material ends.
TEST_F(GatherRaysTest, AreAsExactWhereverMaterialBegins) {
  for (const bool dense : {true, false}) {
    std::vector<double> far, near;
    for (const int end : {11, 12, 13, 14, 15, 16, 17, 18}) {
      const glm::ivec3 size(42, 44, 32);
      const auto fill = [&](int, int, int z) { return z < end ? 0.7 : dense ? 0.0 : double(kInactiveVoxel); };
      const Scene slab = scene(makeVolume(size, cubeTransform(size), fill), ramp());
      const auto at = [&](glm::dvec3 voxel) { return glm::dvec3(slab.volume.indexToWorld * glm::dvec4(voxel, 1.0)); };
      const auto quality = [&](glm::dvec3 eye, double fov) {
        Camera camera{.position = at(eye), .lookAt = at({20.5, 21.5, double(end)})};
        camera.verticalFov = fov;
        return std::min(qualityOf(slab, camera, gathering({32, 32})), 60.0);
      };
      far.push_back(quality({50.0, 40.0, end + 60.0}, 16.0));
      near.push_back(quality({19.0, 22.0, end + 9.0}, 60.0));
    }
    for (const std::vector<double>& found : {far, near}) {
      const auto [least, most] = std::ranges::minmax(found);
      EXPECT_LT(most - least, 1.0) << (dense ? "dense " : "sparse ") << testing::PrintToString(found);
      EXPECT_GT(least, 40.0) << testing::PrintToString(found);
    }
  }
}

}  // namespace
}  // namespace freevoxels
