// A layer for each source of light: what it shows, and that all of them add up to the image.

#include "engine/light_layers.h"

#include <cmath>

#include "engine/image/metrics.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/refusal.h"

namespace freevoxels {
namespace {

class LightLayersTest : public DeviceTest {
 protected:
  const Volume fire_ = makeProcedural("fire", glm::ivec3(17, 24, 19));
  const Camera camera_ = framingCamera(fire_, 30.0, 20.0, 1.2, {});
  const Classification smoke_{.densityScale = 12.0, .albedo = glm::vec3(0.7f, 0.8f, 0.9f), .emission = Emission{.strength = 4.0}};
  const Lighting lighting_{.lights = {{.place = {1.0, 0.5, 0.2}, .color = {1.0, 0.5, 0.2}, .intensity = 2.0}, {.place = {-1.0, 0.3, 0.7}}},
                           .ambient = glm::dvec3(0.1, 0.2, 0.3)};

  static Image layerOf(const Image& image, const std::string& name) {
    Image layer{.size = image.size, .pixels = image.pixels};
    for (std::size_t i = 0; i < layer.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) layer.pixels[i][c] = image.channels.at(name + "." + "RGB"[c])[i];
    return layer;
  }
};

TEST_F(LightLayersTest, AddUpToTheImageAndAreThoseOfEachLightAlone) {
  Renderer renderer(device(), fire_, smoke_, {});
  const FrameSettings settings{.size = {48, 40}, .depth = true, .lighting = lighting_};
  const Image whole = renderer.render(camera_, settings), image = renderLightLayers(renderer, camera_, settings, true, {});
  ASSERT_EQ(image.channels.size(), 3u * 4u);
  EXPECT_EQ(image.depth, whole.depth);
  Image sum{.size = image.size, .pixels = std::vector<glm::vec4>(image.pixels.size(), glm::vec4(0.0f))};
  for (const char* name : {"emission", "light1", "light2", "ambient"}) {
    const Image layer = layerOf(image, name);
    double most = 0.0;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
      sum.pixels[i] += layer.pixels[i];
      most = std::max(most, double(layer.pixels[i].g));
    }
    EXPECT_GT(most, 0.01) << name;
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
    EXPECT_EQ(image.pixels[i].a, whole.pixels[i].a);
    for (int c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(double(sum.pixels[i][c] - image.pixels[i][c])) / std::max(1e-3, double(image.pixels[i][c])));
  }
  EXPECT_LT(largest, 1e-5) << "the sum of the layers is the image";
  EXPECT_GT(compareImages(image, whole).psnr, 60.0) << "which is that of all lights at once";

  // Twice the first light is an image with that light twice as bright.
  FrameSettings brighter = settings;
  brighter.lighting->lights[0].intensity *= 2.0;
  const Image drawn = renderer.render(camera_, brighter);
  const Image first = layerOf(image, "light1");
  Image mixed = image;
  for (std::size_t i = 0; i < mixed.pixels.size(); ++i) mixed.pixels[i] += glm::vec4(glm::vec3(first.pixels[i]), 0.0f);
  EXPECT_GT(compareImages(mixed, drawn).psnr, 60.0);
}

TEST_F(LightLayersTest, WithoutLightAreRefused) {
  Renderer renderer(device(), fire_, smoke_, {});
  test::expectRefusal([&] { renderLightLayers(renderer, camera_, {.size = {8, 8}}, true, {}); }, ErrorKind::Usage, {"lights", "light"});
}

}  // namespace
}  // namespace freevoxels
