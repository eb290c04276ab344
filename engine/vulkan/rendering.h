#pragma once
// Rendering into images.

#include <glm/glm.hpp>
#include <span>

#include "engine/vulkan/commands.h"

namespace freevoxels {

/// Begins rendering into a rectangle of images, which are in this layout. Until vkCmdEndRendering no pass may begin.
void beginRendering(Commands& commands, std::span<const VkImageView> images, VkImageLayout layout, VkAttachmentLoadOp load, VkRect2D area);

/// The same of the first `size` pixels of images in layout GENERAL, which are also the viewport and the scissor rectangle.
void beginRendering(Commands& commands, std::span<const VkImageView> images, glm::ivec2 size, VkAttachmentLoadOp load);

}  // namespace freevoxels
