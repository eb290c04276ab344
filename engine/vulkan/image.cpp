#include "engine/vulkan/image.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/vulkan/image_parts.h"

namespace freevoxels {

namespace {

constexpr VkImageUsageFlags kUsage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
    VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

}  // namespace

void checkTargetFits(const Device& device, glm::ivec2 size, VkFormat format) {
  VkImageFormatProperties properties;
  VK_CHECK(vkGetPhysicalDeviceImageFormatProperties(device.physical(), format, VK_IMAGE_TYPE_2D,
                                                    VK_IMAGE_TILING_OPTIMAL, kUsage, 0, &properties));
  const VkExtent3D most = properties.maxExtent;
  if (std::uint32_t(size.x) > most.width || std::uint32_t(size.y) > most.height)
    fail(ErrorKind::OutOfMemory,
         "an image of {}x{} pixels is larger than the {}x{} of {}: use a smaller {}", size.x, size.y,
         most.width, most.height, device.description().name, Parameter("size"));
  const std::uint64_t bytes = std::uint64_t(size.x) * std::uint64_t(size.y) * bytesPerPixel(format);
  const std::uint64_t largest =
      std::min<std::uint64_t>(properties.maxResourceSize, device.maximumAllocation());
  if (bytes > largest)
    fail(ErrorKind::OutOfMemory,
         "an image of {}x{} pixels needs {} MiB in one piece and {} allocates at most {} MiB: use a smaller {}",
         size.x, size.y, bytes >> 20, device.description().name, largest >> 20, Parameter("size"));
}

std::uint64_t bytesPerPixel(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32_SFLOAT:
      return 4;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      throw InternalError(fmt::format("no render target has format {}", int(format)));
  }
}

RenderTarget::RenderTarget(const Device& device, glm::ivec2 size, VkFormat format, const char* name)
    : format_(format), size_(size) {
  checkTargetFits(device, size, format);
  ImageParts parts = makeImageParts(device, size, format, kUsage, name);
  memory_ = std::move(parts.memory);
  image_ = std::move(parts.image);
  view_ = std::move(parts.view);
}

}  // namespace freevoxels
