#include "apps/view/image_maker.h"

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/common/failure.h"
#include "apps/common/scene_options.h"
#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/description/scene_fields.h"
#include "engine/image/display_pass.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

namespace {

/// Different for whatever is read differently.
std::string nameOf(const SceneDescription& scene, bool clipped) {
  SceneDescription read;
  read.input = scene.input;
  if (!clipped) {
    read.input.clipBox.reset();
    read.input.clipPlane.reset();
  }
  const auto nameOf = [](const std::optional<GridRequest>& request) {
    return request ? fmt::format("{} {}", request->isRequired, request->name) : std::string(kNone);
  };
  read.classification.channels = scene.classification.channels;
  read.classification.labels = scene.classification.labels;
  return fmt::format("{}temperature={} albedo={}", textOf(read, {"input", "classification"}), nameOf(scene.emission.grid()),
                     nameOf(scene.classification.grid()));
}

Volume readFrame(const SceneDescription& scene, std::uint64_t maximumVoxels, const Progress& progress) {
  try {
    return scene.readVolume(maximumVoxels, 0, progress, true);
  } catch (const EmptyVolumeError&) {
    return {.source = scene.input.volume, .dimensions = glm::ivec3(1), .scalars = ScalarBricks(glm::ivec3(1))};
  }
}

int blockEdge(const Volume& volume, int voxelsAlongEdge) {
  const glm::ivec3 size = volume.dimensions;
  return 1 + (std::max({size.x, size.y, size.z}) - 1) / voxelsAlongEdge;
}

}  // namespace

VolumeCache::VolumeCache(const SceneDescription& scene, std::shared_ptr<const Volume> volume)
    : maximumVoxels_(volume->voxelCount()), clippedName_(nameOf(scene, true)), clipped_(std::move(volume)) {}

VolumeCache::Read VolumeCache::read(const SceneDescription& scene, std::uint64_t number, bool isFrame, bool clips) {
  const std::lock_guard lock(mutex_);
  const std::string clippedName = nameOf(scene, true);
  if (clips) {
    if (clipped_ && clippedName == clippedName_) return {clipped_, whole_};
    clipped_ = nullptr;  // not both at once
  }
  const std::string name = nameOf(scene, false);
  if (!whole_ || name != name_) {
    whole_ = nullptr;
    SceneDescription unclipped = scene;
    unclipped.input.clipBox.reset();
    unclipped.input.clipPlane.reset();
    if (!isFrame) frames_.clear();
    const auto kept = std::ranges::find(frames_, name, [](const auto& frame) { return frame.first; });
    whole_ = kept != frames_.end() ? kept->second : readWhole(unclipped, number, isFrame);
    if (isFrame) keepFrame(name, whole_);
    name_ = name;
  }
  if (!clips) return {whole_, whole_};
  clipped_ = scene.input.clipBox || scene.input.clipPlane ? std::make_shared<const Volume>(scene.input.clip(*whole_)) : whole_;
  clippedName_ = clippedName;
  return {clipped_, whole_};
}

std::shared_ptr<const FilmView> VolumeCache::viewOf(const SceneDescription& scene, const std::vector<std::string>& files) {
  const std::lock_guard lock(mutex_);
  const std::string name = fmt::format("{}{}", textOf(scene, {"classification", "emission", "camera", "lighting"}), fmt::join(files, "\n"));
  if (name == filmName_) return film_;
  filmName_.clear();
  std::optional<FilmView> view = viewOfFilm(scene, files, maximumVoxels_);
  film_ = view ? std::make_shared<const FilmView>(std::move(*view)) : nullptr;
  filmName_ = name;
  return film_;
}

std::shared_ptr<const Volume> VolumeCache::readWhole(const SceneDescription& scene, std::uint64_t number, bool isFrame) {
  const Progress progress = [&](std::string_view, double fraction) {
    if (number < mayBeRead_) fail(ErrorKind::Input, "reading '{}' was given up: open it again to read it", scene.input.volume);
    read_ = fraction;
  };
  struct Ended {
    std::atomic<double>& read;
    ~Ended() { read = kNotReading; }
  } ended{read_};
  progress("", 0.0);
  auto volume =
      std::make_shared<const Volume>(isFrame ? readFrame(scene, maximumVoxels_, progress) : scene.readVolume(maximumVoxels_, 0, progress));
  logWarnings(*volume, false);
  logAssumptions(*volume);
  return volume;
}

