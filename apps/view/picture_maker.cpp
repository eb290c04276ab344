#include "apps/view/picture_maker.h"

#include <algorithm>
#include <chrono>

#include "engine/image/display_pass.h"
#include "engine/volume/coarse_volume.h"

namespace freevoxels {

namespace {

int blockEdge(const Volume& volume, int voxelsAlongEdge) {
  const glm::ivec3 size = volume.dimensions;
  return 1 + (std::max({size.x, size.y, size.z}) - 1) / voxelsAlongEdge;
}

}  // namespace

PictureMaker::PictureMaker(const Device& device, VolumeCache& volumes)
    : device_(device), volumes_(volumes), diagnoser_(device) {}

std::shared_ptr<const Volume> PictureMaker::coarse(const Scene& scene, int voxelsAlongEdge) {
  const bool densities = !scene.classification.transferFunction;
  const int edge = blockEdge(*scene.volume, voxelsAlongEdge);
  if (whole_ == scene.volume && edge == blockEdge_ && densities == coarseIsOfDensities_) return coarse_;
  whole_ = scene.volume;
  blockEdge_ = edge;
  coarseIsOfDensities_ = densities;
  coarse_ = edge <= 1 ? whole_
                      : std::make_shared<const Volume>(coarseVolume(
                            *whole_, edge, densities ? WithoutData::Zero : WithoutData::Ignored));
  rendererOptions_.clear();
  return coarse_;
}

void PictureMaker::makeRenderer(const Scene& scene, const PictureRequest& request, const Progress& progress) {
  const std::shared_ptr<const Volume> volume = coarse(scene, request.voxelsAlongEdge);
  const std::string options = request.scene.rendererText(scene, request.method.table());
  if (renderer_ && options == rendererOptions_) return;
  renderer_ = nullptr;  // not both at once
  diagnoser_.reset();
  rendererOptions_.clear();
  renderer_ =
      std::make_unique<Renderer>(device_, *volume, scene.classification, request.method.table(), progress);
  rendererOptions_ = options;
}

Picture PictureMaker::make(const PictureRequest& request, const Progress& progress) {
  request.scene.checkLook();
  if (progress) progress("reading " + request.scene.input.input, 0.0);
  Picture picture{.request = request,
                  .scene = request.scene.resolve(volumes_.read(request.scene)),
                  .device = device_.description()};
  const auto start = std::chrono::steady_clock::now();
  makeRenderer(picture.scene, request, progress);

  FrameSettings settings{.size = request.scene.camera.size,
                         .depth = request.scene.output.wantsDepth(),
                         .lighting = picture.scene.lighting};
  request.method.apply(settings);
  picture.image = renderer_->renderOnDevice(picture.scene.camera, settings, progress);
  picture.shown = {picture.image, &picture.image->colorEnergy};
  OptionList method;
  request.method.describe(method);
  picture.options = request.scene.describe(picture.scene, method);
  picture.times = renderer_->timings();
  picture.memory = renderer_->memory();
  picture.cut = renderer_->cutCounts();
  picture.visibleVoxels = renderer_->occupiedVoxelCount();
  if (request.diagnosis.shown != Shown::Picture)
    picture.shown = std::make_shared<const RenderTarget>(
        uploadImage(device_, diagnoser_.make(request.diagnosis, *renderer_, *coarse_, request.method.table(),
                                             picture.scene.camera, settings)));
  picture.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return picture;
}

}  // namespace freevoxels
