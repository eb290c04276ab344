#include "engine/vulkan/rendering.h"

#include <cstdint>
#include <vector>

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

void beginRendering(Commands& commands, std::span<const VkImageView> images, glm::ivec2 size, VkAttachmentLoadOp load) {
  const VkRect2D area{{0, 0}, {std::uint32_t(size.x), std::uint32_t(size.y)}};
  const VkViewport viewport{0.0f, 0.0f, float(size.x), float(size.y), 0.0f, 1.0f};
  beginRendering(commands, images, VK_IMAGE_LAYOUT_GENERAL, load, area);
  vkCmdSetViewport(commands.handle(), 0, 1, &viewport);
  vkCmdSetScissor(commands.handle(), 0, 1, &area);
}

}  // namespace freevoxels
