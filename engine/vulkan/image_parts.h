#pragma once
// The Vulkan objects of a two-dimensional image with one level.

#include <glm/glm.hpp>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

struct ImageParts {
  DeviceMemory memory;
  OwnedImage image;
  OwnedImageView view;
};

/// Creates an image in device memory, in layout UNDEFINED. Debuggers show `name`.
ImageParts makeImageParts(const Device& device, glm::ivec2 size, VkFormat format, VkImageUsageFlags usage,
                          const char* name);

OwnedImageView makeImageView(const Device& device, VkImage image, VkFormat format);

}  // namespace freevoxels
