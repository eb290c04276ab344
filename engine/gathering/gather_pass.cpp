#include "engine/gathering/gather_pass.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "embedded/gather_list.h"
#include "embedded/gather_list_offsets.h"
#include "embedded/gather_post_lit.h"
#include "embedded/gather_post_lit_cube.h"
#include "embedded/gather_post_lit_merged.h"
#include "embedded/gather_post_surfaces.h"
#include "embedded/gather_post_surfaces_cube.h"
#include "embedded/gather_post_surfaces_merged.h"
#include "embedded/gather_post_unlit.h"
#include "embedded/gather_post_unlit_cube.h"
#include "embedded/gather_post_unlit_merged.h"
#include "embedded/gather_pre_lit.h"
#include "embedded/gather_pre_lit_cube.h"
#include "embedded/gather_pre_lit_merged.h"
#include "embedded/gather_pre_surfaces.h"
#include "embedded/gather_pre_surfaces_cube.h"
#include "embedded/gather_pre_surfaces_merged.h"
#include "embedded/gather_pre_unlit.h"
#include "embedded/gather_pre_unlit_cube.h"
#include "embedded/gather_pre_unlit_merged.h"
#include "embedded/gather_projected_cube.h"
#include "embedded/gather_projected_whole.h"
#include "embedded/gather_refine.h"
#include "embedded/gather_roughness.h"
#include "embedded/gather_stencil.h"
#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

const Shader& gatherShader(const GatherVolume& volume, bool isProjected, GatherPass::Variant variant) {
  using namespace shaders;
  if (isProjected) {
    FV_CHECK_EQ(volume.hasScalars() && !volume.isSampled(), true);
    return variant == GatherPass::Variant::Cube ? gather_projected_cube : gather_projected_whole;
  }
  static constexpr std::array<std::array<std::array<const Shader*, 3>, 3>, 2> kShaders{{
      {{{&gather_pre_unlit, &gather_pre_unlit_cube, &gather_pre_unlit_merged},
        {&gather_pre_lit, &gather_pre_lit_cube, &gather_pre_lit_merged},
        {&gather_pre_surfaces, &gather_pre_surfaces_cube, &gather_pre_surfaces_merged}}},
      {{{&gather_post_unlit, &gather_post_unlit_cube, &gather_post_unlit_merged},
        {&gather_post_lit, &gather_post_lit_cube, &gather_post_lit_merged},
        {&gather_post_surfaces, &gather_post_surfaces_cube, &gather_post_surfaces_merged}}},
  }};
  return *kShaders[volume.hasScalars()][volume.hasSurfaces() ? 2 : volume.isSampled() ? 1 : 0][std::size_t(variant)];
}

Pipeline makeGather(const Device& device, int axis, const GatherVolume& volume, GatherPass::Rays rays, const Shader& shader,
                    int lists = 0) {
  return makeComputePipeline(device, shader,
                             {std::uint32_t(axis), volume.hasTowards(), volume.hasColors(), volume.isLit(), volume.inPieces(),
                              std::uint32_t(volume.sampleLights()), volume.hasScattered(), volume.hasFlux(), volume.isTinted(),
                              volume.hasEmissionApart(), rays.levels && volume.hasScalars(), rays.holdout, lists > 0,
                              std::uint32_t(std::max(lists, 1)), rays.clips, rays.quarters && volume.hasScalars()});
}

std::uint64_t latticeSize(const shader::GatherFrame& frame) {
  return std::uint64_t(frame.samples.x) * std::uint64_t(frame.samples.y);
}

}  // namespace

