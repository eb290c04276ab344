#include "engine/description/scene_description.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/description/added_volume.h"
#include "engine/description/flight_description.h"
#include "engine/description/scene_fields.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/octree/volume_limits.h"
#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"
#include "engine/visibility/detail_rule.h"
#include "engine/volume/subject.h"
#include "engine/volume/transfer_curves.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

/// The double with the fewest digits that rounds to this float.
double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

ClassificationDescription resolvedClassification(const ClassificationDescription& given, const Scene& scene) {
  const Classification& classification = scene.classification;
  if (scene.volume->classificationIsFixed) return {};
  if (classification.transferFunction) {
    ClassificationDescription description{.order = classification.order};
    if (given.transferFunction) {
      description.transferFunction = given.transferFunction;
      description.window = given.window;
      if (const TransferCurves curves = readTransferCurves(*given.transferFunction);
          !given.window && curves.range != TransferCurves::Range::Values)
        description.window = windowOf(curves, *scene.volume);
      description.opacity = given.opacity;
      description.invert = given.invert;
    } else {
      description.takeFunction(*classification.transferFunction);
    }
    return description;
  }
  const glm::vec3 albedo = classification.albedo;
  const bool hasLabels = scene.volume->madeOf == MadeOf::Labels;
  const bool hasGrid = scene.volume->albedo && scene.volume->madeOf == MadeOf::Grids && !scene.volume->classification;
  return {.densityScale = classification.densityScale,
          .albedo = glm::dvec3(shortest(albedo.r), shortest(albedo.g), shortest(albedo.b)),
          .albedoGrid = hasGrid ? std::optional(scene.volume->albedo->name) : given.albedoGrid,
          .labels = hasLabels ? std::optional(given.labels.value_or(Labels())) : given.labels,
          .channels = given.channels};
}

EmissionDescription resolvedEmission(const EmissionDescription& given, const Scene& scene) {
  EmissionDescription description;
  // Temperatures that are not shown: another range of them, as in a film, must not change that.
  if (!scene.classification.emission)
    return {.emission = scene.volume->temperature && !scene.volume->classification ? false : given.emission};
  description.emission = true;
  description.take(*scene.classification.emission);
  // A procedural volume's temperatures have no name.
  const TemperatureGrid& grid = *scene.volume->temperature;
  if (!grid.name.empty() && !grid.isRadiance && !scene.volume->classification)
    description.temperatureGrid = scene.volume->temperature->name;
  return description;
}

LightingDescription resolvedLighting(const LightingDescription& given, const std::optional<Lighting>& lighting) {
  if (!lighting) return {.unlit = true};
  LightingDescription description{.ambient = lighting->ambient,
                                  .tint = lighting->tint,
                                  .phaseG = lighting->phaseG,
                                  .scattering = lighting->scattering,
                                  .attenuation = given.attenuation};
  description.take(lighting->lights);
  if (!lighting->lights.empty()) description.shading = lighting->surface > 0.0 ? Shading::Gradient : Shading::Scatter;
  if (lighting->surface > 0.0) description.surface = lighting->surface;
  if (!lighting->environment) return description;
  description.environment = given.environment;
  description.environmentRotation = lighting->environment->rotation;
  description.environmentIntensity = lighting->environment->intensity;
  return description;
}

/// Without what a projection hardly shows, so that its image shows the rest large.
Classification withoutFaintValues(Classification classification) {
  constexpr float kFaint = 0.01f;
  for (TransferFunction::OpacityPoint& point : classification.transferFunction->opacity)
    if (point.opacity < kFaint) point.opacity = 0.0f;
  return classification;
}

MethodDescription resolvedMethod(const MethodDescription& given) {
  FrameSettings frame;
  given.apply(frame);
  const TableSettings table = given.table();
  MethodDescription result{.mode = given.mode,
                           .slice = given.slice,
                           .annotate = given.annotate,
                           .draw = Draw::Gather,
                           .directions = table.directions,
                           .code = table.code,
                           .pathLengthCorrection = table.pathLengthCorrection,
                           .lod = given.lod.value_or(double(frame.lod)),
                           .quality = frame.quality,
                           .hierarchyFilter = table.filter};
  if (frame.gathers()) {
    result.cullThreshold = given.culling.value_or(true) ? given.cullThreshold.value_or(double(frame.gather().endTransmittance)) : 0.0;
    return result;
  }
  const SplatSettings& splats = frame.splats();
  result.draw = Draw::Splats;
  result.composite = splats.composite;
  result.attenuation = splats.attenuation;
  result.gradient = splats.gradient;
  result.culling = splats.culling;
  result.cullThreshold = given.cullThreshold.value_or(double(splats.cullThreshold));
  return result;
}

}  // namespace

