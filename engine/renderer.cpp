#include "engine/renderer.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/core/parameter.h"
#include "engine/cube_drawing.h"
#include "engine/merged_drawing.h"
#include "engine/octree/volume_limits.h"
#include "engine/renderer_state.h"

namespace freevoxels {

namespace {

/// Whether the volume is certainly too large for the device, or what is read of it for this machine. Of one in memory, of which transparent
/// voxels take nothing, only the box tells.
bool exceeds(const Device& device, const VolumeSource& source, bool emits) {
  const Volume& outline = source.outline();
  if (source.isInMemory()) return outline.voxelCount() > maximumVoxels(device);
  const std::uint64_t active = outline.activeVoxels;
  return active > machineMemoryBytes() / 2 / sizeof(float) ||
         exceedsDevice(device.memoryBytes(), maximumVoxels(device), outline.dimensions, active) ||
         leastGatherBytes(brickVoxels(source), outline.dimensions, outline.indexToWorld, nullptr, emits) > device.memoryBytes();
}

const SceneVolume& firstOf(const std::vector<SceneVolume>& volumes) {
  FV_CHECK_LT(std::size_t(0), volumes.size());
  return volumes.front();
}

/// Instead of making blocks of a volume whose voxels cannot be numbered.
[[noreturn]] void failUnnumbered(const Volume& outline, const std::string& whyNotCubes) {
  const glm::ivec3 box = outline.dimensions;
  fail(ErrorKind::OutOfMemory,
       "a volume of {}x{}x{} voxels, {} of which have data, is drawn piece by piece alone, as no more than {} voxels can be numbered, and "
       "{}: draw it by gathering with other shadows, or crop or resample it",
       box.x, box.y, box.z, outline.activeVoxels, kMaxNumberedVoxels, whyNotCubes);
}

/// Instead of reading a file whose volume cannot be held.
[[noreturn]] void failTooLarge(const Device& device, const Volume& outline, const std::string& whyNotCubes) {
  const glm::ivec3 box = outline.dimensions;
  fail(ErrorKind::OutOfMemory,
       "a volume of {}x{}x{} voxels, {} million of them with data, needs more than the {} MiB of device memory or half of the {} MiB of "
       "this machine: raise {}, or crop or resample the volume; it cannot be drawn piece by piece, as {}",
       box.x, box.y, box.z, outline.activeVoxels / 1000000, device.memoryBytes() >> 20, machineMemoryBytes() >> 20,
       Parameter("memory-limit"), whyNotCubes);
}

}  // namespace

Renderer::Renderer(const Device& device, std::shared_ptr<const VolumeSource> source, const Classification& classification,
                   const TableSettings& table, const Progress& progress)
    : device_(device), source_(std::move(source)), classification_(classification), table_(table) {
  if (!source_) return;  // several
  isTooLarge_ = inCubes_ = exceeds(device, *source_, classification.emission.has_value());
  if (isTooLarge_) return;
  try {
    whole(progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::OutOfMemory) throw;
    inCubes_ = true;
  }
}

Renderer::Renderer(const Device& device, const Volume& volume, const Classification& classification, const TableSettings& table,
                   const Progress& progress)
    : Renderer(device, std::make_shared<const VolumeInMemory>(std::shared_ptr<const Volume>(std::shared_ptr<const Volume>(), &volume)),
               classification, table, progress) {}

Renderer::Renderer(const Device& device, std::vector<SceneVolume> volumes, const TableSettings& table, const Progress& progress)
    : Renderer(device, volumes.size() == 1 ? volumes.front().source : nullptr, firstOf(volumes).classification, table, progress) {
  if (volumes.size() > 1) merged_ = std::make_unique<MergedDrawing>(device, std::move(volumes), table, progress);
}

Renderer::~Renderer() = default;

/// The volume as a whole.
Renderer::State& Renderer::whole(const Progress& progress) {
  if (state_) return *state_;
  cubes_.reset();
  builtInFrame_ = true;
  std::vector<StageTime> times;
  if (!volume_ && source_->isInMemory()) volume_ = source_->whole();
  if (!volume_) {
    const StageTimer timer(times, "read volume");
    volume_ = source_->whole(progress);
  }
  state_.reset(new State{.scene = {device_, *volume_, classification_, table_, std::move(times), progress}});
  return *state_;
}

CubeDrawing& Renderer::cubes() {
  state_.reset();
  volume_.reset();
  if (!cubes_) cubes_ = std::make_unique<CubeDrawing>(device_, source_, classification_, table_);
  return *cubes_;
}

bool Renderer::reclassify(const Classification& classification) {
  if (!state_ || !state_->reclassify(classification)) return false;
  classification_ = classification;
  return true;
}

bool Renderer::surelyFits(const FrameSettings& settings) const {
  if (merged_ || CubeDrawing::whyNot(settings)) return true;
  const Volume& outline = source_->outline();
  constexpr std::uint64_t kMargin = 2;  // for what the least does not count: blocks and images
  return !inCubes_ && kMargin * leastGatherBytes(brickVoxels(*source_), outline.dimensions, outline.indexToWorld,
                                                 settings.lighting ? &*settings.lighting : nullptr, classification_.emission.has_value()) <=
                          device_.memoryBytes();
}

void Renderer::requireCubes() {
  inCubes_ = true;
}

/// `error`, which a frame of the whole volume failed with, or where the device's memory is limited a sentence with what that needs; and why
/// it is not drawn cube by cube.
Error Renderer::withNeed(const Error& error, const FrameSettings& settings, const std::string& whyNotCubes) const {
  const Error whole = volume_ ? withWholeNeed(error, device_, *volume_, classification_, table_.directions, settings) : error;
  if (whyNotCubes.empty()) return whole;
  return Error(ErrorKind::OutOfMemory, fmt::format("{}; it cannot be drawn piece by piece, as {}", whole.text(), whyNotCubes));
}

/// Draws a frame of the whole volume, or cube by cube if that is too large for the device. Where it can be drawn cube by cube, nothing is
/// drawn otherwise for lack of memory, so that the image does not depend on it. `mayChange` says whether lack of memory may change the way.
template <typename DrawWhole, typename DrawCubes>
auto Renderer::draw(const Camera& camera, const FrameSettings& settings, bool mayChange, const Progress& progress,
                    const DrawWhole& drawWhole, const DrawCubes& drawCubes) {
  builtInFrame_ = false;
  const std::optional<std::string> whyNotCubes = CubeDrawing::whyNot(settings);
  try {
    checkFrameFits(device_, settings);
  } catch (const Error& error) {
    if (whyNotCubes) throw withNeed(error, settings, *whyNotCubes);
    throw CubeDrawing(device_, source_, classification_, table_).withNeed(error, camera, settings);
  }
  drewInCubes_ = inCubes_ && !whyNotCubes;
  if (!drewInCubes_) {
    if (isTooLarge_ && source_->outline().voxelCount() > kMaxNumberedVoxels) failUnnumbered(source_->outline(), *whyNotCubes);
    if (isTooLarge_ && !source_->isInMemory()) failTooLarge(device_, source_->outline(), *whyNotCubes);
    try {
      return drawWhole(whole(progress));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::OutOfMemory) throw;
      if (whyNotCubes || !mayChange) throw withNeed(error, settings, whyNotCubes.value_or(""));
    }
    inCubes_ = drewInCubes_ = true;
  }
  return drawCubes(cubes());
}

