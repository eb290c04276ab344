#include "apps/view/image_director.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "apps/view/window.h"
#include "engine/image/display_pass.h"
#include "engine/octree/volume_limits.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

constexpr double kQuickMilliseconds = 45.0;          // that a whole image may take while something moves
constexpr std::chrono::milliseconds kNotQuick{150};  // after which one that was quick before is no longer
constexpr std::chrono::milliseconds kStill{120};     // before better images are begun
constexpr int kFirstVoxels = 48;                     // along the longest edge, in the first image of a file

/// Whether a transfer function, or an isosurface, is all that the scenes of a volume differ in, apart from the camera.
bool equalButFunction(const SceneDescription& a, const SceneDescription& b) {
  const auto withoutFunction = [](SceneDescription scene) {
    ClassificationDescription& classification = scene.classification;
    if (classification.transferFunction) classification.transferFunction = kFunctionOfWindow;
    if (classification.iso) classification.iso = IsoSurface();
    classification.window.reset();
    classification.opacity.reset();
    classification.invert = false;
    scene.camera = {};
    scene.output = {};
    return scene;
  };
  return withoutFunction(a) == withoutFunction(b);
}

/// Whether clip box and plane are all that the scenes of a volume differ in, apart from the camera.
bool equalButClipping(const SceneDescription& a, const SceneDescription& b) {
  const auto withoutClipping = [](SceneDescription scene) {
    scene.input.clipBox.reset();
    scene.input.clipPlane.reset();
    scene.camera = {};
    scene.output = {};
    return scene;
  };
  return withoutClipping(a) == withoutClipping(b);
}

/// Whether an image of the same volume may be drawn with clipped rays (FrameSettings::clip).
bool mayClipRays(const DrawnImage& drawn) {
  const std::optional<Lighting>& lighting = drawn.scene.lighting;
  const bool lightsSamples =
      !lighting || (lighting->lights.size() <= shader::kMaxSampleLights && lighting->attenuation != LightAttenuation::Table);
  return drawn.isWholeOnDevice && drawn.scene.added.empty() && drawn.request.scene.method.drawing() == Draw::Gather && lightsSamples;
}

const char* nameOf(Purpose purpose) {
  switch (purpose) {
    case Purpose::Move:
    case Purpose::Classify:
    case Purpose::Clip:
    case Purpose::Edit:
      return "quick";
    case Purpose::Refine:
      return "finer";
    case Purpose::Whole:
      break;
  }
  return "whole";
}

}  // namespace

ImageDirector::ImageDirector(const Device& device, bool wholeOnly)
    : device_(device),
      volumes_(kMaxNumberedVoxels),
      quick_(device, volumes_, Window::wake),
      whole_(device, volumes_, Window::wake),
      wholeOnly_(wholeOnly) {}

ImageRequest ImageDirector::request(const ViewState& state, Purpose purpose, int voxels, double quality) const {
  ImageRequest request{.scene = state.scene,
                       .diagnosis = state.diagnosis,
                       .compared = state.comparedMethod(),
                       .isFrame = state.sequence.has_value(),
                       .film = state.sequence && !state.camera ? state.sequence->files : std::vector<std::string>(),
                       .number = lastRequest_,
                       .revision = revision_,
                       .purpose = purpose,
                       .voxelsAlongEdge = voxels,
                       .quality = quality};
  glm::ivec2& size = request.scene.camera.size;
  size = glm::max(glm::ivec2(glm::round(request.scale() * glm::dvec2(size))), glm::ivec2(1));
  return request;
}

