#include "engine/image/display_pass.h"

#include <array>
#include <cmath>

#include "embedded/display_fragment.h"
#include "embedded/display_vertex.h"
#include "engine/core/error.h"
#include "engine/image/srgb.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/rendering.h"

namespace freevoxels {

static_assert(int(ToneMap::None) == shader::kToneMapNone);
static_assert(int(ToneMap::Filmic) == shader::kToneMapFilmic);
static_assert(int(ToneMap::Aces) == shader::kToneMapAces);

DisplayPass::DisplayPass(const Device& device)
    : device_(device), srgb_(device, srgbBuckets().size_bytes(), MemoryUse::Device, "sRGB table") {
  upload(device, srgb_, std::as_bytes(srgbBuckets()));
}

void DisplayPass::record(Commands& commands, const RenderTarget& image, const DisplayLook& look,
                         const Texture& shown) const {
  FV_CHECK_EQ(image.size().x, shown.size().x);
  FV_CHECK_EQ(image.size().y, shown.size().y);
  constexpr VkPipelineStageFlags2 kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  constexpr VkPipelineStageFlags2 kOutput = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  const Background background = look.background.value_or(Background());
  const shader::DisplayPush push{
      .height = image.size().y, .gain = float(std::exp2(look.exposure)), .top = background.top, .bottom = background.bottom};
  const Pipeline pipeline =
      makeGraphicsPipeline(device_, shaders::display_vertex, shaders::display_fragment, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
                           std::array{Texture::kFormat}, Blend::Replace, {std::uint32_t(look.toneMap), look.background ? 1u : 0u});
  const std::array<Binding, 2> bindings{&image, &srgb_};
  commands.beginPass("display");
  commands.makeRoomForPixels(std::uint64_t(image.size().x) * std::uint64_t(image.size().y));
  commands.transition(shown.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, kFragment, kOutput);
  beginRendering(commands, std::array{shown.view()}, image.size(), VK_ATTACHMENT_LOAD_OP_DONT_CARE);
  commands.bind(pipeline, bindings, &push, sizeof(push));
  vkCmdDraw(commands.handle(), 3, 1, 0, 0);
  vkCmdEndRendering(commands.handle());
  commands.transition(shown.handle(), VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kOutput, kFragment);
}

RenderTarget uploadImage(const Device& device, const Image& image) {
  RenderTarget target(device, image.size, VK_FORMAT_R32G32B32A32_SFLOAT, "image of the host");
  const auto bytes = std::as_bytes(std::span(image.pixels));
  const Buffer staging(device, bytes.size(), MemoryUse::Upload, "image upload");
  upload(device, staging, bytes);
  Commands commands(device);
  commands.copy(staging, target);
  commands.submitAndWait();
  return target;
}

}  // namespace freevoxels
