#include "engine/region_renderer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/lighting/light_pass.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/volume_builder.h"
#include "engine/scene/footprint.h"
#include "engine/splatting/accumulate_pass.h"
#include "engine/splatting/splat_pass.h"

namespace freevoxels {

namespace {

using fvx::FvxFile;
using fvx::RegionEntry;

constexpr int kRegionLevels = 6;  // a region covers a block of this many levels above its voxels
static_assert(fvx::kRegionEdge == 1 << kRegionLevels);

/// A level is drawn where the edge of its voxels is at most lod / kLodDivisor pixels: a voxel of a coarse level stands for less than a
/// splatted block of the same size, which is drawn at its centre of mass.
constexpr double kLodDivisor = 2.0;

/// A region that is on the device.
struct DeviceRegion {
  BuiltVolume built;
  AttenuationTable table;
  BlockList drawn;  ///< the occupied voxels without those of the halo
  std::uint64_t drawnVoxels = 0;
  LightPass lights;
};

/// Table look-ups alone, of voxels.
FrameSettings regionSettings(const FrameSettings& wanted) {
  FrameSettings settings = wanted;
  settings.draw = Draw::Splats;
  settings.cullThreshold = 0.0f;
  settings.lod = 0.0f;
  if (settings.attenuation == AttenuationLookup::Auto) settings.attenuation = AttenuationLookup::Bilinear;
  if (settings.lighting) settings.lighting->attenuation = LightAttenuation::Table;
  return settings;
}

/// Which regions a frame draws.
class RegionChoice {
 public:
  RegionChoice(const FvxFile& file, const DeviceVolume& outline, const Camera& camera, const FrameSettings& settings)
      : file_(file), middle_(0.5 * glm::dvec3(outline.layout.dimensions - 1)), levels_(std::size_t(file.levels())) {
    const PixelRays rays = pixelRays(camera, settings.size, outline.indexToWorld);
    orthographic_ = rays.orthographic;
    rule_ = detailRule(outline.hierarchy, rays, settings.size, double(settings.lod) / kLodDivisor);
    cull_ = cullRule(outline.layout.dimensions, rays, settings);
    for (int level = 0; level < file.levels(); ++level)
      for (const RegionEntry& region : file.regions(level)) known_[key(level, region.cell)] = &region;
    const int top = file.levels() - 1;
    const glm::ivec3 cells = fvx::regionCells(file.dimensions(top));
    for (glm::ivec3 cell(0); cell.z < cells.z; ++cell.z)
      for (cell.y = 0; cell.y < cells.y; ++cell.y)
        for (cell.x = 0; cell.x < cells.x; ++cell.x) choose(top, cell);
    for (auto& level : levels_) std::ranges::sort(level);
  }

  /// By level, in the order of the file.
  const std::vector<std::vector<const RegionEntry*>>& levels() const { return levels_; }

 private:
  static std::uint64_t key(int level, glm::ivec3 cell) {
    const glm::u64vec3 c(cell);
    return c.x | c.y << 16 | c.z << 32 | std::uint64_t(level) << 48;
  }

  void choose(int level, glm::ivec3 cell) {
    const auto found = known_.find(key(level, cell));
    if (found == known_.end()) return;
    const Block covered{.level = level + kRegionLevels, .cell = cell};
    if (isOutside(covered, level)) return;
    if (level == 0 || isFine(covered, level)) {
      levels_[std::size_t(level)].push_back(found->second);
      return;
    }
    for (int child = 0; child < 8; ++child) choose(level - 1, 2 * cell + glm::ivec3(child & 1, child >> 1 & 1, child >> 2));
  }

  bool isFine(const Block& covered, int level) const {
    if (orthographic_) return level <= rule_.coarsest;
    return double(1 << level) <= rule_.edgePerDistance * rule_.nearestDistance(covered);
  }

