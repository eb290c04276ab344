#include "engine/gathering/merged_pass.h"

#include <algorithm>
#include <cmath>

#include "embedded/merge_rays.h"
#include "engine/core/error.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

/// Thickness of slabs, in edges of the smallest voxels.
constexpr double kSlabVoxels = 2.0;
/// Rays are marched in ranges for which the slabs take about this.
constexpr std::uint64_t kSlabBytes = 256u << 20;
constexpr int kTile = shader::kGatherTile;

/// The components of an affine function of the position p = (1, x, y), one by one.
void setAffine(glm::vec3 (&rows)[3], glm::dvec3 at, glm::dvec3 x, glm::dvec3 y) {
  for (int c = 0; c < 3; ++c) rows[c] = glm::dvec3(at[c], x[c], y[c]);
}

/// The box of a volume with what its coarsest blocks reach beyond it, in voxels.
struct WideBox {
  int margin = 0;
  glm::ivec3 dimensions;  ///< with the margin on both sides

  WideBox(const DeviceVolume& volume, int coarsest) : margin((1 << coarsest) / 2) {
    const int edge = 1 << coarsest;
    dimensions = (volume.layout.dimensions + edge - 1) / edge * edge + 2 * margin;
  }
};

SlabExtent extentOf(const PixelRays& rays, const DeviceVolume& volume, const WideBox& box) {
  const glm::dmat3 toPixel = rays.indexToPixel(), linear(volume.indexToWorld);
  SlabExtent extent{.begin = std::numeric_limits<double>::max(), .end = 0.0};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place =
        glm::mix(glm::dvec3(-1.0), glm::dvec3(box.dimensions), glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2)) - double(box.margin);
    const double distance = std::max((toPixel * (place - rays.origin)).z, 0.0);
    extent.begin = std::min(extent.begin, distance);
    extent.end = std::max(extent.end, distance);
  }
  extent.thickness = kSlabVoxels * std::min({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
  return extent;
}

/// Whether some ray may meet two of the volumes. Conservative: merge_rays.comp decides for each ray.
bool someRaysMeetTwo(std::span<const MergedPass::Part> parts, const Camera& camera) {
  constexpr int kMoreVoxels = 2, kMoreSamples = 2;
  std::vector<SampleRectangle> seen;
  for (const MergedPass::Part& part : parts) {
    const WideBox box(*part.onDevice, part.frame.coarsest);
    const glm::ivec3 low(-box.margin - kMoreVoxels), high = box.dimensions - box.margin + kMoreVoxels;
    const auto own = samplesThatSee(*part.onDevice, camera, part.frame, low, high);
    if (!own) continue;
    for (const SampleRectangle& other : seen)
      if (glm::all(glm::lessThan(own->first - kMoreSamples, other.first + other.extent)) &&
          glm::all(glm::lessThan(other.first, own->first + own->extent + kMoreSamples)))
        return true;
    seen.push_back(*own);
  }
  return false;
}

}  // namespace

SlabPlan planSlabs(std::span<const SlabExtent> extents, int most) {
  FV_CHECK_LE(extents.size(), std::size_t(shader::kMaxMerged));
  std::vector<double> borders;
  for (const SlabExtent& extent : extents) borders.insert(borders.end(), {extent.begin, extent.end});
  std::ranges::sort(borders);
  std::vector<SlabExtent> stretches;
  double wanted = 0.0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    SlabExtent stretch{.begin = borders[i], .end = borders[i + 1], .thickness = std::numeric_limits<double>::max()};
    for (const SlabExtent& extent : extents)
      if (extent.begin <= stretch.begin && stretch.end <= extent.end) stretch.thickness = std::min(stretch.thickness, extent.thickness);
    if (!(float(stretch.begin) < float(stretch.end)) || stretch.thickness == std::numeric_limits<double>::max()) continue;
    wanted += (stretch.end - stretch.begin) / stretch.thickness + 1.0;
    stretches.push_back(stretch);
  }
  const double thicker = std::max(wanted / std::max(most - double(stretches.size()), 1.0), 1.0);
  SlabPlan plan;
  for (const SlabExtent& stretch : stretches) {
    const double length = stretch.end - stretch.begin;
    const int count = std::max(int(std::ceil(length / (thicker * stretch.thickness))), 1);
    plan.intervals.push_back(
        {.begin = float(stretch.begin), .end = float(stretch.end), .perUnit = float(count / length), .first = float(plan.slabs)});
    plan.slabs += count;
  }
  return plan;
}

