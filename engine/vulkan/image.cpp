#include "engine/vulkan/image.h"

#include "engine/core/error.h"
#include "engine/vulkan/buffer.h"

namespace freevoxels {

RenderTarget::RenderTarget(const Device& device, glm::ivec2 size, VkFormat format, const char* name)
    : format_(format), size_(size) {
  const auto limit = int(device.limits().maxImageDimension2D);
  if (size.x > limit || size.y > limit)
    fail(ExitCode::OutOfMemory, "an image of {}x{} pixels is larger than the {}x{} of this device: use a smaller --size",
         size.x, size.y, limit, limit);
  const VkImageCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
      .imageType = VK_IMAGE_TYPE_2D,
      .format = format,
      .extent = {std::uint32_t(size.x), std::uint32_t(size.y), 1},
      .mipLevels = 1,
      .arrayLayers = 1,
      .samples = VK_SAMPLE_COUNT_1_BIT,
      .tiling = VK_IMAGE_TILING_OPTIMAL,
      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
  VkImage image = VK_NULL_HANDLE;
  VK_CHECK(vkCreateImage(device.handle(), &info, nullptr, &image));
  image_ = OwnedImage(device.handle(), image);
  device.setName(VK_OBJECT_TYPE_IMAGE, std::uint64_t(image), name);

  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), image, &needs);
  if (needs.size > device.maximumAllocation())
    fail(ExitCode::OutOfMemory, "an image of {}x{} pixels needs {} MiB and this device allocates at most {}: use a smaller --size",
         size.x, size.y, needs.size >> 20, device.maximumAllocation() >> 20);
  const VkMemoryAllocateInfo allocation{
      .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
      .allocationSize = needs.size,
      .memoryTypeIndex = findMemoryType(device, needs.memoryTypeBits, MemoryUse::Device)};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VK_CHECK(vkAllocateMemory(device.handle(), &allocation, nullptr, &memory));
  memory_ = OwnedMemory(device.handle(), memory);
  VK_CHECK(vkBindImageMemory(device.handle(), image, memory, 0));

  const VkImageViewCreateInfo viewInfo{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                       .image = image,
                                       .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                       .format = format,
                                       .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  VkImageView view = VK_NULL_HANDLE;
  VK_CHECK(vkCreateImageView(device.handle(), &viewInfo, nullptr, &view));
  view_ = OwnedImageView(device.handle(), view);
}

}  // namespace freevoxels
