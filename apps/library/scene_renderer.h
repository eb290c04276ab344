#pragma once
// Renders one volume by scenes that are JSON: what the C++ library and the Python module have in common.

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/library/device_context.h"
#include "apps/library/keyword_options.h"
#include "engine/renderer.h"

namespace freevoxels {

/// Reads a file or makes "procedural:NAME". `keywords` are the grid, the resolution and the scene of frames to come, which
/// decides what grids are needed beside it. Fails as readVdb does.
std::shared_ptr<const Volume> openVolume(const std::string& file, const nlohmann::json& keywords);

/// Writes an image as `freevoxels render` does; `keywords` are options of the section output.
void saveImage(const std::string& file, const Image& image, const nlohmann::json& keywords);

class SceneRenderer {
 public:
  /// `keywords` (KeywordOptions) hold for every frame. Opens the device; the table is made for the first frame.
  SceneRenderer(std::shared_ptr<const Volume> volume, nlohmann::json keywords);

  /// Draws the frame of the renderer's keywords with `more` in their places. What frames have in common is made again only
  /// where their keywords differ in it. Any thread may call it; frames are drawn one after another.
  Image render(const nlohmann::json& more, bool depth, const Progress& progress);

  /// Stages of what the last frame is drawn from, and of that frame.
  std::vector<StageTime> timings() const;
  std::string device() const { return context_.device->description().name; }

 private:
  std::unique_ptr<KeywordOptions> read(const nlohmann::json& more) const;
  void makeRenderer(const KeywordOptions& options, const Progress& progress);

  const std::shared_ptr<const Volume> volume_;
  const nlohmann::json keywords_;
  DeviceContext& context_;
  Scene scene_;                 ///< of the last frame
  std::string classification_;  ///< KeywordOptions::classificationText of scene_.classification
  std::string rendererText_;    ///< SceneOptions::rendererText of what renderer_ was made for
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace freevoxels
