#include "engine/light_layers.h"

#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// A layer with the only light that it has.
struct Layer {
  std::string name;
  Lighting lighting;
};

/// All layers, that of emission first, as the others contain it, too.
std::vector<Layer> layersOf(const Lighting& all, bool mayEmit) {
  Lighting dark = all;
  dark.lights.clear();
  dark.ambient = glm::dvec3(0.0);
  dark.environment = nullptr;
  std::vector<Layer> layers;
  if (mayEmit) layers.push_back({kEmissionLayer, dark});
  for (std::size_t i = 0; i < all.lights.size(); ++i) {
    layers.push_back({lightLayerName(i), dark});
    layers.back().lighting.lights = {all.lights[i]};
  }
  if (all.ambient != glm::dvec3(0.0)) {
    layers.push_back({kAmbientLayer, dark});
    layers.back().lighting.ambient = all.ambient;
  }
  if (all.environment) {
    layers.push_back({kEnvironmentLayer, dark});
    layers.back().lighting.environment = all.environment;
  }
  return layers;
}

Progress partOf(const Progress& progress, std::size_t part, std::size_t parts) {
  if (!progress) return {};
  return [=](std::string_view stage, double fraction) { progress(stage, (double(part) + fraction) / double(parts)); };
}

}  // namespace

std::string lightLayerName(std::size_t light) {
  return fmt::format("light{}", light + 1);
}

void addLayer(Image& image, const std::string& name, const Image& layer) {
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& values = image.channels[fmt::format("{}.{}", name, "RGB"[c])];
    values.clear();
    for (const glm::vec4& pixel : layer.pixels) values.push_back(pixel[c]);
  }
}

Image renderLightLayers(Renderer& renderer, const Camera& camera, const FrameSettings& settings, bool mayEmit, const Progress& progress) {
  const std::vector<Layer> layers = settings.lighting ? layersOf(*settings.lighting, mayEmit) : std::vector<Layer>();
  if (layers.empty())
    fail(ErrorKind::Usage, "{} are layers of light, and there is none: give a {}, or leave {} out", Parameter("aov", "lights"),
         Parameter("light"), Parameter("unlit"));
  Image image;
  std::vector<glm::vec4> emission;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    FrameSettings own = settings;
    own.lighting = layers[i].lighting;
    Image layer = renderer.render(camera, own, partOf(progress, i, layers.size()));
    if (!emission.empty())
      for (std::size_t pixel = 0; pixel < emission.size(); ++pixel)
        for (int c = 0; c < 3; ++c) layer.pixels[pixel][c] -= emission[pixel][c];
    addLayer(image, layers[i].name, layer);
    if (layers[i].name == kEmissionLayer) emission = layer.pixels;
    if (i == 0) {
      std::swap(layer.channels, image.channels);
      image = std::move(layer);
    } else {
      for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel)
        for (int c = 0; c < 3; ++c) image.pixels[pixel][c] += layer.pixels[pixel][c];
    }
  }
  return image;
}

}  // namespace freevoxels