/// False for what is not better than what is shown.
bool ImageDirector::keep(ViewState& state, RenderThread& thread, const RenderThread::Result& result, std::exception_ptr& failure) {
  if (&thread == &whole_ && std::exchange(drawsLayers_, false)) {
    if (result.drawn && result.drawn->layers) layered_ = result.drawn;
    return false;
  }
  if (&thread == clipping_.get() && !result.drawn) {  // another draft or the whole image says what is wrong, if it is
    answered_ = std::max(answered_, result.number);
    refuseClipping(asked_);
    return false;
  }
  if (&thread == clipping_.get()) {
    clippable_ = result.drawn->request.scene;
    if (result.number <= clippingAskedOf_) return false;
  }
  answered_ = std::max(answered_, result.number);
  if (&thread == &quick_) refines_ = false;
  if (!result.drawn) {
    state.problem = result.problem;
    spdlog::debug("no image: {}", result.problem);
    failure = result.failure;
    if (&thread == &whole_) unclipped_.reset();
    if (&thread == &whole_ && askedOfWhole_ == result.number) failed_ = result.number;
    return false;
  }
  state.problem.clear();
  const ImageRequest& request = result.drawn->request;
  const double time = result.drawn->milliseconds;
  // The first image of a movement also makes what the others keep.
  const bool isOfAllVoxels = request.purpose == Purpose::Move || request.purpose == Purpose::Classify || request.purpose == Purpose::Clip;
  if (isOfAllVoxels && state.latest && state.latest->request.purpose == request.purpose) movePace_.took(time);
  if (request.purpose == Purpose::Edit) editPace_.took(time);
  if (&thread == &whole_ && request.purpose != Purpose::Clip) {
    wholeRevision_ = request.revision;
    classified_.reset();
    unclipped_.reset();
    const Scene& scene = result.drawn->scene;
    if (result.drawn->isWholeOnDevice && scene.added.empty() && scene.classification.isPost(*scene.volume)) classified_ = request.scene;
    if (clipping_ && !result.drawn->isWholeOnDevice) refuseClipping(request.scene);
    if (!request.scene.input.isClipped() && mayClipRays(*result.drawn)) unclipped_ = withDensityScale(request.scene, scene);
  }
  const bool isWhole = request.purpose == Purpose::Whole;
  if (isWhole) {
    drawsWhole_ = false;
    wholeIsQuick_ = time < kQuickMilliseconds;
    wholeTime_ = time;
  }
  const std::uint64_t shown = state.latest ? state.latest->request.number : 0;
  const bool wholeIsThere = state.whole && request.number <= state.whole->request.number;
  return request.number >= shown && (isWhole || !wholeIsThere);
}

bool ImageDirector::take(ViewState& state, std::exception_ptr& failure) {
  bool isNew = std::exchange(isMixed_, false);
  std::erase_if(ending_, [](const std::unique_ptr<RenderThread>& thread) { return !thread->isBusy(); });
  for (RenderThread* const thread : {&quick_, &whole_, clipping_.get()}) {
    if (thread == nullptr) continue;
    const std::optional<RenderThread::Result> result = thread->take();
    if (!result || !keep(state, *thread, *result, failure)) continue;
    std::shared_ptr<const DrawnImage> drawn = result->drawn;
    if (drawn->request.purpose == Purpose::Whole) state.whole = drawn;
    state.latest = std::move(drawn);
    isNew = true;
    rate_.add(Clock::now());
    state.imagesPerSecond = rate_.perSecond();
    const DrawnImage& image = *state.latest;
    spdlog::debug("{} image, {}x{}: {:.1f} ms, {:.1f} a second", nameOf(image.request.purpose), image.shown->size().x,
                  image.shown->size().y, image.milliseconds, state.imagesPerSecond);
    if (image.request.number != lastRequest_ || isPending(state)) continue;
    if (!state.camera) {
      state.begin(image.scene);
      if (image.film) {  // what is automatic would be that of the frame
        state.keepScales(image.film->scene);
        state.scene.camera.look(*state.camera);
      }
      ++revision_;  // what was automatic is given now
      asked_ = state.scene;
    } else if (image.request.purpose == Purpose::Whole) {
      state.camera = image.scene.camera;  // an automatic camera is another one after a resize
    }
  }
  return isNew;
}

bool ImageDirector::isReadyToClip(const SceneDescription& scene) const {
  return clippable_ && equalButClipping(*clippable_, scene);
}

/// The thread that has the volume ready to be drawn with clipped rays, or null.
RenderThread* ImageDirector::clippingThread(const ViewState& state) {
  if (!state.scene.input.isClipped() || state.diagnosis.shown != Shown::Image || state.comparedMethod()) return nullptr;
  if (isReadyToClip(state.scene)) return clipping_.get();
  return unclipped_ && equalButClipping(*unclipped_, state.scene) ? &whole_ : nullptr;
}

