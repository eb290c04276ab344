#pragma once
// A renderer that is kept from frame to frame, as long as frames can share it: of the viewer, the C++ library and Python.

#include <memory>
#include <string>
#include <utility>

#include "engine/description/scene_description.h"
#include "engine/renderer.h"

namespace freevoxels {

/// Without lighting.
FrameSettings frameSettings(const SceneDescription& description, bool depth);

class KeptRenderer {
 public:
  /// The device outlives this object.
  explicit KeptRenderer(const Device& device) : device_(device) {}

  /// Whether the renderer that is there draws frames of this scene. `source`: the scene's volume, or a coarser one.
  bool isFor(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description, const Scene& scene) const;
  /// The renderer for such frames. Where isFor() is false, the one that is there is reclassified if that is possible, or another is made.
  Renderer& get(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description, const Scene& scene,
                const Progress& progress);
  /// Gives the renderer and its volume up, so that there are never two of them.
  void release() {
    renderer_ = nullptr;
    source_ = nullptr;
  }
  /// Leaves what is on the device as it is, in a forked process, which cannot free it.
  void abandon() { (void)renderer_.release(); }
  /// The times of the last frame: with those of what the renderer was made of, for its first frame; none without one.
  std::vector<StageTime> takeTimings();

 private:
  bool mayReclassify(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description, const Scene& scene) const;

  const Device& device_;
  std::shared_ptr<const VolumeSource> source_;
  std::string text_;  ///< rendererText for which the renderer was made
  Classification classification_;  ///< of the renderer
  std::unique_ptr<Renderer> renderer_;
  bool isNew_ = false;  ///< whether it has drawn no complete frame
};

}  // namespace freevoxels