void MergedPass::begin(Commands& commands, std::span<const Part> parts, const Camera& camera) {
  FV_CHECK_LE(parts.size(), std::size_t(shader::kMaxMerged));
  shader::MergeFrame merge{.volumes = int(parts.size())};
  std::vector<SlabExtent> extents;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const DeviceVolume& volume = *parts[i].onDevice;
    const glm::ivec2 size = parts[i].frame.size;
    const PixelRays rays = pixelRays(camera, size, volume.indexToWorld).countedFrom(0.5 * glm::dvec2(size));
    const WideBox box(volume, parts[i].frame.coarsest);
    setAffine(merge.boxes[i].origin, rays.origin + double(box.margin), rays.originX, rays.originY);
    setAffine(merge.boxes[i].direction, rays.direction, rays.directionX, rays.directionY);
    merge.boxes[i].dimensions = box.dimensions;
    extents.push_back(extentOf(rays, volume, box));
  }
  volumes_ = int(parts.size());
  const SlabPlan plan = planSlabs(extents, mostSlabs(parts.front().frame));
  merge.intervals = int(plan.intervals.size());
  mayOverlap_ = someRaysMeetTwo(parts, camera);
  slabs_ = mayOverlap_ ? plan.slabs : 0;
  std::ranges::copy(plan.intervals, merge.interval);
  tinted_ = std::ranges::any_of(parts, [](const Part& part) { return part.volume->isTinted(); });
  if (merge_.bytes() == 0)
    merge_ = Buffer(device_, sizeof(merge), MemoryUse::Device, "volumes of a frame", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  commands.update(merge_, merge);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == frames_.size())
      frames_.emplace_back(device_, sizeof(shader::GatherFrame), MemoryUse::Device, "gather frame", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    commands.update(frames_[i], parts[i].frame);
  }
  pass_.begin(commands, parts.front().frame);
  makeRoom(parts.front().frame);
}

std::uint64_t MergedPass::mostEntries() const {
  return std::min<std::uint64_t>(kSlabBytes / sizeof(glm::vec4), device_.limits().maxTexelBufferElements);
}

/// So many slabs that there is room for a row of workgroups.
int MergedPass::mostSlabs(const shader::GatherFrame& frame) const {
  const std::uint64_t columns = std::uint64_t(frame.seenExtent.x + kTile);
  const std::uint64_t slabs = mostEntries() / (2 * std::uint64_t(listedVolumes()) * columns * kTile);  // with tinted light, twice as much
  return int(std::clamp<std::uint64_t>(slabs, 2 * shader::kMaxSlabIntervals, shader::kMaxSlabs));
}

std::uint64_t MergedPass::entriesOfSlot() const {
  return std::uint64_t(listedVolumes()) * std::uint64_t(std::max(slabs_, 1));
}

/// How many rows of a dispatch are marched at a time: of workgroups of a list, all of a range of it where there is room for that.
int MergedPass::rowsOfBand(int columns, int rows, bool listed) const {
  const std::uint64_t perSlot = entriesOfSlot() * (tinted_ ? 2 : 1);
  const auto most = int(std::clamp<std::uint64_t>(mostEntries() / (perSlot * std::uint64_t(columns)), 1, std::uint64_t(rows)));
  return listed ? most : std::max(most / kTile, 1) * kTile;
}

/// For all dispatches of a frame, before any is recorded.
void MergedPass::makeRoom(const shader::GatherFrame& frame) {
  const bool adapts = frame.sampleTolerance > 0.0f;
  const glm::ivec2 extent = adapts ? (frame.seenExtent + 1) / 2 : frame.seenExtent, groups = (extent + kTile - 1) / kTile;
  const int columns = groups.x * kTile, listColumns = columns * kTile;
  std::uint64_t slots = std::uint64_t(columns) * std::uint64_t(rowsOfBand(columns, extent.y, false));
  // Of a list of at most three samples for each coarse one.
  if (adapts) {
    const int rows = (3 * extent.x * extent.y + listColumns - 1) / listColumns;
    const int inRange = (rows + shader::kSampleRanges - 1) / shader::kSampleRanges;
    slots = std::max(slots, std::uint64_t(listColumns) * std::uint64_t(rowsOfBand(listColumns, inRange, true)));
  }
  makeRoom(slots);
}