SceneDescription SceneDescription::of(const std::string& volume) const {
  SceneDescription result = *this;
  result.input.volume = volume;
  return result;
}

std::vector<ChannelStyle> SceneDescription::shownChannels() const {
  if (input.volume.empty() || input.kind() != VolumeKind::Scan) return classification.channels;
  ScanRequest request = input.scanRequest(kMaxNumberedVoxels);
  request.channels = classification.channels;
  return scanChannels(input.volume, request);
}

bool channelsAddUp(const SceneDescription& scene) {
  const std::vector<ChannelStyle>& channels = scene.classification.channels;
  const bool scatters = channels.empty() || !std::ranges::all_of(channels, &ChannelStyle::emits);
  return !scatters || scene.lighting.unlit || scene.lighting.scattering == 1;
}

void checkLayers(const SceneDescription& scene, const Aovs& aovs) {
  if (aovs.lights && scene.lighting.unlit)
    fail(ErrorKind::Usage, "{} are layers of light, and there is none: leave {} out", Parameter("aov", "lights"), Parameter("unlit"));
  if (!aovs.channels) return;
  const Parameter aov("aov", "channels");
  if (scene.shownChannels().empty())
    fail(ErrorKind::Usage, "{} are layers of channels, and there are none: give {}", aov, Parameter("channel"));
  if (!scene.added.empty()) fail(ErrorKind::Usage, "{} is of one volume: leave out {}", aov, Parameter("add"));
  if (!channelsAddUp(scene))
    fail(ErrorKind::Usage, "light that is scattered more than once is no sum over channels: {} needs {} or {}", aov,
         Parameter("scattering", "1"), Parameter("unlit"));
}

Camera sliceCameraOf(const SceneDescription& scene, const Volume& volume) {
  return sliceCamera(*scene.method.slice, volume.up, worldBox(volume), scene.camera.size);
}

void refuseTurnOfSlice(const SceneDescription& scene) {
  if (scene.method.slice)
    fail(ErrorKind::Usage, "a slice is one image, and the camera of a turntable goes around: leave {} out, or render an image for each {}",
         Parameter("slice"), Parameter("slice"));
}

namespace {

void checkSlice(const SceneDescription& scene) {
  if (!scene.method.slice) return;
  if (scene.output.aovs.any())
    fail(ErrorKind::Usage, "a slice has no depth, and no layers: leave out {}", Parameter("aov", aovText(scene.output.aovs)));
  if (scene.method.drawing() == Draw::Splats)
    fail(ErrorKind::Usage, "{} draws the values of voxels: leave {} and other options of splats out", Parameter("slice"),
         Parameter("draw", "splats"));
}

/// The lighting of the first frame of a scene.
LightingDescription litBy(const SceneDescription& scene) {
  return scene.camera.flight ? lightingOfFlight(scene.lighting, *scene.camera.flight) : scene.lighting;
}

}  // namespace

void SceneDescription::check() const {
  input.check();
  if (camera.holdout && method.drawing() == Draw::Splats) failHoldoutOfSplats();
  if (!added.empty() && method.drawing() == Draw::Splats)
    fail(ErrorKind::Usage, "splats are drawn of one volume: leave out {} and other options of splats, or {}", Parameter("draw", "splats"),
         Parameter("add"));
  if (method.isProjected() && !added.empty())
    fail(ErrorKind::Usage, "{} shows the values of one volume: leave {} out", Parameter("mode"), Parameter("add"));
  for (const AddedVolume& one : added) {
    one.input.check();
    one.classification.check(one.input);
    one.emission.check(one.input);
  }
  if (classification.albedoGrid && classification.albedoGrid != kNone && proceduralName(input.volume))
    fail(ErrorKind::Usage, "{} chooses among the grids of a file, and {} has one", Parameter("albedo-grid"), input.volume);
  classification.check(input);
  emission.check(input);
  checkSlice(*this);
  checkLayers(*this, output.aovs);
  camera.check();
  litBy(*this).check();
}

