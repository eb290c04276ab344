#include "engine/vulkan/image_parts.h"

namespace freevoxels {

OwnedImageView makeImageView(const Device& device, VkImage image, VkFormat format) {
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = image,
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                   .format = format,
                                   .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  VkImageView view = VK_NULL_HANDLE;
  VK_CHECK(vkCreateImageView(device.handle(), &info, nullptr, &view));
  return {device.handle(), view};
}

ImageParts makeImageParts(const Device& device, glm::ivec2 size, VkFormat format, VkImageUsageFlags usage,
                          const char* name) {
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {std::uint32_t(size.x), std::uint32_t(size.y), 1},
                               .mipLevels = 1,
                               .arrayLayers = 1,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = usage};
  VkImage image = VK_NULL_HANDLE;
  VK_CHECK(vkCreateImage(device.handle(), &info, nullptr, &image));
  ImageParts parts{.image = OwnedImage(device.handle(), image)};
  device.setName(VK_OBJECT_TYPE_IMAGE, std::uint64_t(image), name);

  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), image, &needs);
  parts.memory = DeviceMemory(device, needs, MemoryUse::Device, false);
  VK_CHECK(vkBindImageMemory(device.handle(), image, parts.memory.get(), 0));
  parts.view = makeImageView(device, image, format);
  return parts;
}

}  // namespace freevoxels
