#include "engine/merged_drawing.h"

#include <algorithm>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/gathering/gather_rows.h"
#include "engine/splatting/accumulate_pass.h"
#include "engine/volume/content_hash.h"

namespace freevoxels {

/// One of the volumes, on the device.
struct MergedDrawing::Medium {
  std::shared_ptr<const Volume> volume;
  std::optional<double> surface;
  DeviceScene scene;
  std::optional<GatherVolume> gather = {};

  Medium(const Device& device, std::shared_ptr<const Volume> whole, const SceneVolume& of, const TableSettings& table,
         const Progress& progress)
      : volume(std::move(whole)), surface(of.surface), scene(device, *volume, of.classification, table, {}, progress) {}
};

namespace {

/// What contentHash() leaves out of how a volume looks.
std::string lookOf(const SceneVolume& volume) {
  const Classification& look = volume.classification;
  const Emission emission = look.emission.value_or(Emission{.strength = 0.0});
  return fmt::format(" {} {} {} {} {} {} {} {} {}", look.densityScale, look.albedo.r, look.albedo.g, look.albedo.b, int(look.order),
                     emission.strength, emission.temperatureScale, emission.temperatureOffset, volume.surface.value_or(-1.0));
}

}  // namespace

MergedDrawing::MergedDrawing(const Device& device, std::vector<SceneVolume> volumes, const TableSettings& table, const Progress& progress)
    : device_(device), pass_(device) {
  if (volumes.size() > std::size_t(shader::kMaxMerged))
    fail(ErrorKind::Usage, "a scene has at most {} volumes, and this one has {}: leave some out", shader::kMaxMerged, volumes.size());
  // Sums of floating-point numbers depend on their order: that of the volumes' contents, however the scene lists them.
  std::vector<std::pair<std::string, std::size_t>> order;
  std::vector<std::shared_ptr<const Volume>> wholes;
  for (const SceneVolume& volume : volumes) {
    wholes.push_back(volume.source->whole(progress));
    order.emplace_back(contentHash(*wholes.back(), volume.classification, nullptr) + lookOf(volume), wholes.size() - 1);
  }
  std::ranges::sort(order);
  for (const auto& [hash, i] : order) media_.emplace_back(device, std::move(wholes[i]), volumes[i], table, progress);
}

MergedDrawing::~MergedDrawing() = default;

void MergedDrawing::solveScattering(const Lighting& lighting, int coarseness, const Progress& progress) {
  scatters_ = hasScatteredLight(lighting, std::ranges::any_of(media_, [](const Medium& m) { return m.scene.built.volume.hasEmission(); }));
  if (!scatters_) return;
  if (!scattering_) {
    const StageTimer timer(times_, "scattering medium");
    std::vector<PlacedMedium> media;
    for (const Medium& medium : media_) media.push_back({medium.volume.get(), &medium.scene.classification});
    scattering_.emplace(device_, ScatteringMedium(media));
  }
  scattering_->solve(lighting, coarseness, times_, progress);
}

/// Sets the light of each volume's constants, of what is scattered by all of them.
void MergedDrawing::prepareLights(Frame& frame, std::span<const Lighting> lightings, const Progress& progress) {
  Lighting common = *frame.settings.lighting;
  for (const Lighting& lighting : lightings) common.surface = std::min(common.surface, lighting.surface);
  solveScattering(common, frame.settings.scatteringCoarseness, progress);
  for (std::size_t i = 0; i < media_.size(); ++i) {
    FrameSettings settings = frame.settings;
    settings.lighting = lightings[i];
    media_[i].scene.prepareOwnLights(settings, media_[i].scene.built.volume.scalarBricks.has_value(), frame.constants[i], progress);
    if (scatters_) setScattered(frame.constants[i], lightings[i], *scattering_);
  }
}

/// Appends the volume's constants, and its rays on a lattice of its own.
void MergedDrawing::prepareRays(Medium& medium, const Camera& camera, Frame& frame, const Progress& progress) {
  DeviceScene& scene = medium.scene;
  scene.frameTimes.clear();
  const auto constantsNow = [&] { return makeFrameConstants(device_, scene.built.volume, scene.tableSettings, camera, frame.settings); };
  FrameConstants constants = constantsNow();
  frame.rays.push_back(makeGatherFrame(scene.built.volume, camera, frame.settings, constants.detail, constants.endTransmittance));
  if (frame.rays.back().coarsest > 0 && !scene.built.hasBlocks()) {
    scene.builtWithBlocks(progress);
    constants = constantsNow();  // with the blocks' addresses
  }
  frame.rays.back().holdout = pass_.pass().holdOut(frame.settings.holdout);
  constants.detail.finest = frame.rays.back().finest;
  constants.detail.coarsest = frame.rays.back().coarsest;
  frame.constants.push_back(std::move(constants));
}

/// The volumes between a medium and its lights.
std::vector<ShadowingVolume> MergedDrawing::othersThan(const Medium& medium) const {
  std::vector<ShadowingVolume> others;
  for (const Medium& other : media_)
    if (const DeviceVolume& volume = other.scene.built.volume; &other != &medium)
      others.push_back({&other.scene.lights(), volume.scalarBricks.has_value(), volume.layout.dimensions, volume.indexToWorld});
  return others;
}

/// Makes what the rays of volume `i` read. `lighting` is null without lights.
void MergedDrawing::prepareVolume(std::size_t i, const Lighting* lighting, Frame& frame, const Progress& progress) {
  Medium& medium = media_[i];
  DeviceScene& scene = medium.scene;
  std::vector<ShadowingVolume> others;
  if (lighting != nullptr) others = othersThan(medium);
  shader::GatherFrame& rays = frame.rays[i];
  const GatherVolume::Shading shading{.frame = frame.constants[i],
                                      .table = nullptr,
                                      .lighting = lighting,
                                      .lights = lighting != nullptr ? &scene.lights() : nullptr,
                                      .scattered = lighting != nullptr ? scattered() : nullptr,
                                      .axes = {someRayHasAxis(rays, 0), someRayHasAxis(rays, 1), someRayHasAxis(rays, 2)},
                                      .keptQuadBytes = planKeptQuadBytes(device_) / media_.size(),
                                      .others = others};
  std::optional<GatherVolume>& gather = medium.gather;
  try {
    if (!gather) gather.emplace(device_, scene.classification, scene.built, scene.occupiedCells().met(), scene.frameTimes);
    gather->prepare(shading);
    Commands commands(device_);
    gather->record(commands, shading);
    if (!commands.empty()) scene.submit(commands, progress);
  } catch (...) {
    gather.reset();
    throw;
  }
  gather->describe(rays);
  frame.parts.push_back({&*gather, &scene.built.volume, rays});
}

MergedDrawing::Frame MergedDrawing::prepare(const Camera& camera, const FrameSettings& wanted, const Progress& progress) {
  checkCamera(camera);
  if (!wanted.gathers())
    fail(ErrorKind::Usage, "several volumes are drawn by gathering alone: leave out {} and other options of splats",
         Parameter("draw", "splats"));
  times_.clear();
  Frame frame{.settings = wanted};
  std::optional<Lighting>& lighting = frame.settings.lighting;
  if (lighting) lighting->attenuation = LightAttenuation::Exact;
  if (lighting && !GatherVolume::lightsSamples(&*lighting))
    fail(ErrorKind::Usage, "several volumes are lit by at most {} lights, and there are {}: use fewer, or {}", shader::kMaxSampleLights,
         lighting->lights.size(), Parameter("environment"));
  for (Medium& medium : media_) prepareRays(medium, camera, frame, progress);
  shareLattice(frame.rays, frame.settings);
  std::vector<Lighting> lightings;  // of each volume
  if (lighting) {
    lightings.assign(media_.size(), *lighting);
    for (std::size_t i = 0; i < media_.size(); ++i) lightings[i].surface = media_[i].surface.value_or(lightings[i].surface);
    prepareLights(frame, lightings, progress);
  }
  for (std::size_t i = 0; i < media_.size(); ++i) prepareVolume(i, lighting ? &lightings[i] : nullptr, frame, progress);
  return frame;
}

void MergedDrawing::submit(Commands& commands, const Progress& progress) {
  commands.submitAndWait(progress);
  addTimes(times_, commands.times());
}

std::shared_ptr<const FrameTargets> MergedDrawing::draw(const Camera& camera, const FrameSettings& settings, const Progress& progress) {
  const Frame frame = prepare(camera, settings, progress);
  Commands commands(device_);
  std::shared_ptr<const FrameTargets> targets = targetPool_.take(device_, frame.settings, TargetKind::Image);
  pass_.record(commands, frame.parts, camera, *targets);
  submit(commands, progress);
  return targets;
}

FixedSums MergedDrawing::shares(const Camera& camera, const FrameSettings& settings, const SharePart& part, const Progress& progress) {
  Frame frame = prepare(camera, settings, progress);
  const shader::GatherFrame& lattice = frame.parts.front().frame;
  FixedSums layout = sumsLayout(*frame.parts.front().onDevice, frame.constants.front(), frame.settings);
  for (std::size_t i = 1; i < frame.parts.size(); ++i) {
    const FixedSums other = sumsLayout(*frame.parts[i].onDevice, frame.constants[i], frame.settings);
    for (std::size_t c = 0; c < layout.digits.size(); ++c) layout.digits[c] = std::min(layout.digits[c], other.digits[c]);
  }
  FixedSums sums = sumsOfSamples(lattice, true, std::move(layout));
  const glm::ivec2 rows = rowsOfPart(lattice, part);
  if (rows.x == rows.y) return sums;
  for (MergedPass::Part& own : frame.parts) own.frame = frameOfRows(own.frame, rows);
  Commands commands(device_);
  pass_.recordSamples(commands, frame.parts, camera);
  submit(commands, progress);
  const StageTimer timer(times_, "copy to host");
  addSamples(sums, pass_.pass().downloadRows(rows), rows);
  return sums;
}

VolumeMemory MergedDrawing::memory() const {
  VolumeMemory sum;
  for (const Medium& medium : media_) {
    const VolumeMemory own = medium.scene.memory();
    sum.occupancy += own.occupancy;
    sum.extinction += own.extinction;
    sum.table += own.table;
    sum.colors += own.colors;
    sum.emission += own.emission;
    sum.lists += own.lists;
  }
  return sum;
}

std::vector<StageTime> MergedDrawing::buildTimings() const {
  std::vector<StageTime> times;
  for (const Medium& medium : media_) addTimes(times, medium.scene.buildTimes);
  return times;
}

std::vector<StageTime> MergedDrawing::frameTimings() const {
  std::vector<StageTime> times;
  for (const Medium& medium : media_) addTimes(times, medium.scene.frameTimes);
  addTimes(times, times_);
  return times;
}

}  // namespace freevoxels
