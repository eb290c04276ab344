#include "engine/splatting/splat_pass.h"

#include <algorithm>
#include <cstdint>

#include "embedded/splat_fragment.h"
#include "embedded/splat_fragment_distance.h"
#include "embedded/splat_setup_lit.h"
#include "embedded/splat_setup_unlit.h"
#include "embedded/splat_sorted.h"
#include "embedded/splat_sorted_distance.h"
#include "embedded/splat_vertex.h"
#include "engine/core/error.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/rendering.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kDraw = VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT;
constexpr VkPipelineStageFlags2 kOutput = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

const Shader& fragmentShader(bool withDistance, bool sorted) {
  if (sorted)
    return withDistance ? shaders::splat_sorted_distance
                        : shaders::splat_sorted;
  return withDistance ? shaders::splat_fragment_distance
                      : shaders::splat_fragment;
}

Pipeline makeSetupPipeline(const Device& device, const DeviceVolume& volume, bool lit, bool tinted) {
  return makeComputePipeline(device, lit ? shaders::splat_setup_lit : shaders::splat_setup_unlit,
                             {volume.hasEmission(), volume.hasColors, tinted});
}

Pipeline makeSplatPipeline(const Device& device, bool quads, bool withDistance, bool sorted) {
  const std::array formats{kTargetColorFormat, kTargetScalarFormat, kTargetScalarFormat};
  return makeGraphicsPipeline(
      device, shaders::splat_vertex, fragmentShader(withDistance, sorted),
      quads ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_POINT_LIST,
      std::span(formats).first(1u + (sorted ? 0u : 1u) + (withDistance ? 1u : 0u)),
      sorted ? Blend::Over : Blend::Additive, {quads ? 1u : 0u});
}

}  // namespace

SplatPass::SplatPass(const Device& device, bool withDistance, bool sorted)
    : device_(device),
      withDistance_(withDistance),
      sorted_(sorted),
      points_(makeSplatPipeline(device, false, withDistance, sorted)),
      quads_(makeSplatPipeline(device, true, withDistance, sorted)),
      eyeDepthsPass_(device),
      frame_(device, sizeof(shader::SetupFrame), MemoryUse::Device, "frame"),
      eyeDepths_(device, kEyeDepthsBytes, MemoryUse::Device, "eye depths") {}

void SplatPass::beginRendering(Commands& commands, const FrameTargets& targets, const FrameConstants& frame,
                               VkAttachmentLoadOp load) const {
  std::vector<VkImageView> images;
  for (const RenderTarget* target : targets.all()) images.push_back(target->view());
  const VkExtent2D extent{std::uint32_t(targets.colorEnergy.size().x),
                          std::uint32_t(targets.colorEnergy.size().y)};
  freevoxels::beginRendering(commands, images, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, load, {{0, 0}, extent});
  const float margin = frame.viewportMargin;
  const VkViewport viewport{
      -margin, -margin, float(extent.width) + 2 * margin, float(extent.height) + 2 * margin, 0.0f, 1.0f};
  const VkRect2D scissor{{0, 0}, extent};
  vkCmdSetViewport(commands.handle(), 0, 1, &viewport);
  vkCmdSetScissor(commands.handle(), 0, 1, &scissor);
}

void SplatPass::recordFrame(Commands& commands, const DeviceVolume& volume, const FrameConstants& frame) {
  shader::SetupFrame setup = frame.setup;
  if (frame.eyeReadsTable() && frame.eyeInside) {
    eyeDepthsPass_.record(commands, volume, DirectionSet(setup.cells), frame.eye, eyeDepths_);
    setup.sourceDepth = addressWords(eyeDepths_.address());
  }
  commands.beginPass("splat set-up");
  commands.update(frame_, setup);
}

void SplatPass::record(Commands& commands, const Inputs& inputs, const FrameConstants& frame, const FrameTargets& targets) {
  const std::uint64_t count =
      std::clamp<std::uint64_t>(inputs.volume.stored.front(), 1, shader::kSplatsPerChunk);
  if (splats_.bytes() < count * sizeof(shader::Splat))
    splats_ = Buffer(device_, count * sizeof(shader::Splat), MemoryUse::Device, "splats");
  const Buffer& anyBuffer = frame_;
  const std::array<Binding, 7> setup{&frame_,
                                     inputs.table ? &inputs.table->planeAddresses : &anyBuffer,
                                     &inputs.volume.occupancy,
                                     frame.lit ? inputs.lights : &anyBuffer,
                                     inputs.order ? inputs.order : &inputs.visible->indices,
                                     &inputs.visible->chunks,
                                     &splats_};
  const std::array<Binding, 1> draw{&splats_};
  Pipeline& setUp = setups_[std::size_t(frame.lit) + std::size_t(frame.tinted)];
  if (!setUp.exists()) setUp = makeSetupPipeline(device_, inputs.volume, frame.lit, frame.tinted);
  const Pipeline& pipeline = frame.quads ? quads_ : points_;
  for (const RenderTarget* target : targets.all())
    commands.transition(*target, inputs.continued ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED,
                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kOutput | kComputeStage, kOutput);

  if (!inputs.continued) recordFrame(commands, inputs.volume, frame);
  const std::uint32_t endChunk = inputs.firstChunk + inputs.chunkCount;
  for (std::uint32_t chunk = inputs.firstChunk; chunk < endChunk; ++chunk) {
    const VkDeviceSize arguments = chunk * sizeof(shader::ChunkArguments);
    commands.beginPass("splat set-up");
    commands.barrier(kDraw, kComputeStage);
    commands.dispatchIndirect(setUp, setup, shader::SetupPush{chunk}, inputs.visible->chunks, arguments);
    if (inputs.onSplats) inputs.onSplats(splats_, chunk);
    commands.beginPass("splat draw");
    commands.barrier(kComputeStage, kDraw);
    beginRendering(commands, targets, frame,
                   chunk == inputs.firstChunk && !inputs.continued ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD);
    commands.bind(pipeline, draw, &frame.splat, sizeof(frame.splat));
    const std::size_t offset = frame.quads ? offsetof(shader::ChunkArguments, quadVertexCount)
                                           : offsetof(shader::ChunkArguments, vertexCount);
    vkCmdDrawIndirect(commands.handle(), inputs.visible->chunks.handle(), arguments + offset, 1, 0);
    vkCmdEndRendering(commands.handle());
    commands.barrier(kOutput, kOutput);
  }
  for (const RenderTarget* target : targets.all())
    commands.transition(*target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL, kOutput,
                        kComputeStage | VK_PIPELINE_STAGE_2_TRANSFER_BIT);
}

}  // namespace freevoxels
