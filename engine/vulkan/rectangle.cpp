#include "engine/vulkan/rectangle.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "embedded/rectangle.h"
#include "engine/core/error.h"

namespace freevoxels {

void beginRendering(Commands& commands, std::span<const VkImageView> images, VkImageLayout layout, VkAttachmentLoadOp load, VkRect2D area) {
  std::vector<VkRenderingAttachmentInfo> attachments;
  for (const VkImageView image : images)
    attachments.push_back({.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                           .imageView = image,
                           .imageLayout = layout,
                           .loadOp = load,
                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE});
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = std::uint32_t(attachments.size()),
                                  .pColorAttachments = attachments.data()};
  vkCmdBeginRendering(commands.handle(), &rendering);
}

Pipeline makeRectanglePipeline(const Device& device, const Shader& fragment, std::span<const VkFormat> formats,
                               const Specialisation& constants) {
  return makeGraphicsPipeline(device, shaders::rectangle, fragment, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, formats, Blend::Replace, constants);
}

void drawRectangle(Commands& commands, const Pipeline& pipeline, std::span<const Binding> bindings, const void* push, std::size_t pushBytes,
                   std::span<const VkImageView> images, glm::ivec2 first, glm::ivec2 extent) {
  FV_CHECK_LT(0, std::min(extent.x, extent.y));
  const VkRect2D area{{first.x, first.y}, {std::uint32_t(extent.x), std::uint32_t(extent.y)}};
  const VkViewport viewport{float(first.x), float(first.y), float(extent.x), float(extent.y), 0.0f, 1.0f};
  beginRendering(commands, images, VK_IMAGE_LAYOUT_GENERAL, VK_ATTACHMENT_LOAD_OP_DONT_CARE, area);
  vkCmdSetViewport(commands.handle(), 0, 1, &viewport);
  vkCmdSetScissor(commands.handle(), 0, 1, &area);
  commands.bind(pipeline, bindings, push, pushBytes);
  vkCmdDraw(commands.handle(), 3, 1, 0, 0);
  vkCmdEndRendering(commands.handle());
}

}  // namespace freevoxels
