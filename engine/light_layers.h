#pragma once
// Images in which each source of light has a layer of its own, so that lights are balanced afterwards without drawing again: light adds up.

#include <string>

#include "engine/core/stages.h"
#include "engine/image/image.h"
#include "engine/renderer.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

inline constexpr const char* kAmbientLayer = "ambient";
inline constexpr const char* kEnvironmentLayer = "environment";
inline constexpr const char* kEmissionLayer = "emission";
/// The name of the layer of a light, by its number from 0 on.
std::string lightLayerName(std::size_t light);

/// Adds the colours of an image of the same size as the channels NAME.R, NAME.G and NAME.B of `image`.
void addLayer(Image& image, const std::string& name, const Image& layer);

/// Draws a frame once for each source of its light, and adds the channels light1.R, light1.G, light1.B, light2.R, ..., ambient.R, ...,
/// environment.R, ... and emission.R, ... of those that there are, over black. The image's colours are their sum. Emission has a layer
/// where `mayEmit`. Fails with ErrorKind::Usage without light, and as Renderer::render() does.
Image renderLightLayers(Renderer& renderer, const Camera& camera, const FrameSettings& settings, bool mayEmit, const Progress& progress);

}  // namespace freevoxels
