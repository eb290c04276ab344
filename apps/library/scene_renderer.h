#pragma once
// Renders one volume by scenes in JSON: the common base of the C++ library and the Python module.

#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/library/device_context.h"
#include "apps/library/keyword_options.h"
#include "apps/library/shared_volume.h"
#include "engine/renderer.h"

namespace freevoxels {

/// Reads a file or makes "procedural:NAME", at most as large as the device of `context` can hold; if it is null, that of the
/// keywords. `keywords` are the grid, the resolution and the scene of later frames, which decides what other grids are needed.
/// Without a file it is the volume of the scene.
/// Fails as readVdb does, and for a baked file as FvxFile does.
std::shared_ptr<const SharedVolume> openVolume(const std::string& file, const nlohmann::json& keywords,
                                               const std::shared_ptr<DeviceContext>& context = nullptr);

/// Writes an image as `freevoxels render` does. `keywords` are options of the section "output".
void saveImage(const std::string& file, const Image& image, const nlohmann::json& keywords);

/// A scene file as keywords, with absolute names of files. Fails with ErrorKind::Input.
nlohmann::json loadScene(const std::filesystem::path& file);
/// Writes keywords as a scene file, with names of files relative to its folder.
void saveScene(const std::filesystem::path& file, const nlohmann::json& keywords);

/// Any thread may call the member functions; the frames of one device are drawn one after another. A progress function may call them
/// too, except that it cannot draw with the renderer that calls it: ErrorKind::Usage.
class SceneRenderer {
 public:
  /// `keywords` (KeywordOptions) hold for every frame. The table is made for the first frame that needs it. If `context` is
  /// null, the keywords choose the device, which is opened here.
  SceneRenderer(std::shared_ptr<const SharedVolume> volume, nlohmann::json keywords, std::shared_ptr<DeviceContext> context = nullptr);

  /// Reads the options of a frame: the renderer's keywords, overridden by `more`.
  std::unique_ptr<const KeywordOptions> read(const nlohmann::json& more) const;

  /// Draws a frame. What frames share is made again only if the options change it.
  Image render(const KeywordOptions& options, bool depth, const Progress& progress);
  /// The same frame, which stays on the device, complete.
  std::shared_ptr<const FrameTargets> renderOnDevice(const KeywordOptions& options, bool depth, const Progress& progress);

  /// Stage times of the last complete frame and of the data from which it was drawn. Does not wait for a frame that is being drawn.
  std::vector<StageTime> timings() const;
  const std::shared_ptr<DeviceContext>& context() const { return context_; }

 private:
  class Turn;
  FrameSettings prepare(const KeywordOptions& options, bool depth, const Progress& progress);
  void makeRenderer(const KeywordOptions& options, const Progress& progress);
  void complete();

  const std::shared_ptr<const SharedVolume> volume_;
  const nlohmann::json keywords_;
  const bool choosesDevice_;  ///< whether the keywords choose the device
  const std::shared_ptr<DeviceContext> context_;

  // While context_->turns is held:
  bool isDrawing_ = false;
  int level_ = 0;               ///< of scene_.volume, if that is not null
  Scene scene_;                 ///< scene of the last frame
  std::string classification_;  ///< the fields of which scene_.classification was made
  std::string rendererText_;    ///< rendererText for which renderer_ was made
  std::unique_ptr<Renderer> renderer_;

  mutable std::mutex timingsMutex_;  ///< guards timings_
  std::vector<StageTime> timings_;
};

}  // namespace freevoxels
