#include "engine/hierarchy/volume_builder.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "embedded/pack_voxels.h"
#include "engine/hierarchy/occupancy.h"
#include "engine/hierarchy/volume_memory.h"

namespace freevoxels {

namespace {

/// COMPUTE pack_voxels.comp
class PackPass {
 public:
  PackPass(const Device& device, bool scalars)
      : pipeline_(makeComputePipeline(device, {pack_voxels_spv, "pack voxels"},
                                      {.bindings = std::vector(5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                                       .pushConstantBytes = sizeof(shader::VoxelsPush)},
                                      {shader::kOccupancyThreads, 1, 1}, {scalars ? 1u : 0u})) {}
  void record(Commands& commands, const BuiltVolume& built, const DenseVoxels& voxels) const {
    const DeviceVolume& volume = built.volume;
    const shader::VoxelsPush push{.count = std::uint32_t(volume.stored.front())};
    const std::array<Binding, 5> bindings{&built.visible.indices, &voxels.extinction, &voxels.scalars,
                                          &volume.extinction,
                                          volume.hasColors() ? &volume.scalars : &volume.extinction};
    commands.beginPass("pack");
    commands.dispatchLinear(pipeline_, bindings, push, push.count);
    commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  }

 private:
  Pipeline pipeline_;
};

void run(Commands& commands, const Progress& progress, std::vector<StageTime>& times) {
  commands.submitAndWait(progress);
  std::ranges::copy(commands.times(), std::back_inserter(times));
}

/// A buffer is bound whether or not anything is stored in it.
Buffer makeStore(const Device& device, std::uint64_t values, std::uint64_t bytes, const char* name) {
  return Buffer(device, std::max<std::uint64_t>(values, 1) * bytes, MemoryUse::Device, name);
}

void makeStores(const Device& device, DeviceVolume& volume) {
  const std::uint64_t blocks = volume.storedBlocks(), voxels = volume.stored.front();
  volume.extinction = makeStore(device, blocks, sizeof(float), "extinction");
  if (!volume.hasColors()) return;
  volume.scalars = makeStore(device, voxels, sizeof(float), "scalars");
  volume.blockColors = makeStore(device, blocks - voxels, sizeof(glm::uvec2), "block colours");
}

}  // namespace

BuiltVolume buildVolume(const Device& device, const Volume& volume, const Classification& classification,
                        std::vector<StageTime>& times, const Progress& progress) {
  checkBoxFits(device, HierarchyLayout(volume.dimensions));
  BuiltVolume built{.volume = makeDeviceVolume(device, volume, classification)};
  DeviceVolume& onDevice = built.volume;
  DenseVoxels voxels;
  {
    const StageTimer timer(times, "upload");
    voxels = uploadVoxels(device, volume, onDevice.hierarchy);
  }
  const ClassifyPass classify(device);
  const OccupancyPass occupancy(device);
  const CompactionPass compaction(device);
  Commands first(device);
  classify.record(first, onDevice, voxels, classification);
  occupancy.record(first, onDevice, voxels);
  built.visible = makeVisibleVoxels(device, onDevice);
  compaction.record(first, onDevice, built.visible);
  for (int level = 1; level <= onDevice.hierarchy.top(); ++level) {
    built.lists.coarse.push_back(makeVisibleVoxels(device, onDevice, level));
    compaction.record(first, onDevice, built.lists.coarse.back(), level);
  }
  run(first, progress, times);

  onDevice.stored.push_back(downloadVisibleCount(device, built.visible));
  for (const VisibleVoxels& level : built.lists.coarse)
    onDevice.stored.push_back(downloadVisibleCount(device, level));
  checkStoresFit(device, onDevice);
  makeStores(device, onDevice);
  if (onDevice.stored.front() == 0) return built;
  const PackPass pack(device, onDevice.hasColors());
  const MediumLevels levels(device, onDevice);
  Commands second(device);
  pack.record(second, built, voxels);
  levels.record(second, onDevice, built.lists.coarse);
  run(second, progress, times);
  return built;
}

}  // namespace freevoxels