/// With as many frames before it as take little of the machine's memory.
void VolumeCache::keepFrame(const std::string& name, const std::shared_ptr<const Volume>& volume) {
  constexpr std::uint64_t kPartOfMemory = 8;
  std::erase_if(frames_, [&](const auto& frame) { return frame.first == name; });
  frames_.emplace_back(name, volume);
  const auto bytes = [&] {
    std::uint64_t sum = 0;
    for (const auto& frame : frames_) forEachGrid([&](const ScalarBricks& grid) { sum += grid.bytes(); }, *frame.second);
    return sum;
  };
  while (frames_.size() > 1 && bytes() > machineMemoryBytes() / kPartOfMemory) frames_.pop_front();
}

std::optional<double> VolumeCache::reading() const {
  const double fraction = read_;
  return fraction == kNotReading ? std::nullopt : std::optional(fraction);
}

ImageMaker::ImageMaker(const Device& device, VolumeCache& volumes)
    : device_(device), volumes_(volumes), kept_(device), diagnoser_(device) {}

std::shared_ptr<const VolumeSource> ImageMaker::coarse(const Scene& scene, int voxelsAlongEdge) {
  const bool densities = !scene.classification.transferFunction;
  const int edge = blockEdge(*scene.volume, voxelsAlongEdge);
  if (whole_ == scene.volume && edge == blockEdge_ && densities == coarseIsOfDensities_) return coarse_;
  // Before anything can fail, so that nothing of the last volume is taken for this one's; and not both in memory at once.
  kept_.release();  // which refers to the volume
  whole_ = nullptr;
  coarse_ = nullptr;
  coarse_ = std::make_shared<const VolumeInMemory>(
      edge <= 1 ? scene.volume
                : std::make_shared<const Volume>(coarseVolume(*scene.volume, edge, densities ? WithoutData::Zero : WithoutData::Ignored)));
  whole_ = scene.volume;
  blockEdge_ = edge;
  coarseIsOfDensities_ = densities;
  return coarse_;
}

/// The coarse volume without what is clipped. It is clipped anew for each draft, as the whole one would take longer.
std::shared_ptr<const VolumeSource> ImageMaker::clippedCoarse(const InputDescription& input) const {
  InputDescription ofCoarse = input;
  if (ofCoarse.clipBox) *ofCoarse.clipBox = {ofCoarse.clipBox->first / blockEdge_, ofCoarse.clipBox->last / blockEdge_};
  return std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(ofCoarse.clip(*known(coarse_))));
}

/// Sums over the volume, the environment and the histogram are made once for all cameras and all drafts of clipping.
Scene ImageMaker::resolve(const ImageRequest& request, std::shared_ptr<const Volume> volume, const FilmView* film) {
  SceneDescription scene = request.scene;
  if (request.isFrame && !volume->temperature && !volume->classification) scene.emission = {.emission = false};
  SceneDescription resolved = scene;
  resolved.camera = {};
  resolved.output = {};
  resolved.input.clipBox.reset();
  resolved.input.clipPlane.reset();
  if (scene_ && !film && scene_->volume == volume && resolvedOf_ == resolved) {
    scene_->camera = scene.cameras(*scene_).front();
    return *scene_;
  }
  scene_.reset();
  scene_ = film ? scene.resolveLike(film->scene, std::move(volume)) : scene.resolve(std::move(volume));
  resolvedOf_.reset();
  if (!film) resolvedOf_ = std::move(resolved);
  return *scene_;
}

DrawnImage withOutput(const DrawnImage& drawn, const OutputDescription& output) {
  DrawnImage result = drawn;
  result.request.scene.output = output;
  return result;
}

