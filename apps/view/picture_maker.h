#pragma once
// Pictures of what the viewer's options say, as `freevoxels render` makes them.

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "apps/freevoxels/method_options.h"
#include "apps/freevoxels/scene_options.h"
#include "apps/view/diagnosis.h"
#include "apps/view/volume_cache.h"
#include "engine/renderer.h"

namespace freevoxels {

/// What a picture is made from, to be copied to another thread.
struct PictureRequest {
  SceneOptions scene;
  MethodOptions method;
  Diagnosis diagnosis;
  std::optional<MethodOptions> compared;  ///< another method, to look at beside it
  std::uint64_t number = 0;               ///< larger than that of any before
  /// Of more voxels along the volume's longest edge, means of blocks of them are drawn.
  int voxelsAlongEdge = std::numeric_limits<int>::max();
};

struct Picture {
  PictureRequest request;    ///< that it answers
  Scene scene;               ///< as resolved; its volume is the whole one
  OptionList options;        ///< that make the same pixels
  DeviceDescription device;  ///< that made it
  std::shared_ptr<const SplatTargets> image;     ///< on the device, which must outlive the picture
  std::shared_ptr<const RenderTarget> shown;     ///< the same image, or the diagnosis in its place
  std::shared_ptr<const RenderTarget> compared;  ///< of the other method, or null
  std::vector<StageTime> times;
  double milliseconds = 0.0;  ///< in all, but for reading files
  VolumeMemory memory;
  CutCounts cut;
  std::optional<std::uint64_t> visibleVoxels;  ///< Renderer::occupiedVoxelCount
};

/// Keeps a volume on a device, and makes again only what a request changes.
class PictureMaker {
 public:
  PictureMaker(const Device& device, VolumeCache& volumes);

  /// Fails as `freevoxels render` does.
  Picture make(const PictureRequest& request, const Progress& progress);

 private:
  void makeRenderer(const Scene& scene, const PictureRequest& request, const Progress& progress);
  std::shared_ptr<const Volume> coarse(const Scene& scene, int voxelsAlongEdge);

  const Device& device_;
  VolumeCache& volumes_;
  std::shared_ptr<const Volume> whole_, coarse_;  ///< coarse_ is of whole_, or the same
  int blockEdge_ = 0;                             ///< that it is of
  bool coarseIsOfDensities_ = false;
  std::string rendererOptions_;
  std::unique_ptr<Renderer> renderer_;
  Diagnoser diagnoser_;
};

}  // namespace freevoxels
