#include "apps/common/color_layers.h"

#include <tbb/parallel_for.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/frame_layers.h"
#include "engine/light_layers.h"

namespace freevoxels {

namespace {

/// The scene with all colours white, and as it is shown by default.
SceneDescription whitened(SceneDescription scene, Colors colors) {
  scene.output = {};
  if (colors == Colors::Channels) {
    for (ChannelStyle& channel : scene.classification.channels) channel.color = glm::vec3(1.0f);
    return scene;
  }
  for (LightingDescription::GivenLight& given : scene.lighting.lights) {
    given.hasIntensity = true;
    given.light.color = glm::dvec3(1.0);
    given.light.intensity = 1.0;
  }
  if (scene.lighting.ambient) scene.lighting.ambient = glm::dvec3(1.0);
  return scene;
}

bool areSumOf(const SceneDescription& scene, Colors colors) {
  if (colors == Colors::Channels) return !scene.classification.channels.empty() && scene.added.empty() && channelsAddUp(scene);
  return !scene.lighting.unlit && scene.lighting.hasLight();
}

/// The colour of each layer by its name. Layers without one stay as they are.
std::vector<std::pair<std::string, glm::vec3>> factorsOf(const SceneDescription& scene, const Volume& volume, Colors colors) {
  std::vector<std::pair<std::string, glm::vec3>> factors;
  if (colors == Colors::Channels) {
    const std::vector<ChannelStyle>& channels = scene.classification.channels;
    for (std::size_t i = 0; i < channels.size(); ++i) factors.emplace_back(channelLayerName(channels[i]), channelColor(channels[i], i));
    return factors;
  }
  const std::vector<LightingDescription::GivenLight>& lights = scene.lighting.lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i].light;
    const double intensity = lights[i].hasIntensity ? light.intensity : defaultIntensity(light, volume);
    factors.emplace_back(lightLayerName(i), glm::vec3(intensity * light.color));
  }
  factors.emplace_back(kAmbientLayer, glm::vec3(scene.lighting.ambient.value_or(glm::dvec3(0.0))));
  for (const char* const constant : {kEnvironmentLayer, kEmissionLayer}) factors.emplace_back(constant, glm::vec3(1.0f));
  return factors;
}

}  // namespace

bool equalButColors(const SceneDescription& a, const SceneDescription& b, Colors colors) {
  return whitened(a, colors) == whitened(b, colors);
}

std::optional<ColorLayers> ColorLayers::make(Renderer& renderer, const Device& device, const SceneDescription& description,
                                             const Scene& scene, const FrameSettings& settings, Colors colors, const Progress& progress) {
  if (!areSumOf(description, colors)) return std::nullopt;
  if (colors == Colors::Channels) {
    Image image = renderer.render(scene.camera, settings, progress);
    addChannelLayers(image, device, whitened(description, colors).classification.channels, description, scene, settings, progress);
    return ColorLayers(description, colors, std::move(image));
  }
  FrameSettings white = settings;
  for (Light& light : white.lighting->lights) {
    light.color = glm::dvec3(1.0);
    light.intensity = 1.0;
  }
  if (white.lighting->ambient != glm::dvec3(0.0)) white.lighting->ambient = glm::dvec3(1.0);
  return ColorLayers(description, colors, renderLightLayers(renderer, scene.camera, white, mayEmit(scene), progress));
}

Image ColorLayers::mixed(const SceneDescription& scene, const Volume& volume) const {
  struct Term {
    std::array<const std::vector<float>*, 3> values;
    glm::vec3 factor;
  };
  std::vector<Term> terms;
  for (const auto& [name, factor] : factorsOf(scene, volume, colors_)) {
    const auto planeOf = [&](const char* component) {
      const auto found = layers_.channels.find(name + component);
      return found == layers_.channels.end() ? nullptr : &found->second;
    };
    if (planeOf(".R") != nullptr) terms.push_back({{planeOf(".R"), planeOf(".G"), planeOf(".B")}, factor});
  }
  Image image{.size = layers_.size, .pixels = layers_.pixels};
  tbb::parallel_for(std::size_t(0), image.pixels.size(), [&](std::size_t pixel) {
    glm::vec3 sum(0.0f);
    for (const Term& term : terms)
      for (int c = 0; c < 3; ++c) sum[c] += term.factor[c] * (*term.values[std::size_t(c)])[pixel];
    image.pixels[pixel] = glm::vec4(sum, image.pixels[pixel].a);
  });
  return image;
}

}  // namespace freevoxels
