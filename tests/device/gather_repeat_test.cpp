// Frames of many kinds, drawn again, by other numbers of threads and share by share: the same bits.

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "engine/volume/scan.h"
#include "tests/device/gather_fixture.h"

namespace freevoxels {
namespace {

class GatherRepeatTest : public GatherTest {
 protected:
  /// A device that has this many threads, if it is a CPU whose driver reads LP_NUM_THREADS.
  struct Threads {
    explicit Threads(const char* count) {
      setenv("LP_NUM_THREADS", count, 1);
      instance.emplace(true, [](std::string_view) {});
      device.emplace(*instance, "");
      unsetenv("LP_NUM_THREADS");
    }
    std::optional<Instance> instance;
    std::optional<Device> device;
  };

  static std::vector<Scene> scenes() {
    const auto edge = [](float from, float to, float opacity) {
      return TransferFunction{.opacity = {{0.0f, 0.0f}, {from, 0.0f}, {from + 1e-3f, opacity}, {to, opacity}, {to + 1e-3f, 0.0f}},
                              .color = {{0.0f, {0.9f, 0.6f, 0.2f}}, {1.0f, {0.2f, 0.5f, 1.0f}}},
                              .unitDistance = 1.0 / 128.0};
    };
    std::vector<Scene> scenes;
    const auto add = [&](Volume volume, Classification classification) {
      scenes.push_back({.volume = std::move(volume), .classification = std::move(classification)});
    };
    const Volume cloud = makeProcedural("cloud", 128), head = makeProcedural("head", glm::ivec3(131, 128, 141));
    const Volume noise = randomVolume({129, 63, 135}, shearedTransform({129, 63, 135}), 0.4, 1.0);
    add(cloud, {.densityScale = automaticDensityScale(cloud, 2.0)});
    add(cloud, {.transferFunction = edge(0.3f, 0.32f, 0.5f)});
    add(cloud, {.transferFunction = edge(0.3f, 1.0f, 0.9f), .order = ClassificationOrder::Pre});
    add(head, {.transferFunction = scanTransferFunction(head)});
    add(head, {.transferFunction = edge(0.35f, 1.0f, 0.9f)});
    add(head, {.transferFunction = edge(0.2f, 0.22f, 0.4f), .order = ClassificationOrder::Pre});
    add(noise, {.transferFunction = edge(0.5f, 0.55f, 0.3f)});
    add(noise, {.densityScale = automaticDensityScale(noise, 1.0)});
    add(makeProcedural("fire", 128), {.densityScale = 10.0, .emission = Emission{.strength = 5.0}});
    add(makeProcedural("shells", 128), {.transferFunction = edge(0.4f, 0.9f, 0.05f)});
    return scenes;
  }

  struct View {
    Camera camera;
    FrameSettings settings;
  };
  /// The last one has more lights than are evaluated at samples if `crowded`. Light of all orders takes longer than the rest.
  static std::vector<View> views(const Volume& volume, bool crowded, bool allOrders) {
    Camera orthographic, inside;
    orthographic.orthographic = true;
    inside.position = glm::dvec3(volume.indexToWorld * glm::dvec4(glm::dvec3(volume.dimensions) * glm::dvec3(0.5, 0.6, 0.9), 1.0));
    inside.lookAt = glm::dvec3(volume.indexToWorld * glm::dvec4(glm::dvec3(volume.dimensions) * glm::dvec3(0.4, 0.5, 0.3), 1.0));
    inside.verticalFov = 70.0;
    const Lighting sun{.lights = {{.place = {1.0, 0.7, 0.2}}}, .ambient = glm::dvec3(0.2), .surface = 0.5, .scattering = allOrders ? kAllOrders : 1};
    Lighting many = sun;
    many.surface = 0.0;
    for (int i = 0; i < (crowded ? 4 : 1); ++i) many.lights.push_back({.place = {0.3 * i, 1.0, -0.5}, .atInfinity = i % 2 == 0});
    FrameSettings plain = gathering({136, 124}), levels = plain, lit = plain, surrounded = plain;
    plain.depth = true;
    levels.lod = 2.0f;
    lit.lighting = sun;
    lit.depth = true;
    surrounded.lighting = many;
    return {{framingCamera(volume, 35.0, 25.0, 1.1, {}), plain},
            {framingCamera(volume, 120.0, 50.0, 1.1, orthographic), levels},
            {framingCamera(volume, 250.0, 10.0, 1.1, {}), lit},
            {inside, surrounded}};
  }
  static void expectSame(const Image& image, const Image& expected) {
    EXPECT_TRUE(image.pixels == expected.pixels);
    EXPECT_TRUE(image.depth == expected.depth);
  }
};

TEST_F(GatherRepeatTest, FramesAndSharesHaveTheSameBitsEveryTimeAndWithAnyNumberOfThreads) {
  Threads one("1"), two("2");
  std::size_t scene = 0;
  for (const Scene& each : scenes()) {
    Renderer first(*one.device, each.volume, each.classification, {}), second(*two.device, each.volume, each.classification, {});
    const std::vector<View> seen = views(each.volume, scene == 1, scene % 9 == 1);
    for (std::size_t view = scene % 2; view < seen.size(); view += 2) {  // half of them, in turn
      const auto& [camera, settings] = seen[view];
      SCOPED_TRACE(testing::Message() << "scene " << scene << ", view " << view);
      const Image image = first.render(camera, settings);
      EXPECT_GT(std::ranges::count_if(image.pixels, [](const glm::vec4& pixel) { return pixel.a > 0.01f; }), 500);
      expectSame(first.render(camera, settings), image);
      expectSame(second.render(camera, settings), image);
      if (view != scene % 4) continue;  // shares take longer
      const FixedSums whole = second.renderShares(camera, settings, {});
      const int count = 2 + int(scene / 4 % 2);  // each view with both
      FixedSums sums = first.renderShares(camera, settings, {0, count});
      for (int index = 1; index < count; ++index) sums += second.renderShares(camera, settings, {index, count});
      EXPECT_EQ(sums.values, whole.values) << count << " shares";
    }
    ++scene;
  }
  EXPECT_EQ(one.instance->validationMessageCount() + two.instance->validationMessageCount(), 0u);
}

}  // namespace
}  // namespace freevoxels
