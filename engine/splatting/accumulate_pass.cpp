#include "engine/splatting/accumulate_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "embedded/accumulate_sums.h"
#include "embedded/mark_tiles.h"
#include "engine/core/error.h"
#include "engine/volume/packed_light.h"
#include "engine/vulkan/commands.h"
#include "shaders/share_interface.h"

namespace freevoxels {

namespace {

static_assert(shader::kSumBits == kValueBits);

constexpr double kOverlapMargin = 8.0;
constexpr int kDepthDigits = kValueBits - 5;  // up to an optical depth of 32

double largestComponent(glm::dvec3 color) {
  return std::max({color.r, color.g, color.b});
}

/// The largest value of the phase function, or of a surface's reflection in its place; per steradian.
double mostScattered(const Lighting& lighting) {
  const double g = std::abs(lighting.phaseG);
  const double phase = (1.0 + g) / (4.0 * std::numbers::pi * (1.0 - g) * (1.0 - g));
  const double surface =
      (1.0 - kHighlight) / (2.0 * std::numbers::pi) + kHighlight * (kHighlightExponent + 1.0) / (8.0 * std::numbers::pi);
  return std::max(phase, lighting.surface > 0.0 ? surface : 0.0);
}

/// Square of the least distance at which a voxel is lit, world units: not nearer than the volume's box, and limited as in
/// lighting.glsl.
double nearest2(const Light& light, const DeviceVolume& volume) {
  const glm::dvec3 place(glm::inverse(volume.indexToWorld) * glm::dvec4(light.place, 1.0));
  const glm::dvec3 last(volume.layout.dimensions - 1);
  const glm::dvec3 apart = glm::dmat3(volume.indexToWorld) * (place - glm::clamp(place, glm::dvec3(0.0), last));
  // Along sheared axes the nearest voxel of the box is not the one that the clamp finds; it is at most half as far.
  return std::max(0.25 * glm::dot(apart, apart), double(shader::kNearestLight2) * volume.voxelSize * volume.voxelSize);
}

double brightestRadiance(const DeviceVolume& volume, const Lighting& lighting, double scattered) {
  double lights = 0.0;
  for (const Light& light : lighting.lights)
    lights += largestComponent(light.color) * light.intensity / (light.atInfinity ? 1.0 : nearest2(light, volume));
  // A block's visible side is at most twice as bright as its mean.
  return 2.0 * (lights * mostScattered(lighting) + scattered);
}

glm::ivec2 imageTiles(glm::ivec2 size) {
  return (size + shader::kResolveTile - 1) / shader::kResolveTile;
}

int digitsBelow(double bound) {
  return kValueBits - int(std::ceil(std::log2(std::max(bound, 1e-30))));
}

}  // namespace

SumBounds sumBounds(const DeviceVolume& volume, const FrameConstants& frame, const Lighting* lighting) {
  const glm::ivec3 size = volume.layout.dimensions;
  SumBounds bounds{.layers = double(std::max({size.x, size.y, size.z}) + 2),
                   .emission = volume.hasEmission() ? frame.brightestRay : 0.0,
                   .farthest = std::max(frame.farthest, 0.0)};
  if (lighting != nullptr) bounds.radiance = brightestRadiance(volume, *lighting, frame.scatteredRadiance);
  if (lighting != nullptr && splitPhase(*lighting).forward > 0.0)
    bounds.radiance /= 1.0 - splitPhase(*lighting).forward;  // seen from deeper
  bounds.radiance *= std::max(largestComponent(volume.albedo), 1.0);
  return bounds;
}

SumDigits sumDigits(const SumBounds& bounds) {
  const double energy = kOverlapMargin * bounds.layers;
  const int color = digitsBelow(energy * bounds.radiance + kOverlapMargin * bounds.emission);
  return {color, color, color, digitsBelow(energy), kDepthDigits, digitsBelow(energy * bounds.farthest)};
}

FixedSums sumsLayout(const DeviceVolume& volume, const FrameConstants& frame, const FrameSettings& settings) {
  const Lighting* const lighting = settings.lighting ? &*settings.lighting : nullptr;
  return {
      .size = settings.size,
      .first = frame.coveredFirst,
      .extent = frame.coveredExtent,
      .channels = settings.depth ? kSumChannels : kSumChannels - 1,
      .digits = sumDigits(sumBounds(volume, frame, lighting)),
      // The look-ups that Auto came to, which depends on the device's memory.
      .method = fmt::format("eye {}, lights {}", frame.setup.lookup, frame.lit ? fmt::format("{}", frame.setup.lighting.lookup) : "none"),
      .values = {}};
}

AccumulatePass::AccumulatePass(const Device& device, bool withDistance)
    : device_(device),
      withDistance_(withDistance),
      mark_(makeComputePipeline(device, shaders::mark_tiles)),
      accumulate_(makeComputePipeline(device, shaders::accumulate_sums, {withDistance ? 1u : 0u})),
      overflow_(device, sizeof(std::uint32_t), MemoryUse::Device, "overflow of sums"),
      arguments_(device, sizeof(shader::TileArguments), MemoryUse::Device, "tiles of a share",
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT) {}

void AccumulatePass::recordClear(Commands& commands, FixedSums layout) {
  layout_ = std::move(layout);
  FV_CHECK_EQ(layout_.channels, withDistance_ ? kSumChannels : kSumChannels - 1);
  const std::uint64_t bytes = layout_.pixelCount() * std::uint64_t(layout_.channels) * sizeof(std::int64_t);
  if (sums_.bytes() < bytes) {
    sums_ = {};  // not both at once
    sums_ = Buffer(device_, bytes, MemoryUse::Device, "fixed-point sums");
  }
  const glm::ivec2 tiles = imageTiles(layout_.size);
  const std::uint64_t tileBytes = std::uint64_t(tiles.x) * std::uint64_t(tiles.y) * sizeof(std::uint32_t);
  if (reached_.bytes() < tileBytes) {
    reached_ = Buffer(device_, tileBytes, MemoryUse::Device, "reached tiles");
    tiles_ = Buffer(device_, tileBytes, MemoryUse::Device, "list of tiles");
  }
  for (const Buffer* buffer : {&sums_, &overflow_, &reached_, &arguments_}) commands.clear(*buffer);
}

void AccumulatePass::recordMarks(Commands& commands, const Buffer& splats, const BlockList& list, std::uint32_t chunk) {
  const std::array<Binding, 5> bindings{&splats, &list.chunks, &reached_, &tiles_, &arguments_};
  commands.beginPass("accumulate sums");
  commands.barrier(kComputeStage, kComputeStage);
  commands.dispatchIndirect(mark_, bindings, shader::MarkPush{chunk, 0.5f * glm::vec2(layout_.size), imageTiles(layout_.size)}, list.chunks,
                            chunk * sizeof(shader::ChunkArguments));
}

void AccumulatePass::record(Commands& commands, const FrameConstants& frame, const FrameTargets& targets) {
  const std::array<Binding, 7> bindings{&targets.colorEnergy, &targets.opticalDepth,
                                        withDistance_ ? &targets.distance : &targets.opticalDepth,
                                        &overflow_, &reached_, &tiles_, &arguments_};
  const auto digits = [&](SumChannel channel) { return layout_.digits[std::size_t(channel)]; };
  const shader::AccumulatePush push{.rays = frame.resolve,
                                    .first = layout_.first,
                                    .extent = layout_.extent,
                                    .colorDigits = digits(SumChannel::Red),
                                    .energyDigits = digits(SumChannel::Energy),
                                    .depthDigits = digits(SumChannel::OpticalDepth),
                                    .distanceDigits = digits(SumChannel::Distance),
                                    .sums = addressWords(sums_.address())};
  commands.beginPass("accumulate sums");
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
  commands.dispatchIndirect(accumulate_, bindings, push, arguments_, 0);
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  commands.clear(arguments_);
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT);
}

FixedSums AccumulatePass::read() const {
  std::uint32_t overflow = 0;
  download(device_, overflow_, std::as_writable_bytes(std::span(&overflow, 1)));
  FV_CHECK_EQ(overflow, 0u);
  FixedSums sums = layout_;
  sums.values.resize(sums.pixelCount() * std::size_t(sums.channels));
  download(device_, sums_, std::as_writable_bytes(std::span(sums.values)));
  return sums;
}

}  // namespace freevoxels
