#pragma once
// Rendering into rectangles of images, whose pixels a fragment shader may compute.

#include <span>

#include "engine/vulkan/commands.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

/// Begins rendering into a rectangle of images, which are in this layout. Until vkCmdEndRendering no pass may begin.
void beginRendering(Commands& commands, std::span<const VkImageView> images, VkImageLayout layout, VkAttachmentLoadOp load, VkRect2D area);

/// `fragment` replaces the pixels of images of these formats.
Pipeline makeRectanglePipeline(const Device& device, const Shader& fragment, std::span<const VkFormat> formats,
                               const Specialisation& constants = {});

/// Records a draw of the pixels from `first` to `first` + `extent`, which is not empty and inside of all images; others stay as they are.
/// `images` are views of them; they are in layout GENERAL and stay in it. Barriers are the caller's: COLOR_ATTACHMENT_OUTPUT writes the
/// pixels. `push` points to the pipeline's push constants.
void drawRectangle(Commands& commands, const Pipeline& pipeline, std::span<const Binding> bindings, const void* push, std::size_t pushBytes,
                   std::span<const VkImageView> images, glm::ivec2 first, glm::ivec2 extent);

}  // namespace freevoxels