void Renderer::check(const Camera& camera, const FrameSettings& settings) const {
  checkCamera(camera);
  if (settings.holdout) {
    if (!settings.gathers()) failHoldoutOfSplats();
    checkHoldoutSize(*settings.holdout, settings.size);
  }
  FV_CHECK_EQ(settings.clip && (!settings.gathers() || merged_), false);
  if (!settings.isProjected()) return;
  FV_CHECK_EQ(settings.lod, 0.0f);
  if (merged_)
    fail(ErrorKind::Usage, "{} projects the values of one volume, and there are several: draw each for itself", Parameter("mode"));
  if (!classification_.isPost(source_->outline()))
    fail(ErrorKind::Usage, "{} needs values that a transfer function is applied to after interpolation, and {} has none", Parameter("mode"),
         source_->outline().source);
  if (settings.lighting) fail(ErrorKind::Usage, "{} shows values, on which no light shines: leave the lights out", Parameter("mode"));
}

Image Renderer::render(const Camera& camera, const FrameSettings& settings, const Progress& progress) {
  check(camera, settings);
  if (merged_) return downloadImage(device_, *merged_->draw(camera, settings, progress));
  const auto drawWhole = [&](State& state) {
    Commands commands(device_);
    const std::shared_ptr<const FrameTargets> targets = state.record(commands, camera, settings, progress);
    commands.beginPass("read back");
    state.colorReadback.record(device_, commands, targets->colorEnergy);
    if (settings.depth) state.distanceReadback.record(device_, commands, targets->distance);
    state.submit(commands, progress);
    const StageTimer timer(state.scene.frameTimes, "copy to host");
    return Image{.size = settings.size,
                 .pixels = state.colorReadback.read<glm::vec4>(),
                 .depth = settings.depth ? state.distanceReadback.read<float>() : std::vector<float>()};
  };
  const auto drawCubes = [&](CubeDrawing& drawing) { return downloadImage(device_, *drawing.draw(camera, settings, progress)); };
  return draw(camera, settings, true, progress, drawWhole, drawCubes);
}

