#pragma once
// Makes the images of the viewer's options, as `freevoxels render` does.

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

/// The input of an image, to be copied to another thread.
struct PictureRequest {
  SceneOptions scene;
  MethodOptions method;
  Diagnosis diagnosis;
  std::optional<MethodOptions> compared;  ///< another method for comparison
  std::uint64_t number = 0;               ///< larger than that of all earlier requests
  /// Largest number of voxels along the volume's longest edge. Of larger volumes, means of blocks are drawn.
  int voxelsAlongEdge = std::numeric_limits<int>::max();
};

struct Picture {
  PictureRequest request;    ///< the request that it answers
  Scene scene;               ///< the resolved scene, with the whole volume
  OptionList options;        ///< options that make the same pixels
  DeviceDescription device;  ///< device that made it
  std::shared_ptr<const SplatTargets> image;     ///< on the device, which must outlive the picture
  std::shared_ptr<const RenderTarget> shown;     ///< the same image, or the diagnosis in its place
  std::shared_ptr<const RenderTarget> compared;  ///< of the other method, or null
  std::vector<StageTime> times;
  double milliseconds = 0.0;  ///< in total, without reading files
  VolumeMemory memory;
  CutCounts cut;
  std::optional<std::uint64_t> visibleVoxels;  ///< Renderer::occupiedVoxelCount
};

/// Keeps a volume on a device, and updates only what a request changes.
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
  std::shared_ptr<const Volume> whole_, coarse_;  ///< coarse_ is made from whole_, or equal to it
  int blockEdge_ = 0;                             ///< block edge of coarse_
  bool coarseIsOfDensities_ = false;
  std::string rendererOptions_;
  std::unique_ptr<Renderer> renderer_;
  Diagnoser diagnoser_;
};

}  // namespace freevoxels