/// Whether to make ready, while nothing else is to be done, what a change of clip box or plane is drawn of.
bool ImageDirector::wantsClipping(const ViewState& state) const {
  if (clippingAskedOf_ == lastRequest_ || !state.scene.input.isClipped() || !isComplete(state) || wholeIsQuick_ || wholeOnly_) return false;
  if (state.diagnosis.shown != Shown::Image || state.comparedMethod() || !mayClipRays(*state.whole)) return false;
  const SceneDescription scene = withDensityScale(state.scene, state.whole->scene);
  return !isReadyToClip(scene) && !(notClippable_ && equalButClipping(*notClippable_, state.scene));
}

void ImageDirector::prepareClipping(const ViewState& state) {
  clippingAskedOf_ = lastRequest_;
  clippable_.reset();
  if (!clipping_) clipping_ = std::make_unique<RenderThread>(device_, volumes_, Window::wake);
  ImageRequest prepared = request(state, Purpose::Clip, kAllVoxels, movePace_.quality());
  prepared.scene = withDensityScale(std::move(prepared.scene), state.whole->scene);
  clipping_->ask(std::move(prepared));
}

/// Frees the volume that is kept for clipping, when the thread has ended.
void ImageDirector::giveUpClipping() {
  clippable_.reset();
  if (!clipping_) return;
  clipping_->abandon();
  clipping_->end();
  ending_.push_back(std::move(clipping_));
}

/// There is too little memory for a second volume.
void ImageDirector::refuseClipping(const SceneDescription& scene) {
  notClippable_ = scene;
  giveUpClipping();
}

void ImageDirector::askOfChange(const ViewState& state) {
  lastPurpose_ = state.changed ? Purpose::Edit : Purpose::Move;
  if (whole_.busyFor() > kNotQuick) wholeIsQuick_ = false;
  if (wholeOnly_ || wholeIsQuick_) {
    askedOfWhole_ = lastRequest_;
    return whole_.ask(request(state, Purpose::Whole, kAllVoxels, 1.0));
  }
  const bool showsImage = state.diagnosis.shown == Shown::Image;
  const bool moves = !state.changed && wholeRevision_ == revision_ && showsImage;
  const bool classifies = state.changed && classified_ && showsImage && equalButFunction(*classified_, state.scene);
  if (drawsWhole_ && asked_.input.isClipped()) unclipped_.reset();  // which the image has begun to give up
  RenderThread* const clipping = moves ? nullptr : clippingThread(state);
  const Purpose purpose = moves ? Purpose::Move : classifies ? Purpose::Classify : clipping != nullptr ? Purpose::Clip : Purpose::Edit;
  // A whole image in full size is given up for what is wanted now.
  if (purpose == Purpose::Edit || drawsWhole_ || drawsLayers_) whole_.abandon();
  drawsWhole_ = drawsLayers_ = false;
  if (purpose != Purpose::Edit && state.latest && state.latest->request.purpose != purpose) movePace_.beginFrom(wholeTime_);
  const AdaptiveResolution& pace = purpose == Purpose::Edit ? editPace_ : movePace_;
  askedVoxels_ = state.camera || moves ? pace.voxelsAlongEdge() : kFirstVoxels;
  RenderThread& thread = purpose == Purpose::Clip ? *clipping : askedVoxels_ == kAllVoxels ? whole_ : quick_;
  thread.ask(request(state, purpose, askedVoxels_, pace.quality()));
}

/// Not two images at once, as they share the processor.
void ImageDirector::refine(const ViewState& state) {
  const glm::ivec3 size = state.latest ? state.latest->scene.volume->dimensions : glm::ivec3(0);
  const int longest = std::max({size.x, size.y, size.z});
  const bool hasStep = lastPurpose_ == Purpose::Edit && askedVoxels_ < longest / 3;
  if (hasStep) {
    askedVoxels_ *= 2;
    refines_ = true;
    quick_.ask(request(state, Purpose::Refine, askedVoxels_, 1.0));
  } else {
    askedOfWhole_ = lastRequest_;
    drawsWhole_ = true;
    whole_.ask(request(state, Purpose::Whole, kAllVoxels, 1.0));
  }
}

