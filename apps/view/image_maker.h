#pragma once
// Makes the images of the viewer's options, as `freevoxels render` does, of a volume that is read once.

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/color_layers.h"
#include "apps/common/film_view.h"
#include "apps/common/kept_renderer.h"
#include "apps/view/diagnosis.h"
#include "apps/view/image_pace.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

class VolumeCache {
 public:
  explicit VolumeCache(std::uint64_t maximumVoxels) : maximumVoxels_(maximumVoxels) {}

  /// The volume that the options name was read already, and clipped.
  VolumeCache(const SceneDescription& scene, std::shared_ptr<const Volume> volume);

  /// The volume that the options name, read and clipped unless it is the last one; whoever comes meanwhile waits for it. A frame of a
  /// sequence may lack grids, and is a voxel without data if it holds nothing. `number` is that of the request (ImageRequest), by which it
  /// is given up: ErrorKind::Input. Without `clips` Read::volume is the whole one.
  struct Read {
    std::shared_ptr<const Volume> volume;
    std::shared_ptr<const Volume> whole;  ///< before it was clipped; null where it was not read here
  };
  Read read(const SceneDescription& scene, std::uint64_t number, bool isFrame = false, bool clips = true);
  /// Gives up what is being read, and what is to be read, for requests up to this number.
  void giveUp(std::uint64_t number) { mayBeRead_ = number + 1; }
  /// The fraction of the file that has been read; nothing while none is.
  std::optional<double> reading() const;
  /// How the files of a sequence are seen as a whole (film_view.h); null if none can be drawn. Chosen once.
  std::shared_ptr<const FilmView> viewOf(const SceneDescription& scene, const std::vector<std::string>& files);

 private:
  std::shared_ptr<const Volume> readWhole(const SceneDescription& scene, std::uint64_t number, bool isFrame);
  void keepFrame(const std::string& name, const std::shared_ptr<const Volume>& volume);

  const std::uint64_t maximumVoxels_;
  std::atomic<std::uint64_t> mayBeRead_ = 0;  ///< the first request that is not given up
  static constexpr double kNotReading = -1.0;
  std::atomic<double> read_ = kNotReading;
  mutable std::mutex mutex_;
  /// Frames of a sequence that were read before, the last one at the end, for when it is played again.
  std::deque<std::pair<std::string, std::shared_ptr<const Volume>>> frames_;
  std::string name_, clippedName_;
  std::shared_ptr<const Volume> whole_, clipped_;
  std::string filmName_;
  std::shared_ptr<const FilmView> film_;
};

/// What an image is drawn for: while the camera moves; while nothing but the transfer function changes besides, with the light that there
/// was before; while nothing but clip box and plane change besides, of the whole volume with clipped rays; while something else changes; as
/// a step from there to the whole image; or as that, of all voxels and pixels.
enum class Purpose { Move, Classify, Clip, Edit, Refine, Whole };

/// The input of an image, to be copied to another thread.
struct ImageRequest {
  SceneDescription scene;
  Diagnosis diagnosis;
  std::optional<MethodDescription> compared;  ///< another method for comparison
  bool isFrame = false;                       ///< whether the volume is a frame of a sequence
  /// The files of the sequence, if what the scene leaves open is to be chosen for all of them: for the first image.
  std::vector<std::string> film;
  std::uint64_t number = 0;               ///< larger than that of all earlier requests
  std::uint64_t revision = 0;             ///< the same for requests that differ in camera and size alone
  Purpose purpose = Purpose::Whole;
  /// Largest number of voxels along the volume's longest edge. Of larger volumes, means of blocks are drawn.
  int voxelsAlongEdge = kAllVoxels;
  /// If given, not an image is wanted but its layers.
  std::optional<Colors> layers = {};
  /// FrameSettings::quality of an image of as many pixels as the whole one. Below kSmallerBelow the image itself is smaller, as it costs
  /// time to interpolate pixels that nobody can tell apart.
  double quality = 1.0;

  static constexpr double kSmallerBelow = 0.5;
  /// Edges of the image over those of the whole image.
  double scale() const { return std::min(quality / kSmallerBelow, 1.0); }
};

struct DrawnImage {
  ImageRequest request;    ///< the request that it answers
  Scene scene;  ///< the resolved scene, with all voxels of the volume; in drafts of fewer voxels and of clipped rays also those clipped
  std::shared_ptr<const FilmView> film;  ///< of which that scene was chosen; null if it was for the volume alone
  std::shared_ptr<const Volume> whole;   ///< the scene's volume before it was clipped; null where it was not read with its clipping
  DeviceDescription device;  ///< device that made it
  std::shared_ptr<const FrameTargets> image;     ///< on the device, which must outlive the image
  std::shared_ptr<const RenderTarget> shown;     ///< the same image, or the diagnosis in its place
  std::shared_ptr<const RenderTarget> compared;  ///< of the other method, or null
  std::shared_ptr<const ColorLayers> layers;     ///< where the request wants them and there are some, and then no image
  std::vector<StageTime> times;
  double milliseconds = 0.0;  ///< in total, without reading files
  bool isWholeOnDevice = true;  ///< whether it was not drawn cube by cube
  VolumeMemory memory;
  CutCounts cut;
  std::vector<ChannelStyle> channels;          ///< that are drawn, if any (SceneDescription::shownChannels)
  std::optional<std::uint64_t> visibleVoxels;  ///< Renderer::occupiedVoxelCount
};

/// The same image with other options of how it is shown and written.
DrawnImage withOutput(const DrawnImage& drawn, const OutputDescription& output);

/// Keeps a volume on a device, and updates only what a request changes.
class ImageMaker {
 public:
  ImageMaker(const Device& device, VolumeCache& volumes);

  /// Fails as `freevoxels render` does.
  DrawnImage make(const ImageRequest& request, const Progress& progress);

 private:
  Scene resolve(const ImageRequest& request, std::shared_ptr<const Volume> volume, const FilmView* film);
  std::shared_ptr<const VolumeSource> coarse(const Scene& scene, int voxelsAlongEdge);
  std::shared_ptr<const VolumeSource> clippedCoarse(const InputDescription& input) const;
  std::shared_ptr<const Holdout> holdoutOf(const ImageRequest& request);

  const Device& device_;
  VolumeCache& volumes_;
  std::shared_ptr<const Volume> whole_;
  std::shared_ptr<const VolumeSource> coarse_;  ///< made from whole_, or of it
  int blockEdge_ = 0;                           ///< block edge of coarse_
  bool coarseIsOfDensities_ = false;
  std::string input_;           ///< of the last request
  std::optional<Scene> scene_;  ///< of the last request
  /// Of what scene_ was resolved, without camera and clipping; nothing where it was resolved for a film.
  std::optional<SceneDescription> resolvedOf_;
  std::optional<std::string> heldOutBy_;  ///< CameraDescription::holdout of the last request
  std::shared_ptr<const Holdout> holdout_;
  bool isHoldoutMentioned_ = false;  ///< whether a message says that it is not shown
  KeptRenderer kept_;
  Diagnoser diagnoser_;
};

}  // namespace freevoxels