Volume SceneDescription::readVolume(std::uint64_t maximumVoxels, int level, const Progress& progress, bool isFrame) const {
  MoreGrids more{.mayBeMissing = isFrame};
  if (!method.showsValues()) {
    more.temperature = emission.grid();
    more.albedo = classification.grid();
  }
  return input.open(maximumVoxels,
                    {.more = std::move(more),
                     .labels = method.isProjected() ? LabelRequest() : classification.labelRequest(),
                     .channels = classification.channels,
                     .imageEdge = std::max(camera.size.x, camera.size.y)},
                    level, progress);
}

std::shared_ptr<const VolumeSource> SceneDescription::openSource(int frameCount, bool mayStayFile, bool isFrame,
                                                                 const Progress& progress) const {
  const std::shared_ptr<const fvx::FvxFile> file = input.baked();
  if (!file)
    return std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(readVolume(kMaxNumberedVoxels, 0, progress, isFrame)));
  const BakedNeed need = needOf(*file, frameCount);
  return bakedSource(file, need.level, need.isRead || !mayStayFile, progress);
}

BakedNeed SceneDescription::needOf(const fvx::FvxFile& file, int frameCount) const {
  const Volume outline = bakedOutline(file);
  const Classification classified = resolveClassification(outline);
  const bool isRead = !isAsBaked(outline, classified);
  if (method.slice) return {.level = 0, .isRead = true};
  if (classified.transferFunction) return {.level = 0, .isRead = isRead};
  FrameSettings frame;
  method.apply(frame);
  const HierarchyLayout hierarchy(outline.dimensions);
  int level = file.levels() - 1;
  for (const Camera& one : cameras(outline, classified, frameCount, added.empty() ? std::vector<SceneVolume>() : openAddedVolumes(*this))) {
    const PixelRays rays = pixelRays(one, camera.size, outline.indexToWorld);
    level = std::min(level, detailRule(hierarchy, rays, camera.size, frame.blockPixels()).finest);
  }
  // One level finer than what is drawn, as the footprints of what is drawn are those of the opened level's voxels.
  return {.level = std::max(level - 1, 0), .isRead = isRead};
}

std::vector<Camera> SceneDescription::cameras(const Volume& volume, const Classification& classified, int frameCount,
                                              std::span<const SceneVolume> others) const {
  if (method.slice) return std::vector<Camera>(std::size_t(frameCount), sliceCameraOf(*this, volume));
  const auto content = [&] {
    Subject all = contentOf(volume, method.isProjected() ? withoutFaintValues(classified) : classified);
    if (others.empty()) return all;
    for (const SceneVolume& other : others) {
      const Subject own = contentOf(*known(other.source), other.classification);
      all.points.insert(all.points.end(), own.points.begin(), own.points.end());
    }
    glm::dvec3 low = all.points.front(), high = low;
    for (const glm::dvec3& point : all.points) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    all.centre = 0.5 * (low + high);
    return all;
  };
  return camera.resolve(volume, content, frameCount);
}

std::vector<FrameView> SceneDescription::views(const Scene& scene, int frameCount) const {
  if (camera.flight && !method.slice) return flightViews(*camera.flight, *scene.volume, frameCount);
  std::vector<FrameView> views;
  for (const Camera& one : cameras(scene, frameCount)) views.push_back({.camera = one, .lights = {}});
  return views;
}

void Scene::show(const FrameView& view) {
  camera = view.camera;
  if (lighting && !view.lights.empty()) lighting->lights = view.lights;
}

std::vector<SceneVolume> Scene::volumes(std::shared_ptr<const VolumeSource> source) const {
  std::vector<SceneVolume> all{{.source = std::move(source), .classification = classification}};
  all.insert(all.end(), added.begin(), added.end());
  return all;
}

