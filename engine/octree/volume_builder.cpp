#include "engine/octree/volume_builder.h"

#include <algorithm>
#include <array>
#include <span>

#include "embedded/pack_voxels.h"
#include "engine/core/error.h"
#include "engine/octree/device_bricks.h"
#include "engine/octree/occupancy.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

namespace {

/// COMPUTE pack_voxels.comp
class PackPass {
 public:
  PackPass(const Device& device, const DeviceVolume& volume)
      : pipeline_(makeComputePipeline(device, shaders::pack_voxels, {volume.hasEmission(), volume.hasColors})) {}
  void record(Commands& commands, const DeviceVolume& volume, const DeviceBricks& bricks) const {
    const std::array<Binding, 5> bindings{&bricks.scalars(), &bricks.firstVoxels(), &bricks.emissions(), &volume.occupancy,
                                          &bricks.colors()};
    const shader::BricksPush push = bricks.push();
    commands.beginPass("pack");
    commands.dispatchLinear(pipeline_, bindings, push,
                            std::uint64_t(push.brickCount) * shader::kBrickThreads);
    commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  }

 private:
  Pipeline pipeline_;
};

/// A buffer for `values` values, or for one if there are none, since bindings need a buffer.
Buffer makeStore(const Device& device, std::uint64_t values, std::uint64_t bytes, const char* name) {
  return Buffer(device, std::max<std::uint64_t>(values, 1) * bytes, MemoryUse::Device, name);
}

void makeStores(const Device& device, DeviceVolume& volume) {
  const std::uint64_t blocks = volume.storedBlocks(), voxels = volume.stored.front();
  volume.extinction = Buffer(device, extinctionBytes(blocks), MemoryUse::Device, "extinction",
                             VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  volume.extinctionQuads = TexelView(device, volume.extinction);
  if (volume.hasEmission()) volume.emission = makeStore(device, blocks, sizeof(std::uint32_t), "emission");
  if (!volume.hasColors) return;
  volume.colors = makeStore(device, voxels, sizeof(std::uint32_t), "colours");
  volume.blockColors = makeStore(device, blocks - voxels, sizeof(glm::uvec2), "block colours");
}

class BlockBuilder {
 public:
  BlockBuilder(const Device& device, const Volume& volume, const Classification& classification, BuiltVolume& built,
               std::vector<StageTime>& times, const Progress& progress, BuiltLevels levels)
      : device_(device),
        times_(times),
        progress_(progress),
        built_(built),
        levels_(levels),
        bricks_(device, built_.volume, volume, classification) {}

  void run() {
    findOccupancy();
    checkStoresFit(device_, built_.volume);
    makeStores(device_, built_.volume);
    if (built_.volume.stored.front() > 0) store();
  }

 private:
  /// Finds the occupied blocks of all levels, lists them and ranks them.
  void findOccupancy() {
    const DeviceVolume& volume = built_.volume;
    const OccupancyPass occupancy(device_, volume.hasEmission(), levelDispatches(device_));
    const CompactionPass compaction(device_);
    forEachBatch([&](Commands& commands, std::size_t batch) {
      occupancy.recordVoxels(commands, volume, bricks_, batch == 0);
    });
    const std::size_t levels = levels_ == BuiltLevels::All ? volume.hierarchy.levels.size() : 1;
    built_.lists.coarse.resize(levels - 1);
    std::vector<BlockList*> lists{&built_.visible};
    for (BlockList& list : built_.lists.coarse) lists.push_back(&list);
    std::vector<std::uint32_t> counts(levels);
    const Buffer totals(device_, levels * sizeof(std::uint32_t), MemoryUse::Device, "block counts");
    Commands counting(device_);
    if (levels > 1) {
      built_.lists.steps = makeLevelSteps(device_);
      uploadLevelSteps(device_, built_.lists.steps, volume, {});
      occupancy.recordBlocks(counting, volume, built_.lists.steps);
    }
    compaction.recordCounts(counting, volume, lists, totals);
    submit(counting);
    download(device_, totals, std::as_writable_bytes(std::span(counts)));
    for (std::size_t level = 0; level < levels; ++level) compaction.allocate(*lists[level], counts[level]);
    Commands listing(device_);
    compaction.recordLists(listing, volume, lists);
    submit(listing);
    built_.volume.stored.assign(counts.begin(), counts.end());
    built_.volume.stored.resize(volume.hierarchy.levels.size(), 0);
    if (levels > 1) uploadLevelSteps(device_, built_.lists.steps, volume, built_.lists.coarse);
  }

  /// Stores the medium of every occupied block.
  void store() {
    const DeviceVolume& volume = built_.volume;
    const PackPass pack(device_, volume);
    forEachBatch([&](Commands& commands, std::size_t) { pack.record(commands, volume, bricks_); });
    if (levels_ == BuiltLevels::Voxels) return;
    const MediumLevels levels(device_, volume, levelDispatches(device_));
    Commands commands(device_);
    levels.record(commands, volume, built_.lists.steps);
    submit(commands);
  }

  template <typename Record>
  void forEachBatch(const Record& record) {
    for (std::size_t batch = 0; batch < bricks_.batches(); ++batch) {
      {
        const StageTimer timer(times_, "upload");
        bricks_.upload(batch);
      }
      Commands commands(device_);
      record(commands, batch);
      submit(commands);
    }
  }

  void submit(Commands& commands) {
    commands.submitAndWait(progress_);
    addTimes(times_, commands.times());
  }

  const Device& device_;
  std::vector<StageTime>& times_;
  const Progress& progress_;
  BuiltVolume& built_;
  BuiltLevels levels_;
  DeviceBricks bricks_;
};

}  // namespace

BuiltVolume buildVolume(const Device& device, const Volume& volume, const Classification& classification,
                        std::vector<StageTime>& times, const Progress& progress, BuiltLevels levels) {
  checkBoxFits(device, HierarchyLayout(volume.dimensions));
  BuiltVolume built{.volume = makeDeviceVolume(device, volume, classification)};
  if (classification.isPost(volume)) {
    const StageTimer timer(times, "scalars");
    try {
      built.volume.scalarBricks =
          uploadScalars(device, volume, *classification.transferFunction, kStoredDepth * built.volume.voxelSize);
    } catch (const Error& error) {  // only the gather needs the scalars, and it reports that they are missing
      if (error.kind() != ErrorKind::OutOfMemory) throw;
      built.volume.lacksScalarBricks = true;
    }
  } else {
    buildBlocks(device, volume, classification, built, times, progress, levels);
  }
  return built;
}

void buildBlocks(const Device& device, const Volume& volume, const Classification& classification, BuiltVolume& built,
                 std::vector<StageTime>& times, const Progress& progress, BuiltLevels levels) {
  try {
    BlockBuilder(device, volume, classification, built, times, progress, levels).run();
  } catch (...) {
    built.volume.stored.clear();
    built.lists = {};
    throw;
  }
}

}  // namespace freevoxels
