#include "apps/view/view_state.h"

#include "apps/common/failure.h"

namespace freevoxels {

std::optional<MethodDescription> ViewState::comparedMethod() const {
  if (diagnosis.shown != Shown::Image) return std::nullopt;
  MethodDescription other = scene.method;
  switch (comparison) {
    case 1:
      other.draw = Draw::Splats;
      other.composite = Composite::Sorted;
      return other;
    case 2:
      return MethodDescription{.paper = true};
    case 3:
      other = {.draw = Draw::Splats};
      return other;
    case 4:
      other.lod = 0.0;
      other.culling = false;
      return other;
    default:
      return std::nullopt;
  }
}

void ViewState::setCamera(const Camera& next) {
  try {
    checkCamera(next);
  } catch (const Error& error) {
    problem = withOptions(error);
    return;
  }
  camera = next;
  scene.camera.look(next);
  moved = true;
}

void ViewState::begin(const Scene& first) {
  camera = first.camera;
  pole = first.camera.up;
  const bool isFixed = first.volume && first.volume->classificationIsFixed;
  if (const auto& function = first.classification.transferFunction; function && !scene.classification.transferFunction && !isFixed)
    scene.classification.takeFunction(*function);
  if (first.volume && first.volume->madeOf == MadeOf::Channels && first.classification.emission)
    scene.emission.take(*first.classification.emission);  // which would follow the channels' colours
  LightingDescription& lighting = scene.lighting;
  if (lighting.hasLight() || !first.lighting) return;
  lighting.take(first.lighting->lights);
  lighting.ambient = first.lighting->ambient;
}

void Edits::takeFlight() {
  CameraDescription& first = scene.camera;
  if (!first.flight) return;
  flight = readFlight(*first.flight);
  scene.lighting = lightingOfFlight(scene.lighting, *first.flight);
  const CameraDescription given = std::exchange(first, flight.keys.front().camera);
  first.size = given.size;
  first.frames = given.frames;
  first.holdout = given.holdout;
}

void ViewState::show(const SceneDescription& other, const std::optional<Sequence>& frames) {
  scene = other;
  flight = {};
  takeFlight();
  sequence = frames;
  camera.reset();
  problem.clear();
  changed = true;
}

void ViewState::showFrame(const std::string& file) {
  scene.input.volume = file;
  changed = true;
  if (!camera) return;  // the first image says what is not given
  scene.camera.look(*camera);
  keepScales(latest->scene);
}

void ViewState::keepScales(const Scene& of) {
  if (of.volume && of.volume->classificationIsFixed) return;
  const Classification& now = of.classification;
  ClassificationDescription& classification = scene.classification;
  if (!now.transferFunction && !classification.densityScale) classification.takeDensityScale(now.densityScale);
  if (now.emission) scene.emission.take(*now.emission);
}

void ViewState::clip(const std::optional<VoxelBox>& box, const std::optional<ClipPlane>& plane) {
  if (!latest) return;
  const Classification& now = latest->scene.classification;
  ClassificationDescription& options = scene.classification;
  // A baked volume has the scale of its file, clipped or not.
  if (!now.transferFunction && !options.transferFunction && !options.densityScale && !latest->scene.volume->classification)
    options.takeDensityScale(now.densityScale);
  scene.input.clipBox = box;
  scene.input.clipPlane = plane;
  changed = true;
}

void EditHistory::restore(ViewState& state, std::optional<Edits> edits) {
  if (!edits) return;
  const glm::ivec2 size = state.scene.camera.size;
  const std::optional<Camera> camera = openedName(state) == openedName(*edits) ? state.camera : std::nullopt;
  static_cast<Edits&>(state) = *std::move(edits);
  state.scene.camera.size = size;
  if (camera && state.camera) {
    state.camera = camera;
    state.scene.camera.look(*camera);
  }
  state.problem.clear();
  state.changed = true;
}

void CameraHistory::follow(const ViewState& state, bool moved, bool busy) {
  if (openedName(state) != seen_ || !state.camera) steps_ = {};
  seen_ = openedName(state);
  if (state.camera) steps_.follow(*state.camera, moved, busy);
}

}  // namespace freevoxels
