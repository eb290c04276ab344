#include "engine/renderer.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/error.h"
#include "engine/splatting/resolve_pass.h"
#include "engine/splatting/splat_pass.h"
#include "engine/splatting/visible_voxels.h"
#include "engine/volume/device_volume.h"

namespace freevoxels {

namespace {

/// Bytes of the largest buffer of voxels that the passes can bind.
std::uint64_t largestBinding(const Device& device) {
  const std::uint64_t texels = std::uint64_t(device.limits().maxTexelBufferElements) * sizeof(glm::vec4);
  return std::min({std::uint64_t(device.limits().maxStorageBufferRange), texels,
                   std::uint64_t(device.maximumAllocation())});
}

void checkFits(const Device& device, glm::ivec3 dimensions, DirectionSet directions) {
  const std::uint64_t binding = GridLayout(dimensions).paddedVoxels() * sizeof(float);
  if (binding > largestBinding(device))
    fail(ExitCode::OutOfMemory,
         "a volume of {}x{}x{} voxels needs a buffer of {} MiB and {} binds at most {} MiB: crop or resample "
         "the volume",
         dimensions.x, dimensions.y, dimensions.z, binding >> 20, device.description().name,
         largestBinding(device) >> 20);
  const std::uint64_t total = volumeMemory(dimensions, directions).total();
  if (total > device.description().memoryBytes)
    fail(ExitCode::OutOfMemory,
         "a volume of {}x{}x{} voxels with {} directions needs {} MiB of device memory and {} has {} MiB: "
         "crop "
         "or resample the volume{}",
         dimensions.x, dimensions.y, dimensions.z, directionCount(directions), total >> 20,
         device.description().name, device.description().memoryBytes >> 20,
         directions == DirectionSet::Directions26 ? "" : ", or take 26 directions");
}

/// Copies a target to the host through a read-back buffer; recorded with the frame, read after it.
class TargetReadback {
 public:
  TargetReadback(const Device& device, Commands& commands, const RenderTarget& target,
                 std::size_t bytesPerPixel)
      : buffer_(device, std::uint64_t(target.size().x) * std::uint64_t(target.size().y) * bytesPerPixel,
                MemoryUse::Readback, "picture") {
    commands.copy(target, buffer_);
  }
  template <typename Pixel>
  std::vector<Pixel> read() const {
    std::vector<Pixel> pixels(buffer_.bytes() / sizeof(Pixel));
    std::memcpy(pixels.data(), buffer_.mapped(), buffer_.bytes());
    return pixels;
  }

 private:
  Buffer buffer_;
};

}  // namespace

VolumeMemory volumeMemory(glm::ivec3 dimensions, DirectionSet directions) {
  const std::uint64_t voxels = GridLayout(dimensions).paddedVoxels();
  return {.scalars = voxels * sizeof(float),
          .extinction = voxels * sizeof(float),
          .table = voxels * std::uint64_t(directionCount(directions)),
          .visibleVoxels = voxels * sizeof(std::uint32_t)};
}

std::uint64_t maximumVoxels(const Device& device, DirectionSet directions) {
  const glm::ivec3 row(shader::kRowAlignment, 1, 1);
  const std::uint64_t bytesPerVoxel = volumeMemory(row, directions).total() / shader::kRowAlignment;
  return std::min(largestBinding(device) / sizeof(float), device.description().memoryBytes / bytesPerVoxel);
}

struct Renderer::State {
  const Device& device;
  TableSettings tableSettings;
  DeviceVolume volume;
  AttenuationTable table;
  VisibleVoxels visible;
  std::unique_ptr<SplatPass> splats;
  std::unique_ptr<ResolvePass> resolve;
  std::vector<StageTime> buildTimes, frameTimes;
};

Renderer::Renderer(const Device& device, const Volume& volume, const Classification& classification,
                   const TableSettings& table, const Progress& progress) {
  checkFits(device, volume.dimensions, table.directions);
  state_ = std::make_unique<State>(State{.device = device, .tableSettings = table});
  {
    const StageTimer timer(state_->buildTimes, "upload");
    state_->volume = uploadVolume(device, volume, classification);
    state_->table = makeTable(device, state_->volume.layout, table);
    state_->visible = makeVisibleVoxels(device, state_->volume);
  }
  const ClassifyPass classify(device);
  const AttenuationSweep sweep(device, table);
  const CompactionPass compaction(device);
  Commands commands(device);
  classify.record(commands, state_->volume, classification);
  sweep.record(commands, state_->volume, state_->table);
  compaction.record(commands, state_->volume, state_->visible);
  commands.submitAndWait(progress);
  std::ranges::copy(commands.times(), std::back_inserter(state_->buildTimes));
}

Renderer::~Renderer() = default;

Image Renderer::render(const Camera& camera, const FrameSettings& settings, const Progress& progress) {
  checkCamera(camera);
  checkFrameFits(state_->device, settings);
  State& state = *state_;
  state.frameTimes.clear();
  if (!state.splats || state.splats->withDistance() != settings.depth) {
    state.splats = std::make_unique<SplatPass>(state.device, settings.depth);
    state.resolve = std::make_unique<ResolvePass>(state.device, settings.depth);
  }
  const SplatTargets targets = makeTargets(state.device, settings);
  const FrameConstants frame =
      makeFrameConstants(state.device, state.volume, state.tableSettings, camera, settings);

  Commands commands(state.device);
  state.splats->record(commands, {state.volume, state.table, state.visible}, frame, targets);
  state.resolve->record(commands, frame, targets);
  commands.beginPass("read back");
  const TargetReadback color(state.device, commands, targets.colorEnergy, sizeof(glm::vec4));
  std::unique_ptr<TargetReadback> depth;
  if (settings.depth)
    depth = std::make_unique<TargetReadback>(state.device, commands, targets.distance, sizeof(float));
  commands.submitAndWait(progress);
  state.frameTimes = commands.times();

  const StageTimer timer(state.frameTimes, "copy to host");
  return {.size = settings.size,
          .pixels = color.read<glm::vec4>(),
          .depth = depth ? depth->read<float>() : std::vector<float>()};
}

std::vector<StageTime> Renderer::timings() const {
  std::vector<StageTime> times = state_->buildTimes;
  std::ranges::copy(state_->frameTimes, std::back_inserter(times));
  return times;
}

std::uint64_t Renderer::visibleVoxelCount() const {
  return downloadVisibleCount(state_->device, state_->visible);
}

std::vector<std::vector<std::uint8_t>> Renderer::downloadTable() const {
  return freevoxels::downloadTable(state_->device, state_->volume.layout, state_->table);
}

std::vector<std::uint32_t> Renderer::downloadVisibleVoxels() const {
  const GridLayout& layout = state_->volume.layout;
  std::vector<std::uint32_t> voxels(visibleVoxelCount());
  download(state_->device, state_->visible.indices, std::as_writable_bytes(std::span(voxels)));
  for (std::uint32_t& voxel : voxels)
    voxel -= voxel / std::uint32_t(layout.rowPitch) * std::uint32_t(layout.rowPitch - layout.dimensions.x);
  return voxels;
}

}  // namespace freevoxels
