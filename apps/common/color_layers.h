#pragma once
// Images in which colours of lights or channels change without drawing again: an image is a sum of products of these colours, and of the
// images with one of them white and all others black.

#include <optional>

#include "engine/core/stages.h"
#include "engine/description/scene_description.h"
#include "engine/image/image.h"
#include "engine/renderer.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// The colours of the lights with their intensities, and the ambient light; or those of the channels.
enum class Colors { Lights, Channels };

/// Whether two scenes are equal but for these colours, and for how their images are shown.
bool equalButColors(const SceneDescription& a, const SceneDescription& b, Colors colors);

class ColorLayers {
 public:
  /// Draws the images of a scene, with white light, or white channels. `description` is that of `scene`, which `renderer` draws. Nothing
  /// where the scene's image is no sum over them: without light, or for channels between which light is scattered.
  static std::optional<ColorLayers> make(Renderer& renderer, const Device& device, const SceneDescription& description, const Scene& scene,
                                         const FrameSettings& settings, Colors colors, const Progress& progress);

  Colors colors() const { return colors_; }
  /// Whether the layers are those of this scene.
  bool fit(const SceneDescription& scene) const { return equalButColors(scene_, scene, colors_); }
  /// The image of a scene that they fit. `volume` is the scene's.
  Image mixed(const SceneDescription& scene, const Volume& volume) const;

 private:
  ColorLayers(const SceneDescription& scene, Colors colors, Image layers) : scene_(scene), colors_(colors), layers_(std::move(layers)) {}

  SceneDescription scene_;
  Colors colors_;
  Image layers_;  ///< with the channels NAME.R, NAME.G and NAME.B of each layer
};

}  // namespace freevoxels