GatherPass::GatherPass(const Device& device)
    : device_(device),
      frame_(device, sizeof(shader::GatherFrame), MemoryUse::Device, "gather frame", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      noLight_(device, sizeof(glm::vec4), MemoryUse::Device, "no scattered light", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT),
      noLightTexels_(device, noLight_),
      tiles_(device),
      image_(device) {}

void GatherPass::compileAhead(const Device& device, const GatherVolume& volume, const std::array<bool, 3>& axes, Rays rays) {
  for (int axis = 0; axis < 3; ++axis)
    if (axes[std::size_t(axis)]) makeGather(device, axis, volume, rays, gatherShader(volume, rays.areProjected, Variant::Whole));
}

void GatherPass::makeRoom(Sums& sums, std::uint64_t samples) {
  if (sums.colorEnergy.bytes() >= samples * sizeof(glm::vec4)) return;
  if (samples > device_.limits().maxTexelBufferElements)
    fail(ErrorKind::OutOfMemory, "the image needs {} samples, and {} can address {} at once: use a smaller {}", samples,
         device_.description().name, device_.limits().maxTexelBufferElements, Parameter("size"));
  constexpr VkBufferUsageFlags kUsage =
      VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  sums = {};  // free the old buffers before allocating the new ones
  Sums made;  // so that a failure leaves nothing incomplete
  made.colorEnergy = Buffer(device_, samples * sizeof(glm::vec4), MemoryUse::Device, "lattice C and E", kUsage);
  made.distances = Buffer(device_, samples * sizeof(float), MemoryUse::Device, "lattice distance", kUsage);
  made.colorEnergyTexels = TexelView(device_, made.colorEnergy);
  made.distanceTexels = TexelView(device_, made.distances, VK_FORMAT_R32_SFLOAT);
  sums = std::move(made);
}

glm::uvec2 GatherPass::holdOut(const std::shared_ptr<const Holdout>& holdout) {
  if (holdout != heldOut_) {
    heldOut_ = nullptr;
    holdoutDistances_ = {};  // free the old buffer before allocating the new one
    if (!holdout) return glm::uvec2(0);
    // A number instead of infinity, with which not all devices compute.
    static constexpr float kBeyondAnything = 1e30f;
    std::vector<float> distances(holdout->depths.size());
    std::ranges::transform(holdout->depths, distances.begin(), [](float depth) { return std::min(depth, kBeyondAnything); });
    holdoutDistances_ = Buffer(device_, distances.size() * sizeof(float), MemoryUse::Device, "holdout");
    upload(device_, holdoutDistances_, std::as_bytes(std::span(distances)));
    heldOut_ = holdout;
  }
  return holdout ? addressWords(holdoutDistances_.address()) : glm::uvec2(0);
}

void GatherPass::setLattice(const shader::GatherFrame& frame) {
  lattice_ = {.samples = frame.samples, .pitch = double(frame.pitch), .first = frame.firstSample};
  seen_ = {.first = frame.firstSeen, .extent = frame.seenExtent};
}

void GatherPass::begin(Commands& commands, const shader::GatherFrame& frame) {
  setLattice(frame);
  makeRoom(gathered_, latticeSize(frame));
  commands.update(frame_, frame);
}

std::vector<Binding> GatherPass::gatherBindings(const GatherVolume& volume, int axis, const Dispatch& target) const {
  const GatherVolume::Quads& quads = volume.quads(axis);
  std::vector<Binding> bindings{target.frame,
                                &volume.bricks().numberTexels(),
                                &quads.medium.texels,
                                &quads.source.texels,
                                &quads.extra.texels,
                                &gathered_.colorEnergyTexels,
                                &gathered_.distanceTexels,
                                &volume.transferTable(),
                                &volume.bricks().skips()};
  for (const GatherVolume::QuadStore& light : quads.light) bindings.emplace_back(&light.texels);
  bindings.emplace_back(volume.hasScattered() ? &volume.scatteredTexels() : &noLightTexels_);
  bindings.emplace_back(&volume.gradients());
  for (const TexelView* const texels : {target.slabs, target.depths}) bindings.emplace_back(texels != nullptr ? texels : &noLightTexels_);
  return bindings;
}

void GatherPass::dispatch(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, const Dispatch& target,
                          const shader::SamplesPush& samples) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (!someRayHasAxis(frame, axis)) continue;
    const Rays rays(frame);
    const Pipeline pipeline =
        makeGather(device_, axis, volume, rays, gatherShader(volume, rays.areProjected, target.variant), target.lists);
    const std::vector<Binding> bindings = gatherBindings(volume, axis, target);
    if (target.arguments != nullptr)
      commands.dispatchIndirect(pipeline, bindings, samples, *target.arguments, target.offset, target.mostGroups);
    else
      commands.dispatch(pipeline, bindings, samples, glm::ivec3(target.threads, 1));
  }
}

void GatherPass::dispatchSamples(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, glm::ivec2 extent,
                                 Variant variant, const shader::SamplesPush& samples) {
  if (samples.step != 0) {
    dispatch(commands, volume, frame, {.variant = variant, .frame = &frame_, .threads = extent}, samples);
    return;
  }
  shader::SamplesPush range = samples;
  for (int i = 0; i < shader::kSampleRanges; ++i) {
    range.firstRow = i * samples.rowsOfARange;
    dispatch(commands, volume, frame,
             {.variant = variant,
              .frame = &frame_,
              .arguments = &adaptive_.list,
              .offset = std::uint64_t(i) * sizeof(shader::DispatchSize),
              .mostGroups = std::uint64_t(samples.rowsOfARange) * std::uint64_t(samples.groupsOfARow)},
             range);
  }
}

