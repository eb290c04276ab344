#pragma once
// Pictures of what the viewer's options say, as `freevoxels render` makes them.

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
};

struct Picture {
  PictureRequest request;    ///< that it answers
  Scene scene;               ///< as resolved; its volume is the whole one
  OptionList options;        ///< that make the same pixels
  DeviceDescription device;  ///< that made it
  Image image;
  std::optional<Image> diagnosis;  ///< what is shown in its place
  std::optional<Image> compared;
  std::vector<StageTime> times;
  double milliseconds = 0.0;  ///< in all
  VolumeMemory memory;
  CutCounts cut;
  std::uint64_t visibleVoxels = 0;
};

/// Different for tables that are made differently.
std::string tableText(const TableSettings& table);

/// Keeps a volume on a device, and makes again only what a request changes.
class PictureMaker {
 public:
  /// A picture is of at most so many voxels along the longest edge of the volume: means of blocks of them.
  PictureMaker(const Device& device, VolumeCache& volumes, int mostVoxelsAlongEdge);

  /// Fails as `freevoxels render` does.
  Picture make(const PictureRequest& request, const Progress& progress);

 private:
  void makeRenderer(const Scene& scene, const MethodOptions& method, const std::string& options,
                    const Progress& progress);
  std::shared_ptr<const Volume> coarse(const Scene& scene);

  const Device& device_;
  VolumeCache& volumes_;
  const int mostVoxelsAlongEdge_;
  std::shared_ptr<const Volume> whole_, coarse_;  ///< coarse_ is of whole_, or the same
  bool coarseIsOfDensities_ = false;
  std::string rendererOptions_;
  std::unique_ptr<Renderer> renderer_;
  Diagnoser diagnoser_;
};

}  // namespace freevoxels