Scene SceneDescription::resolve(std::shared_ptr<const Volume> volume) const {
  Scene scene{.volume = std::move(volume)};
  scene.classification = resolveClassification(*scene.volume);
  scene.added = openAddedVolumes(*this);
  resolveView(scene);
  return scene;
}

Classification SceneDescription::resolveClassification(const Volume& volume) const {
  if (method.isProjected()) return classification.resolveProjected(volume, *method.mode);
  if (method.slice) return classification.resolveSliced(volume);
  Classification result = classification.resolve(volume, emission.shines(volume));
  result.emission = emission.resolve(volume, result);
  if (result.emission && !classification.albedo && !volume.classification) result.albedo = glm::vec3(kSmokeAlbedo);
  return result;
}

void SceneDescription::resolveView(Scene& scene) const {
  scene.camera = cameras(scene).front();
  scene.lighting = resolveLighting(*scene.volume, scene.classification, scene.camera);
}

std::optional<Lighting> SceneDescription::resolveLighting(const Volume& volume, const Classification& classified,
                                                          const Camera& seenBy) const {
  return method.showsValues() ? std::nullopt : litBy(*this).resolve(volume, classified, seenBy);
}

Scene SceneDescription::resolveLike(const Scene& other, std::shared_ptr<const Volume> volume) const {
  SceneDescription fixed = *this;
  if (!volume->classificationIsFixed) fixed.classification.take(other.classification);
  // A frame has the light and the albedo of all, or none where it has no temperatures.
  if (other.classification.emission && volume->temperature) {
    fixed.emission.emission = true;
    fixed.emission.take(*other.classification.emission);
  } else if (!volume->classification) {
    fixed.emission = {.emission = false};
  }
  Scene scene{.volume = std::move(volume), .camera = other.camera, .lighting = other.lighting, .added = openAddedVolumes(*this)};
  scene.classification = fixed.resolveClassification(*scene.volume);
  return scene;
}

SceneDescription SceneDescription::resolved(const Scene& scene) const {
  SceneDescription result = *this;
  if (proceduralName(input.volume)) result.input.resolution = input.resolution.value_or(glm::ivec3(kDefaultResolution));
  result.classification = resolvedClassification(classification, scene);
  result.emission = resolvedEmission(emission, scene);
  result.camera.frames.reset();
  if (!method.slice) {
    result.camera.look(scene.camera);
  } else if (!scene.classification.transferFunction) {  // labels and channels, of which these say nothing
    result.classification.densityScale.reset();
    result.classification.albedo.reset();
  }
  result.lighting = resolvedLighting(lighting, scene.lighting);
  result.method = resolvedMethod(method);
  return result;
}

SceneDescription SceneDescription::resolvedTurn(const Scene& scene, int frameCount) const {
  SceneDescription result = resolved(scene);
  if (camera.flight) result.camera = camera;
  result.camera.frames = frameCount;
  if (camera.position || camera.flight) return result;
  result.camera.position.reset();
  result.camera.lookAt = camera.lookAt;
  result.camera.orbit = camera.angles();
  return result;
}

std::vector<std::string> functionWarnings(const SceneDescription& description) {
  std::vector<std::string> all;
  const auto addFunction = [&](const std::string& function) {
    for (std::string& one : transferWarnings(function)) all.push_back(std::move(one));
  };
  const auto add = [&](const ClassificationDescription& classification) {
    if (classification.transferFunction) addFunction(*classification.transferFunction);
    for (const ChannelStyle& channel : classification.channels)
      if (!channel.function.empty()) addFunction(channel.function);
  };
  add(description.classification);
  for (const AddedVolume& added : description.added) add(added.classification);
  return all;
}

std::string rendererText(const SceneDescription& description, const Scene& scene) {
  SceneDescription resolved = description.resolved(scene);
  if (scene.classification.transferFunction) resolved.classification = {};
  const TableSettings table = description.method.table();
  std::string surfaces;  // which depend on the light's description, too
  for (const SceneVolume& added : scene.added) surfaces += fmt::format("{} ", added.surface.value_or(-1.0));
  return surfaces + fmt::format("{}table={} {} {} {}", textOf(resolved, {"classification", "emission", "volumes"}), int(table.directions),
                                int(table.code), int(table.filter), table.pathLengthCorrection);
}

}  // namespace freevoxels
