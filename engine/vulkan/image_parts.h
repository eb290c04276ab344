#pragma once
// What every two-dimensional image with one level is made of.

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

/// On the device, in layout UNDEFINED. `name` is shown by debuggers.
ImageParts makeImageParts(const Device& device, glm::ivec2 size, VkFormat format, VkImageUsageFlags usage,
                          const char* name);

OwnedImageView makeImageView(const Device& device, VkImage image, VkFormat format);

}  // namespace freevoxels
