#pragma once
// Renders one volume by scenes in JSON: the common base of the C++ library and the Python module.

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/library/device_context.h"
#include "apps/library/keyword_options.h"
#include "engine/renderer.h"

namespace freevoxels {

/// Reads a file or makes "procedural:NAME". `keywords` are the grid, the resolution and the scene of later
/// frames, which decides what other grids are needed. Fails as readVdb does.
std::shared_ptr<const Volume> openVolume(const std::string& file, const nlohmann::json& keywords);

/// Writes an image as `freevoxels render` does. `keywords` are options of the section "output".
void saveImage(const std::string& file, const Image& image, const nlohmann::json& keywords);

class SceneRenderer {
 public:
  /// Opens the device. `keywords` (KeywordOptions) hold for every frame. The table is made for the first
  /// frame that needs it.
  SceneRenderer(std::shared_ptr<const Volume> volume, nlohmann::json keywords);

  /// Draws a frame of the renderer's keywords, overridden by `more`. What frames share is made again only if
  /// the keywords change it. Any thread may call this; frames are drawn one after another.
  Image render(const nlohmann::json& more, bool depth, const Progress& progress);

  /// Stage times of the last frame and of the data from which it was drawn.
  std::vector<StageTime> timings() const;
  std::string device() const { return context_.device->description().name; }

 private:
  std::unique_ptr<KeywordOptions> read(const nlohmann::json& more) const;
  void makeRenderer(const KeywordOptions& options, const Progress& progress);

  const std::shared_ptr<const Volume> volume_;
  const nlohmann::json keywords_;
  DeviceContext& context_;
  Scene scene_;                 ///< scene of the last frame
  std::string classification_;  ///< KeywordOptions::classificationText of scene_.classification
  std::string rendererText_;    ///< SceneOptions::rendererText for which renderer_ was made
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace freevoxels