  /// Whether no kernel of the region's voxels reaches the image.
  bool isOutside(const Block& covered, int level) const {
    if (!cull_.outside) return false;
    const glm::dvec3 half(0.5 * covered.edge() + kFootprintRadius * double(1 << level));
    const glm::dvec3 centre = (glm::dvec3(covered.cell) + 0.5) * double(covered.edge()) - 0.5 - middle_;
    return std::ranges::any_of(cull_.planes, [&](const glm::dvec4& plane) {
      return glm::dot(glm::dvec3(plane), centre) + plane.w + glm::dot(glm::abs(glm::dvec3(plane)), half) < 0.0;
    });
  }

  const FvxFile& file_;
  glm::dvec3 middle_;
  bool orthographic_ = false;
  DetailRule rule_;
  CullRule cull_;
  std::unordered_map<std::uint64_t, const RegionEntry*> known_;
  std::vector<std::vector<const RegionEntry*>> levels_;
};

/// The regions of a part by share, and within a share by level, as splats of one level have the same units.
using RegionBatches = std::map<std::pair<int, int>, std::vector<const RegionEntry*>>;

RegionBatches batchesOf(const FvxFile& file, const RegionChoice& choice, const SharePart& part, RegionRenderer::Counts& counts) {
  RegionBatches batches;
  counts = {.drawn = std::vector<std::size_t>(choice.levels().size())};
  for (int level = 0; level < file.levels(); ++level)
    for (const RegionEntry* region : choice.levels()[std::size_t(level)]) {
      const int share = shareOf(std::uint64_t(region - file.regions(level).data()));
      if (!part.holds(share)) continue;
      batches[{share, level}].push_back(region);
      ++counts.drawn[std::size_t(level)];
    }
  return batches;
}

/// Kernels of coarse levels reach farther beyond the box than those of voxels.
void widenCovered(FrameConstants& frame, const FrameSettings& settings) {
  const int margin = int(std::ceil(3.0f * std::max(settings.lod, 1.0f))) + 2;
  const glm::ivec2 end = glm::min(frame.coveredFirst + frame.coveredExtent + margin, settings.size);
  frame.coveredFirst = glm::max(frame.coveredFirst - margin, 0);
  frame.coveredExtent = end - frame.coveredFirst;
}

}  // namespace

struct RegionRenderer::State {
  const Device& device;
  std::shared_ptr<const FvxFile> file;
  Classification classification;
  TableSettings tableSettings;
  bool keepsRegions;
  Volume outline = bakedOutline(*file);
  DeviceVolume outlineVolume = outlineOnDevice(outline, classification);
  AttenuationSweep sweep{device, tableSettings, sweepStyle(device), true};
  std::unique_ptr<SplatPass> splats;
  std::unique_ptr<AccumulatePass> accumulate;
  TargetPool targetPool;
  std::map<const RegionEntry*, std::unique_ptr<DeviceRegion>> kept;
  std::vector<StageTime> times;
  Counts counts;

  std::unique_ptr<DeviceRegion> load(const RegionEntry& region);
  BlockList listDrawn(const BuiltVolume& built, const fvx::VoxelBox& own, std::uint64_t& count) const;
  DeviceRegion& onDevice(const RegionEntry& region);
  void makeRoom();
  VolumeMemory memoryOfLargest() const;