void MergedPass::makeRoom(std::uint64_t slots) {
  growBuffer(device_, rays_, slots * sizeof(std::uint32_t), "rays of several volumes");
  growBuffer(device_, counts_, slots * std::uint64_t(listedVolumes()) * sizeof(std::uint32_t), "entries of rays");
  if (growBuffer(device_, entries_, slots * entriesOfSlot() * sizeof(glm::vec4), "slabs", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT))
    entryTexels_ = TexelView(device_, entries_);
  if (tinted_ && growBuffer(device_, depths_, slots * entriesOfSlot() * sizeof(glm::vec4), "optical depths of slabs",
                            VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT))
    depthTexels_ = TexelView(device_, depths_);
}

void MergedPass::marchBand(Commands& commands, std::span<const Part> parts, GatherPass::Dispatch target,
                           const shader::SamplesPush& samples) {
  shader::SamplesPush push = samples;
  push.merge = addressWords(merge_.address());
  push.rays = addressWords(rays_.address());
  push.entries = addressWords(entries_.address());
  push.counts = addressWords(counts_.address());
  push.slabs = slabs_;
  push.depths = addressWords(depths_.bytes() > 0 ? depths_.address() : 0);
  const Pipeline mergeRays = makeComputePipeline(device_, shaders::merge_rays, {});
  const std::array<Binding, 4> bindings{&pass_.frameBuffer(), &merge_, &pass_.colorEnergyTexels(), &pass_.distanceTexels()};
  if (target.arguments != nullptr)
    commands.dispatchIndirect(mergeRays, bindings, push, *target.arguments, target.offset, target.mostGroups);
  else
    commands.dispatch(mergeRays, bindings, push, glm::ivec3(target.threads, 1));
  commands.barrier(kComputeStage, kComputeStage);
  target.slabs = &entryTexels_;
  target.depths = tinted_ ? &depthTexels_ : nullptr;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    push.volume = int(i);
    target.frame = &frames_[i];
    const auto march = [&](GatherPass::Variant variant, int lists) {
      target.variant = variant;
      target.lists = lists;
      pass_.dispatch(commands, *parts[i].volume, parts[i].frame, target, push);
    };
    march(GatherPass::Variant::Whole, 0);
    if (mayOverlap_ && i > 0) march(GatherPass::Variant::Merged, int(i));
    if (mayOverlap_ && i + 1 < parts.size()) march(GatherPass::Variant::Merged, 0);
    commands.barrier(kComputeStage, kComputeStage);
  }
}

/// Marches samples in ranges of rows, of samples or of workgroups of the list.
void MergedPass::march(Commands& commands, std::span<const Part> parts, glm::ivec2 extent, const shader::SamplesPush& samples) {
  const bool listed = samples.step == 0;
  const int columns = listed ? samples.groupsOfARow * kTile * kTile : (extent.x + kTile - 1) / kTile * kTile;
  const int rows = listed ? samples.rowsOfARange * shader::kSampleRanges : extent.y;
  const int inBand = rowsOfBand(columns, listed ? samples.rowsOfARange : rows, listed);
  FV_CHECK_LE(std::uint64_t(columns) * std::uint64_t(inBand) * sizeof(std::uint32_t), rays_.bytes());
  for (int first = 0; first < rows; first += inBand) {
    shader::SamplesPush push = samples;
    push.firstRow = first;
    push.columns = columns;
    push.slots = columns * inBand;
    const int count = std::min(inBand, rows - first);
    GatherPass::Dispatch target{.threads = listed ? glm::ivec2(samples.groupsOfARow * kTile, count * kTile) : glm::ivec2(extent.x, count)};
    if (listed && inBand == samples.rowsOfARange) {
      // How many workgroups there are is known on the device.
      target.arguments = &pass_.list();
      target.offset = std::uint64_t(first / inBand) * sizeof(shader::DispatchSize);
      target.mostGroups = std::uint64_t(inBand) * std::uint64_t(samples.groupsOfARow);
    }
    marchBand(commands, parts, target, push);
  }
}

void MergedPass::recordSamples(Commands& commands, std::span<const Part> parts, const Camera& camera) {
  begin(commands, parts, camera);
  commands.beginPass("gather");
  pass_.recordSamples(commands, parts.front().frame, [&](Commands& recording, glm::ivec2 extent, const shader::SamplesPush& samples) {
    march(recording, parts, extent, samples);
  });
}

void MergedPass::record(Commands& commands, std::span<const Part> parts, const Camera& camera, const FrameTargets& targets) {
  recordSamples(commands, parts, camera);
  pass_.recordPixels(commands, parts.front().frame, true, targets);
}

}  // namespace freevoxels
