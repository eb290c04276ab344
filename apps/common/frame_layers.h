#pragma once
// Frames with layers for lights and channels (Aovs::lights, Aovs::channels).

#include <string>
#include <vector>

#include "engine/core/stages.h"
#include "engine/description/scene_description.h"
#include "engine/image/image.h"
#include "engine/renderer.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Draws a frame of a scene with the layers that `aovs` names, but without its other channels (addChannels). `description` is that of
/// `scene`. Channels are read again, once for each of them, so that they are those of a file. Fails with ErrorKind::Usage where there is
/// nothing to make layers of, and where light is scattered more than once, which is no sum over channels.
Image renderFrame(Renderer& renderer, const Device& device, const SceneDescription& description, const Scene& scene,
                  const FrameSettings& settings, const Aovs& aovs, const Progress& progress);

/// Whether a volume of a scene sends out light.
bool mayEmit(const Scene& scene);
/// The name of a channel's layer: "dapi", or "channel0" where the name is no word that a layer may have.
std::string channelLayerName(const ChannelStyle& channel);
/// Adds a layer for each of the scene's channels, with the colour that it has in `channels` and all others black, and returns their sum.
std::vector<glm::vec3> addChannelLayers(Image& image, const Device& device, const std::vector<ChannelStyle>& channels,
                                        const SceneDescription& description, const Scene& scene, const FrameSettings& settings,
                                        const Progress& progress);

/// The slice that the camera of a scene sees (sliceCameraOf). `volume` has the values of that of the scene.
Image renderSlice(const Volume& volume, const Scene& scene, glm::ivec2 size);

}  // namespace freevoxels