  struct FrameInProgress {
    const Camera& camera;
    const FrameSettings& settings;
    const FrameTargets& targets;
    bool drawn = false;  ///< whether the targets have been drawn to, and therefore cleared
  };
  void draw(FrameInProgress& frame, const RegionEntry& region, bool addToSums);
};

/// Reads a region and sweeps its table.
std::unique_ptr<DeviceRegion> RegionRenderer::State::load(const RegionEntry& entry) {
  BakedRegion region;
  {
    const StageTimer timer(times, "read regions");
    region = readBakedRegion(*file, entry);
  }
  BuiltVolume built = buildVolume(device, region.volume, classification, times);
  AttenuationTable table = makeTable(device, built.volume, tableSettings);
  {
    const DeviceEntryDepths depths(device, region.volume.dimensions, region.depths);
    Commands commands(device);
    sweep.record(commands, built.volume, table, depths);
    commands.submitAndWait();
    addTimes(times, commands.times());
  }
  std::uint64_t count = 0;
  BlockList drawn = listDrawn(built, region.own, count);
  ++counts.read;
  return std::make_unique<DeviceRegion>(DeviceRegion{.built = std::move(built),
                                                     .table = std::move(table),
                                                     .drawn = std::move(drawn),
                                                     .drawnVoxels = count,
                                                     .lights = LightPass(device)});
}

BlockList RegionRenderer::State::listDrawn(const BuiltVolume& built, const fvx::VoxelBox& own, std::uint64_t& count) const {
  std::vector<std::uint32_t> voxels = downloadBlockList(device, built.visible);
  std::erase_if(voxels, [&](std::uint32_t voxel) {
    const glm::ivec3 cell = built.volume.hierarchy.blockAt(voxel).cell;
    return glm::any(glm::lessThan(cell, own.first)) || glm::any(glm::greaterThanEqual(cell, own.end));
  });
  BlockList list;
  CompactionPass(device).allocate(list, voxels.size());
  if (!voxels.empty()) upload(device, list.indices, std::as_bytes(std::span(voxels)));
  count = voxels.size();
  return list;
}

VolumeMemory RegionRenderer::State::memoryOfLargest() const {
  const glm::ivec3 box = glm::min(outline.dimensions, fvx::kRegionEdge + 2 * fvx::kRegionHalo);
  const HierarchyLayout hierarchy(box);
  std::vector<std::uint64_t> blocks;
  for (const GridLayout& level : hierarchy.levels) blocks.push_back(level.voxels());
  return volumeMemory(hierarchy, blocks, tableSettings.directions, {.colors = outlineVolume.hasColors}, sweepStyle(device));
}

/// Frees regions of earlier frames until one more fits.
void RegionRenderer::State::makeRoom() {
  const std::uint64_t needed = 2 * memoryOfLargest().peak();  // with its copies on the way to the device
  while (!kept.empty() && device.availableBytes() < needed) kept.erase(kept.begin());
}

DeviceRegion& RegionRenderer::State::onDevice(const RegionEntry& region) {
  std::unique_ptr<DeviceRegion>& place = kept[&region];
  if (place) return *place;
  kept.erase(&region);
  makeRoom();
  return *(kept[&region] = load(region));
}

void RegionRenderer::State::draw(FrameInProgress& frame, const RegionEntry& entry, bool addToSums) {
  DeviceRegion& region = onDevice(entry);
  FrameConstants constants = makeFrameConstants(device, region.built.volume, tableSettings, frame.camera, frame.settings);
  if (frame.settings.lighting)
    constants.setup.lighting = region.lights.prepare(region.built.volume, tableSettings, frame.settings, false, times, {});
  Commands commands(device);
  if (region.drawnVoxels > 0) {
    const SplatPass::Inputs inputs{
        .volume = region.built.volume,
        .table = &region.table,
        .visible = &region.drawn,
        .chunkCount = region.drawn.chunkCount,
        .continued = frame.drawn,
        .lights = constants.lit ? &region.lights.lights() : nullptr,
        .onSplats = [&](const Buffer& splatBuffer, std::uint32_t chunk) {
          accumulate->recordMarks(commands, splatBuffer, region.drawn, chunk);
        }};
    splats->record(commands, inputs, constants, frame.targets);
    frame.drawn = true;
  }
  if (addToSums && frame.drawn) accumulate->record(commands, constants, frame.targets);
  if (!commands.empty()) commands.submitAndWait();
  addTimes(times, commands.times());
  if (!keepsRegions) kept.erase(&entry);
}

std::optional<std::string> RegionRenderer::whyNot(const FvxFile& file, const Classification& classification, const TableSettings& table,
                                                  const std::vector<Camera>& cameras, const FrameSettings& settings) {
  if (!file.hasRegions()) return "the file was baked without regions, as all with a transfer function or emission are";
  const Classification& baked = *file.description().volume.classification;
  if (classification.transferFunction || classification.emission) return "transfer functions and emission need the whole volume";
  if (classification.densityScale != baked.densityScale) return fmt::format("the regions were baked for another {}", Parameter("density-scale"));
  if (settings.composite == Composite::Sorted) return fmt::format("{} needs the whole volume", Parameter("composite", "sorted"));
  if (settings.attenuation == AttenuationLookup::Exact) return fmt::format("{} needs the whole volume", Parameter("attenuation", "exact"));
  if (settings.draw == Draw::Gather) return fmt::format("{} needs the whole volume", Parameter("draw", "gather"));
  if (table.directions != DirectionSet::Directions26 || !table.pathLengthCorrection)
    return "the regions were baked for a table of 26 directions with path-length correction";
  const Volume& volume = file.description().volume;
  for (const Camera& camera : cameras)
    if (isInside(eyeSource(camera, volume.indexToWorld), volume.dimensions)) return "the eye is inside the volume's box";
  if (!settings.lighting) return {};
  if (settings.lighting->attenuation == LightAttenuation::Exact) return fmt::format("{} needs the whole volume", Parameter("light-attenuation", "exact"));
  for (const Light& light : settings.lighting->lights)
    if (isInside(lightSource(light, volume.indexToWorld), volume.dimensions)) return "a light is inside the volume's box";
  return {};
}

RegionRenderer::RegionRenderer(const Device& device, std::shared_ptr<const FvxFile> file, const Classification& classification,
                               const TableSettings& table, bool keepsRegions)
    : state_(new State{.device = device,
                       .file = std::move(file),
                       .classification = classification,
                       .tableSettings = table,
                       .keepsRegions = keepsRegions}) {}

RegionRenderer::~RegionRenderer() = default;

FixedSums RegionRenderer::renderShares(const Camera& camera, const FrameSettings& wanted, const SharePart& part, const Progress& progress) {
  State& state = *state_;
  checkCamera(camera);
  checkFrameFits(state.device, wanted);
  state.times.clear();
  const FrameSettings settings = regionSettings(wanted);
  const RegionChoice choice(*state.file, state.outlineVolume, camera, wanted);
  FrameConstants whole = makeFrameConstants(state.device, state.outlineVolume, state.tableSettings, camera, settings);
  widenCovered(whole, wanted);
  FixedSums layout = sumsLayout(state.outlineVolume, whole, settings);
  layout.method += ", regions";
  if (!state.splats || !state.splats->draws(settings)) {
    state.splats = std::make_unique<SplatPass>(state.device, settings.depth);
    state.accumulate = std::make_unique<AccumulatePass>(state.device, settings.depth);
  }
  const std::shared_ptr<const FrameTargets> targets = state.targetPool.take(state.device, settings, TargetKind::Sums);
  {
    Commands commands(state.device);
    state.accumulate->recordClear(commands, std::move(layout));
    commands.submitAndWait();
  }

  const RegionBatches batches = batchesOf(*state.file, choice, part, state.counts);
  std::erase_if(state.kept, [&](const auto& kept) {
    return !std::ranges::binary_search(choice.levels()[kept.first->level], kept.first);
  });
  State::FrameInProgress frame{.camera = camera, .settings = settings, .targets = *targets};
  std::size_t drawn = 0;
  const std::size_t count = std::accumulate(state.counts.drawn.begin(), state.counts.drawn.end(), std::size_t(0));
  for (const auto& [shareAndLevel, regions] : batches)
    for (const RegionEntry* region : regions) {
      state.draw(frame, *region, region == regions.back());
      if (progress) progress("drawing regions", double(++drawn) / double(count));
    }
  const StageTimer timer(state.times, "copy to host");
  return state.accumulate->read();
}

Image RegionRenderer::render(const Camera& camera, const FrameSettings& settings, const Progress& progress) {
  return resolveSums(renderShares(camera, settings, {}, progress), settings.composite == Composite::Normalised);
}

std::vector<StageTime> RegionRenderer::timings() const {
  return state_->times;
}

RegionRenderer::Counts RegionRenderer::counts() const {
  return state_->counts;
}

VolumeMemory RegionRenderer::memory() const {
  return state_->memoryOfLargest();
}

std::vector<std::vector<std::uint8_t>> downloadTable(RegionRenderer& renderer, const RegionEntry& region) {
  const DeviceRegion& loaded = renderer.state_->onDevice(region);
  return downloadTable(renderer.state_->device, loaded.built.volume, loaded.table);
}

}  // namespace freevoxels