/// Colours that are edited once are likely to be edited again, so that layers are worth their time.
void ImageDirector::noteEdit(const SceneDescription& scene) {
  edited_.reset();
  for (const Colors colors : {Colors::Lights, Colors::Channels})
    if (scene != asked_ && equalButColors(scene, asked_, colors)) edited_ = colors;
}

/// Shows the scene as a mixture of its layers at once, if there are some that fit.
bool ImageDirector::mix(ViewState& state) {
  if (!mayMix(state) || state.diagnosis.shown != Shown::Image || state.comparedMethod()) return false;
  const Clock::time_point start = Clock::now();
  auto drawn = std::make_shared<DrawnImage>(*layered_);
  drawn->request = request(state, Purpose::Edit, kAllVoxels, 1.0);
  drawn->image = std::make_shared<const FrameTargets>(
      FrameTargets{.colorEnergy = uploadImage(device_, layered_->layers->mixed(state.scene, *layered_->scene.volume))});
  drawn->shown = {drawn->image, &drawn->image->colorEnergy};
  drawn->milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  spdlog::debug("image mixed of layers: {:.1f} ms", drawn->milliseconds);
  quick_.abandon();
  whole_.abandon();
  drawsWhole_ = drawsLayers_ = false;
  state.latest = std::move(drawn);
  answered_ = lastRequest_;
  lastPurpose_ = Purpose::Edit;
  askedVoxels_ = kAllVoxels;
  return isMixed_ = true;
}

bool ImageDirector::wantsLayers(const ViewState& state) const {
  if (!edited_ || drawsLayers_ || layersAskedOf_ == lastRequest_ || !isComplete(state)) return false;
  return !mayMix(state) || layered_->layers->colors() != *edited_;
}

void ImageDirector::ask(ViewState& state, glm::ivec2 pixels, bool moves) {
  if (pixels.x < 1 || pixels.y < 1) return;
  if (state.scene.camera.size != pixels) {
    state.scene.camera.size = pixels;
    state.moved = true;
    if (!state.camera) state.changed = true;
  }
  const Clock::time_point now = Clock::now();
  if (isPending(state)) {
    if (state.changed) ++revision_, noteEdit(state.scene);
    const SceneDescription& scene = state.scene;
    if (!scene.input.isClipped() || scene.input.volume != asked_.input.volume) giveUpClipping();
    if (clipping_ && !equalButClipping(asked_, scene)) clipping_->abandon();
    lastChange_ = now;
    ++lastRequest_;
    refines_ = false;
    if (!state.changed || !mix(state)) askOfChange(state);
    asked_ = state.scene;
    state.changed = state.moved = false;
  } else if (now - lastChange_ >= kStill && answered_ == lastRequest_ && askedOfWhole_ != lastRequest_ && !refines_ && !moves) {
    refine(state);
  } else if (!moves && wantsLayers(state)) {
    layersAskedOf_ = lastRequest_;
    drawsLayers_ = true;
    ImageRequest layers = request(state, Purpose::Whole, kAllVoxels, 1.0);
    layers.layers = edited_;
    whole_.ask(std::move(layers));
  } else if (!moves && wantsClipping(state)) {
    prepareClipping(state);
  }
}

bool ImageDirector::isComplete(const ViewState& state) const {
  return state.whole && state.whole->request.number == lastRequest_ && !isPending(state) && state.latest == state.whole;
}

void ImageDirector::end() {
  quick_.end();
  whole_.end();
  if (clipping_) clipping_->end();
}

bool ImageDirector::isBusy() const {
  return quick_.isBusy() || whole_.isBusy() || (clipping_ && clipping_->isBusy()) ||
         std::ranges::any_of(ending_, [](const std::unique_ptr<RenderThread>& thread) { return thread->isBusy(); });
}

std::optional<std::pair<std::string, double>> ImageDirector::activity() const {
  const auto whole = whole_.activity(), activity = whole ? whole : quick_.activity();
  if (const auto read = volumes_.reading(); read && activity) return std::pair(activity->first, *read);
  return activity;
}

}  // namespace freevoxels