void GatherPass::recordSamples(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame) {
  recordSamples(commands, frame, [&](Commands& recording, glm::ivec2 extent, const shader::SamplesPush& samples) {
    dispatchSamples(recording, volume, frame, extent, Variant::Whole, samples);
  });
}

void GatherPass::recordSamples(Commands& commands, const shader::GatherFrame& frame, const March& march) {
  if (frame.sampleTolerance > 0.0f)
    recordAdaptive(commands, frame, march);
  else
    march(commands, frame.seenExtent, {.step = 1});
  commands.barrier(kComputeStage, kComputeStage);
}

void GatherPass::makeAdaptiveRoom(std::uint64_t coarse, std::uint64_t groups) {
  if (adaptive_.roughness.bytes() >= coarse * sizeof(float) && adaptive_.groupCounts.bytes() >= groups * sizeof(std::uint32_t)) return;
  adaptive_ = {};  // free the old buffers before allocating the new ones
  Adaptive made;
  made.roughness = Buffer(device_, coarse * sizeof(float), MemoryUse::Device, "lattice roughness",
                          VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  made.roughnessTexels = TexelView(device_, made.roughness, VK_FORMAT_R32_SFLOAT);
  made.groupCounts = Buffer(device_, groups * sizeof(std::uint32_t), MemoryUse::Device, "rough samples of workgroups");
  made.list = Buffer(device_, sizeof(shader::SampleListHead) + 3 * coarse * sizeof(std::uint32_t), MemoryUse::Device, "rough samples",
                     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  adaptive_ = std::move(made);
}

/// Marches the coarse samples, and of the others those that are not interpolated, from a list in a fixed order.
void GatherPass::recordAdaptive(Commands& commands, const shader::GatherFrame& frame, const March& march) {
  const glm::ivec2 coarse = (frame.seenExtent + 1) / 2, groups = (coarse + shader::kGatherTile - 1) / shader::kGatherTile;
  makeAdaptiveRoom(std::uint64_t(coarse.x) * std::uint64_t(coarse.y), std::uint64_t(groups.x) * std::uint64_t(groups.y));
  march(commands, coarse, {.step = 2});
  commands.barrier(kComputeStage, kComputeStage);

  // Passes of their own: what a workgroup of them takes is not what one of the march takes.
  commands.beginPass("gather refinement");
  const glm::ivec3 threads(coarse, 1);
  const std::array<Binding, 4> rough{&frame_, &gathered_.colorEnergyTexels, &gathered_.distanceTexels, &adaptive_.roughnessTexels};
  commands.dispatch(makeComputePipeline(device_, shaders::gather_roughness, {}), rough, threads);
  commands.barrier(kComputeStage, kComputeStage);
  std::vector<Binding> refined = sumBindings(gathered_, gathered_);
  refined.emplace_back(&adaptive_.roughnessTexels);
  refined.emplace_back(&adaptive_.groupCounts);
  commands.dispatch(makeComputePipeline(device_, shaders::gather_refine, {}), refined, threads);
  commands.barrier(kComputeStage, kComputeStage);
  const shader::SamplesPush listed = recordList(commands, coarse, groups);
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
  commands.beginPass("gather rough rays");
  march(commands, glm::ivec2(0), listed);
}

/// Lists the samples that the workgroups have counted, and returns how the list is marched.
shader::SamplesPush GatherPass::recordList(Commands& commands, glm::ivec2 coarse, glm::ivec2 groups) {
  const int samplesOfARow = groups.x * shader::kGatherTile * shader::kGatherTile;
  const int rows = (3 * coarse.x * coarse.y + samplesOfARow - 1) / samplesOfARow;
  const shader::SamplesPush push{.list = addressWords(adaptive_.list.address()),
                                 .step = 0,
                                 .groupsOfARow = groups.x,
                                 .rowsOfARange = (rows + shader::kSampleRanges - 1) / shader::kSampleRanges,
                                 .groups = groups.x * groups.y};
  commands.dispatch(makeComputePipeline(device_, shaders::gather_list_offsets, {}), std::array<Binding, 1>{&adaptive_.groupCounts}, push,
                    {shader::kScanThreads, 1, 1});
  commands.barrier(kComputeStage, kComputeStage);
  const std::array<Binding, 3> bindings{&frame_, &adaptive_.roughnessTexels, &adaptive_.groupCounts};
  commands.dispatch(makeComputePipeline(device_, shaders::gather_list, {}), bindings, push, glm::ivec3(coarse, 1));
  return push;
}

void GatherPass::recordClear(Commands& commands, const shader::GatherFrame& frame) {
  setLattice(frame);
  makeRoom(gathered_, latticeSize(frame));
  commands.clear(gathered_.colorEnergy);
  commands.clear(gathered_.distances);
}

void GatherPass::recordCube(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame) {
  commands.beginPass("gather");
  begin(commands, frame);
  dispatchSamples(commands, volume, frame, frame.cube.extent, Variant::Cube);
  commands.barrier(kComputeStage, kComputeStage);
}

std::vector<Binding> GatherPass::sumBindings(const Sums& from, const Sums& to) const {
  return {&frame_, &from.colorEnergyTexels, &from.distanceTexels, &to.colorEnergyTexels, &to.distanceTexels};
}

void GatherPass::recordStencil(Commands& commands, const shader::GatherFrame& frame) {
  makeRoom(smoothed_, latticeSize(frame));
  tiles_.record(commands, frame_, frame, gathered_.colorEnergyTexels);
  std::vector<Binding> bindings = sumBindings(gathered_, smoothed_);
  bindings.emplace_back(&tiles_.list());
  tiles_.dispatch(commands, makeComputePipeline(device_, shaders::gather_stencil, {}), bindings);
  commands.barrier(kComputeStage, kComputeStage);
}

void GatherPass::recordResampling(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets) {
  const Sums& samples = scalars ? gathered_ : smoothed_;
  if (scalars) tiles_.record(commands, frame_, frame, gathered_.colorEnergyTexels);
  image_.record(commands, frame_, frame, {samples.colorEnergyTexels, samples.distanceTexels, tiles_}, targets);
}

void GatherPass::record(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame, const FrameTargets& targets) {
  commands.beginPass("gather");
  begin(commands, frame);
  recordSamples(commands, volume, frame);
  recordPixels(commands, frame, volume.hasScalars(), targets);
}

void GatherPass::recordImage(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets) {
  begin(commands, frame);
  recordPixels(commands, frame, scalars, targets);
}

void GatherPass::recordPixels(Commands& commands, const shader::GatherFrame& frame, bool scalars, const FrameTargets& targets) {
  commands.beginPass("gather image");
  const bool hasStencil = !scalars && frame.raysOfPixel == 0;
  if (hasStencil) recordStencil(commands, frame);
  recordResampling(commands, frame, !hasStencil, targets);
}

/// Sums outside of what was seen are not stored, and 0.
std::vector<GatherSums> GatherPass::download(const Sums& sums, glm::ivec2 rows) const {
  const auto width = std::size_t(lattice_.samples.x);
  std::vector<GatherSums> result(width * std::size_t(rows.y - rows.x));
  const int begin = std::max(rows.x, seen_.first.y), end = std::min(rows.y, seen_.first.y + seen_.extent.y);
  if (begin >= end) return result;
  const std::size_t first = width * std::size_t(begin), count = width * std::size_t(end - begin);
  std::vector<glm::vec4> colorEnergy(count);
  std::vector<float> distances(count);
  freevoxels::download(device_, sums.colorEnergy, std::as_writable_bytes(std::span(colorEnergy)), first * sizeof(glm::vec4));
  freevoxels::download(device_, sums.distances, std::as_writable_bytes(std::span(distances)), first * sizeof(float));
  for (int y = begin; y < end; ++y)
    for (int x = seen_.first.x; x < seen_.first.x + seen_.extent.x; ++x) {
      const std::size_t i = std::size_t(x) + std::size_t(y - begin) * width;
      result[std::size_t(x) + std::size_t(y - rows.x) * width] = {
          .color = glm::dvec3(colorEnergy[i]), .energy = double(colorEnergy[i].a), .distance = double(distances[i])};
    }
  return result;
}

std::vector<GatherSums> GatherPass::downloadSmoothed() const {
  std::vector<GatherSums> sums = download(smoothed_, {0, lattice_.samples.y});
  const std::vector<bool> isListed = tiles_.download();
  const int columns = GatherTiles::extent(seen_.extent).x;
  for (int y = 0; y < seen_.extent.y; ++y)
    for (int x = 0; x < seen_.extent.x; ++x) {
      const glm::ivec2 tile = glm::ivec2(x, y) / shader::kLatticeTile, sample = seen_.first + glm::ivec2(x, y);
      if (!isListed[std::size_t(tile.x + tile.y * columns)]) sums[std::size_t(sample.x + sample.y * lattice_.samples.x)] = {};
    }
  return sums;
}

}  // namespace freevoxels
