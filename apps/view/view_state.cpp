#include "apps/view/view_state.h"

#include <algorithm>

#include "apps/common/failure.h"

namespace freevoxels {

namespace {

/// Whether lights may be brighter than those that are chosen where none are given, with which white fog is hardly brighter than 0.8.
bool exceedsDefaultLights(const LightingDescription& lighting) {
  const auto isBright = [](const LightingDescription::GivenLight& given) {
    const glm::dvec3& color = given.light.color;
    return !given.light.atInfinity || given.light.intensity * std::max({color.r, color.g, color.b}) > 1.01 * kDefaultIrradiance;
  };
  constexpr double kMostAmbient = 0.5;
  const glm::dvec3 ambient = lighting.ambient.value_or(glm::dvec3(0.0));
  return std::max({ambient.r, ambient.g, ambient.b}) > kMostAmbient || lighting.environment || lighting.lights.size() > 1 ||
         std::ranges::any_of(lighting.lights, isBright);
}

/// Whether pixels may be brighter than 1, by lights, light from around or emission. Channels send out the colours of their values. `drawn`
/// is an image of the scene, maybe from before the last change.
bool mayBurnOut(const SceneDescription& scene, const DrawnImage& drawn) {
  if (scene.method.showsValues()) return false;
  const bool isOfChannels = drawn.scene.volume && drawn.scene.volume->madeOf == MadeOf::Channels;
  const bool letsLightThrough =
      isOfChannels && scene.added.empty() && !drawn.channels.empty() && std::ranges::all_of(drawn.channels, &ChannelStyle::emits);
  if (!scene.lighting.unlit && !letsLightThrough && exceedsDefaultLights(scene.lighting)) return true;
  const EmissionDescription& emission = scene.emission;
  const bool isFire = emission.isAsked() || (emission.emission != false && drawn.scene.classification.emission);
  const auto shines = [](const SceneVolume& one) { return one.classification.emission.has_value(); };
  return (isFire && !isOfChannels) || std::ranges::any_of(drawn.scene.added, shines);
}

}  // namespace

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

void ViewState::chooseToneMap() {
  std::optional<ToneMap>& given = scene.output.toneMap;
  if (!camera || !latest || latest->request.scene.input.volume != scene.input.volume || (given && !toneMapIsAutomatic)) return;
  const bool isBright = mayBurnOut(scene, *latest);
  if (isBright == given.has_value()) return;
  given.reset();
  if (isBright) {
    given = ToneMap::Filmic;
    notice = "the tone map is filmic, as the light may be brighter than the screen: the panel View has others";
  }
  toneMapIsAutomatic = isBright;
}

DisplayLook ViewState::look() const {
  DisplayLook look = scene.output.look();
  if (toneMapIsAutomatic && latest && latest->request.diagnosis.shown != Shown::Image) look.toneMap = ToneMap::None;
  return look;
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

SceneDescription withDensityScale(SceneDescription scene, const Scene& drawn) {
  ClassificationDescription& options = scene.classification;
  // A baked volume has the scale of its file, clipped or not.
  if (!drawn.classification.transferFunction && !options.transferFunction && !options.densityScale && !drawn.volume->classification)
    options.takeDensityScale(drawn.classification.densityScale);
  return scene;
}

void ViewState::clip(const std::optional<VoxelBox>& box, const std::optional<ClipPlane>& plane) {
  if (!latest) return;
  scene = withDensityScale(scene, latest->scene);
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
