#include "engine/gathering/gather_pass.h"

#include <algorithm>
#include <array>

#include "embedded/gather.h"
#include "embedded/gather_stencil.h"
#include "embedded/gather_upsample.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

Pipeline makeGather(const Device& device, int axis, const GatherVolume& volume) {
  return makeComputePipeline(device, shaders::gather, {std::uint32_t(axis), volume.hasTowards(), volume.hasColors(), volume.hasScalars(), volume.isLit(),
                              volume.inPieces(), std::uint32_t(volume.sampleLights()), volume.isTinted(), volume.hasSurfaces(),
                              std::uint32_t(volume.ambientChannels()), std::uint32_t(volume.octaves())});
}

/// Of the stencil and the upsampling, which have the same bindings.
Pipeline makeImagePass(const Device& device, const Shader& code, bool withDistance, bool second, bool third = false) {
  return makeComputePipeline(device, code, {withDistance, second, third});
}

bool isLatticeOfPixels(const shader::GatherFrame& frame) {
  return frame.pitch == 1.0f && frame.samples == frame.size;
}

}  // namespace

/// A grid of rays is looked at, with a margin for what lies between them.
bool someRayHasAxis(const shader::GatherFrame& frame, int axis) {
  if (axis == frame.mainAxis) return true;
  constexpr int kGrid = 64;
  constexpr float kMargin = 1.05f;
  const glm::vec2 half = 0.5f * glm::vec2(frame.size) + 2.0f * frame.pitch;
  const glm::vec2 low = glm::max(frame.seenLow, -half), high = glm::min(frame.seenHigh, half);
  if (low.x > high.x || low.y > high.y) return false;
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const glm::vec3 position(1.0f, glm::mix(low, high, glm::vec2(float(i), float(j)) / float(kGrid)));
      glm::vec3 size;
      for (int a = 0; a < 3; ++a) size[a] = std::abs(glm::dot(frame.axes[a].along, position));
      const float largest = std::max({size.x, size.y, size.z});
      if (size[frame.mainAxis] <= kMargin * shader::kLeastAlong * largest && kMargin * size[axis] >= largest) return true;
    }
  }
  return false;
}

GatherPass::GatherPass(const Device& device)
    : device_(device), frame_(device, sizeof(shader::GatherFrame), MemoryUse::Device, "gather frame",
             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT) {}

void GatherPass::makeRoom(Sums& sums, std::uint64_t samples) {
  if (sums.colorEnergy.bytes() >= samples * sizeof(glm::vec4)) return;
  constexpr VkBufferUsageFlags kUsage =
      VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  sums = {};  // not both at once
  sums.colorEnergy =
      Buffer(device_, samples * sizeof(glm::vec4), MemoryUse::Device, "lattice C and E", kUsage);
  sums.distances = Buffer(device_, samples * sizeof(float), MemoryUse::Device, "lattice distance", kUsage);
  sums.colorEnergyTexels = TexelView(device_, sums.colorEnergy);
  sums.distanceTexels = TexelView(device_, sums.distances, VK_FORMAT_R32_SFLOAT);
}

void GatherPass::recordGather(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame) {
  makeRoom(gathered_, std::uint64_t(frame.samples.x) * std::uint64_t(frame.samples.y));
  commands.beginPass("gather");
  commands.update(frame_, frame);
  for (int axis = 0; axis < 3; ++axis) {
    if (!someRayHasAxis(frame, axis)) continue;
    const GatherVolume::Quads& quads = volume.quads(axis);
    std::vector<Binding> bindings{&frame_,
                                  &volume.brickNumbers(),
                                  &quads.medium.texels,
                                  &quads.source.texels,
                                  &quads.towards.texels,
                                  &gathered_.colorEnergyTexels,
                                  &gathered_.distanceTexels,
                                  &volume.transferTable(),
                                  &volume.skips()};
    for (const GatherVolume::QuadStore& light : quads.light) bindings.emplace_back(&light.texels);
    commands.dispatch(makeGather(device_, axis, volume), bindings, glm::ivec3(frame.samples, 1));
  }
  commands.barrier(kCompute, kCompute);
}

void GatherPass::recordImage(Commands& commands, const shader::GatherFrame& frame, bool scalars, const SplatTargets& targets) {
  const bool direct = isLatticeOfPixels(frame), withDistance = targets.distance.exists();
  const Sums& any = gathered_;
  if (!direct) {
    makeRoom(smoothed_, std::uint64_t(frame.samples.x) * std::uint64_t(frame.samples.y));
    makeRoom(rows_, std::uint64_t(frame.size.x) * std::uint64_t(frame.samples.y));
  }
  const auto bindings = [&](const Sums& from, const Sums& to) {
    return std::array<Binding, 7>{&frame_,
                                  &from.colorEnergyTexels,
                                  &from.distanceTexels,
                                  &to.colorEnergyTexels,
                                  &to.distanceTexels,
                                  &targets.colorEnergy,
                                  withDistance ? &targets.distance : &targets.colorEnergy};
  };
  commands.beginPass("gather image");
  const Pipeline stencil =
      makeImagePass(device_, shaders::gather_stencil, withDistance, direct, scalars);
  commands.dispatch(stencil, bindings(gathered_, direct ? any : smoothed_), glm::ivec3(frame.samples, 1));
  if (direct) return;
  for (const bool alongY : {false, true}) {
    commands.barrier(kCompute, kCompute);
    const Pipeline upsample =
        makeImagePass(device_, shaders::gather_upsample, withDistance, alongY);
    commands.dispatch(upsample, alongY ? bindings(rows_, any) : bindings(smoothed_, rows_),
                      {frame.size.x, alongY ? frame.size.y : frame.samples.y, 1});
  }
}

void GatherPass::record(Commands& commands, const GatherVolume& volume, const shader::GatherFrame& frame,
                        const SplatTargets& targets) {
  for (const RenderTarget* target : targets.all())
    commands.transition(*target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, kCompute, kCompute);
  recordGather(commands, volume, frame);
  recordImage(commands, frame, volume.hasScalars(), targets);
  commands.barrier(kCompute, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
}

}  // namespace freevoxels