/// The scene's holdout where it has the size of the image. Elsewhere, and where it cannot be read, it is not shown, and one message says
/// so.
std::shared_ptr<const Holdout> ImageMaker::holdoutOf(const ImageRequest& request) {
  const CameraDescription& camera = request.scene.camera;
  if (camera.holdout != heldOutBy_) {
    heldOutBy_ = camera.holdout;
    holdout_ = nullptr;
    isHoldoutMentioned_ = false;
    try {
      if (camera.holdout) holdout_ = readHoldout(*camera.holdout);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Input) throw;
      spdlog::warn("the holdout is not shown: {}", withOptions(error));
    }
  }
  if (!holdout_ || holdout_->size == camera.size) return holdout_;
  if (request.purpose == Purpose::Whole && !std::exchange(isHoldoutMentioned_, true))
    spdlog::warn("the holdout '{}' is not shown: it has {}x{} pixels, and the image of the window {}x{}", *camera.holdout, holdout_->size.x,
                 holdout_->size.y, camera.size.x, camera.size.y);
  return nullptr;
}

DrawnImage ImageMaker::make(const ImageRequest& request, const Progress& progress) {
  request.scene.check();
  const std::string before = std::exchange(input_, request.scene.input.volume);
  if (progress) progress(before == input_ ? "preparing" : "reading " + input_, 0.0);
  const std::shared_ptr<const FilmView> film = request.film.empty() ? nullptr : volumes_.viewOf(request.scene, request.film);
  if (!request.film.empty() && !film) fail(ErrorKind::Input, "no frame of the sequence holds anything to draw");
  const bool clipsCoarse = request.voxelsAlongEdge != kAllVoxels && request.scene.input.isClipped();
  const bool clipsRays = request.purpose == Purpose::Clip;
  VolumeCache::Read read = volumes_.read(request.scene, request.number, request.isFrame, !clipsCoarse && !clipsRays);
  DrawnImage drawn{.request = request,
                   .scene = resolve(request, std::move(read.volume), film.get()),
                   .film = film,
                   .whole = std::move(read.whole),
                   .device = device_.description()};
  if (drawn.scene.volume->madeOf == MadeOf::Channels) drawn.channels = request.scene.shownChannels();
  const auto start = std::chrono::steady_clock::now();
  std::shared_ptr<const VolumeSource> source = coarse(drawn.scene, request.voxelsAlongEdge);
  if (clipsCoarse) source = clippedCoarse(request.scene.input);
  if (!kept_.isFor(source, request.scene, drawn.scene)) diagnoser_.reset();
  Renderer& renderer = kept_.get(source, request.scene, drawn.scene, progress);

  FrameSettings settings = frameSettings(request.scene, request.scene.output.aovs.needDepth());
  settings.lighting = drawn.scene.lighting;
  settings.holdout = holdoutOf(request);
  if (clipsRays) settings.clip = request.scene.input.rayClip(*drawn.scene.volume);
  if (request.purpose != Purpose::Whole && settings.gathers()) {  // a draft
    settings.quality = request.quality / request.scale();
    settings.lod *= float(request.scale());  // blocks as in the whole image, so that none are made for a draft alone
    settings.allowsOldLight = request.purpose == Purpose::Move || request.purpose == Purpose::Classify;
    if (request.purpose == Purpose::Edit || clipsRays) settings.scatteringCoarseness = 2;
    if (request.purpose == Purpose::Refine) settings.scatteringCoarseness = 1;
  }
  if (request.layers) {
    if (auto layers = ColorLayers::make(renderer, device_, request.scene, drawn.scene, settings, *request.layers, progress))
      drawn.layers = std::make_shared<const ColorLayers>(std::move(*layers));
    return drawn;
  }
  drawn.image = renderer.renderOnDevice(drawn.scene.camera, settings, progress);
  drawn.shown = {drawn.image, &drawn.image->colorEnergy};
  drawn.times = renderer.timings();
  drawn.isWholeOnDevice = !renderer.drewInCubes();
  drawn.memory = renderer.memory();
  drawn.cut = renderer.cutCounts();
  drawn.visibleVoxels = renderer.occupiedVoxelCount();
  if (request.diagnosis.shown != Shown::Image)
    drawn.shown = std::make_shared<const RenderTarget>(
        uploadImage(device_, diagnoser_.make(request.diagnosis, renderer, *known(source), request.scene.method.table(),
                                             drawn.scene.camera, settings)));
  drawn.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return drawn;
}

}  // namespace freevoxels