std::shared_ptr<const FrameTargets> Renderer::renderOnDevice(const Camera& camera, const FrameSettings& settings,
                                                             const Progress& progress) {
  check(camera, settings);
  if (merged_) return merged_->draw(camera, settings, progress);
  const auto drawWhole = [&](State& state) {
    Commands commands(device_);
    std::shared_ptr<const FrameTargets> targets = state.record(commands, camera, settings, progress);
    state.submit(commands, progress);
    return targets;
  };
  const auto drawCubes = [&](CubeDrawing& drawing) { return drawing.draw(camera, settings, progress); };
  return draw(camera, settings, true, progress, drawWhole, drawCubes);
}

FixedSums Renderer::renderShares(const Camera& camera, const FrameSettings& wanted, const SharePart& part, const Progress& progress) {
  FV_CHECK_EQ(wanted.isSorted(), false);
  FV_CHECK_LT(part.index, part.count);
  FV_CHECK_LE(part.count, kShares);
  check(camera, wanted);
  if (merged_) return merged_->shares(camera, wanted, part, progress);
  FrameSettings settings = wanted;
  if (!settings.gathers()) settings.splats().cullThreshold = 0.0f;  // what hides a splat may be another part's
  const auto drawWhole = [&](State& state) { return state.shares(camera, settings, part, progress); };
  const auto drawCubes = [&](CubeDrawing& drawing) { return drawing.drawShares(camera, settings, part, progress); };
  return draw(camera, settings, false, progress, drawWhole, drawCubes);
}

VolumeMemory Renderer::memory() const {
  if (merged_) return merged_->memory();
  return state_ ? state_->scene.memory() : cubes_ ? cubes_->memory() : VolumeMemory();
}

std::vector<StageTime> Renderer::buildTimings() const {
  if (merged_) return merged_->buildTimings();
  return state_ ? state_->scene.buildTimes : std::vector<StageTime>();
}

std::vector<StageTime> Renderer::frameTimings() const {
  if (merged_) return merged_->frameTimings();
  if (!state_) return cubes_ ? cubes_->timings() : std::vector<StageTime>();
  return builtInFrame_ ? timings() : state_->scene.frameTimes;
}

std::vector<StageTime> Renderer::timings() const {
  if (!state_ && !merged_) return frameTimings();
  std::vector<StageTime> times = buildTimings();
  std::ranges::copy(merged_ ? merged_->frameTimings() : state_->scene.frameTimes, std::back_inserter(times));
  return times;
}

std::vector<std::size_t> Renderer::cubesRead() const {
  return drewInCubes_ && cubes_ ? cubes_->cubesRead() : std::vector<std::size_t>();
}

std::optional<std::uint64_t> Renderer::occupiedVoxelCount() const {
  if (!state_ || !state_->scene.built.hasBlocks()) return {};
  return state_->scene.built.volume.stored.front();
}

std::optional<ScatteringFacts> Renderer::scattering() const {
  const ScatteringSolver* const solver = merged_  ? merged_->scattered()
                                         : state_ ? state_->scene.scattered()
                                         : cubes_ ? cubes_->scattered()
                                                  : nullptr;
  return solver != nullptr ? std::optional(solver->facts()) : std::nullopt;
}

CutCounts Renderer::cutCounts() const {
  return state_ ? state_->splats.counts() : CutCounts();
}

}  // namespace freevoxels
