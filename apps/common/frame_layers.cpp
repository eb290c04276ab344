#include "apps/common/frame_layers.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/light_layers.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

bool mayEmit(const Scene& scene) {
  const auto emits = [](const SceneVolume& volume) { return volume.classification.emission.has_value(); };
  return scene.classification.emission || std::ranges::any_of(scene.added, emits);
}

std::string channelLayerName(const ChannelStyle& channel) {
  std::string name = channel.name;
  for (char& character : name)
    if (std::isalnum(static_cast<unsigned char>(character)) == 0) character = '_';
  return std::isdigit(static_cast<unsigned char>(name.front())) != 0 ? "channel" + name : name;
}

std::vector<glm::vec3> addChannelLayers(Image& image, const Device& device, const std::vector<ChannelStyle>& channels,
                                        const SceneDescription& description, const Scene& scene, const FrameSettings& settings,
                                        const Progress& progress) {
  std::vector<glm::vec3> sum(image.pixels.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i < channels.size(); ++i) {
    SceneDescription alone = description;
    alone.classification.channels = channels;
    for (std::size_t other = 0; other < channels.size(); ++other)
      alone.classification.channels[other].color = other == i ? channelColor(channels[i], i) : glm::vec3(0.0f);
    const Volume volume = alone.readVolume(kMaxNumberedVoxels);
    Renderer renderer(device, volume, scene.classification, description.method.table());
    const Image layer = renderer.render(scene.camera, settings, progress);
    addLayer(image, channelLayerName(channels[i]), layer);
    for (std::size_t pixel = 0; pixel < sum.size(); ++pixel) sum[pixel] += glm::vec3(layer.pixels[pixel]);
  }
  return sum;
}

Image renderFrame(Renderer& renderer, const Device& device, const SceneDescription& description, const Scene& scene,
                  const FrameSettings& settings, const Aovs& aovs, const Progress& progress) {
  checkLayers(description, aovs);
  if (aovs.channels && description.input.volume.empty())
    fail(ErrorKind::Usage, "{} reads the channels again, and an array has been read: draw it with one colour after the other",
         Parameter("aov", "channels"));
  Image image = aovs.lights ? renderLightLayers(renderer, scene.camera, settings, mayEmit(scene), progress)
                            : renderer.render(scene.camera, settings, progress);
  if (!aovs.channels) return image;
  const std::vector<glm::vec3> sum = addChannelLayers(image, device, description.shownChannels(), description, scene, settings, progress);
  if (aovs.lights) return image;
  for (std::size_t pixel = 0; pixel < sum.size(); ++pixel) image.pixels[pixel] = glm::vec4(sum[pixel], image.pixels[pixel].a);
  return image;
}

Image renderSlice(const Volume& volume, const Scene& scene, glm::ivec2 size) {
  return drawSlice(volume, scene.classification, slicePixels(volume, scene.camera, size), size);
}

}  // namespace freevoxels
