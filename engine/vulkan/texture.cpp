#include "engine/vulkan/texture.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/image_parts.h"

namespace freevoxels {

namespace {

constexpr std::uint64_t kTexelBytes = 4;

}  // namespace

Texture::Texture(const Device& device, glm::ivec2 size, const char* name) : size_(size) {
  const std::uint32_t most = device.limits().maxImageDimension2D;
  if (std::uint32_t(size.x) > most || std::uint32_t(size.y) > most)
    fail(ErrorKind::OutOfMemory, "{} takes no image of {}x{} pixels, only up to {} along an edge",
         device.description().name, size.x, size.y, most);
  ImageParts parts = makeImageParts(
      device, size, kFormat,
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
      name);
  memory_ = std::move(parts.memory);
  image_ = std::move(parts.image);
  view_ = std::move(parts.view);

  const VkSamplerCreateInfo samplerInfo{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                        .magFilter = VK_FILTER_LINEAR,
                                        .minFilter = VK_FILTER_LINEAR,
                                        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  VkSampler sampler = VK_NULL_HANDLE;
  VK_CHECK(vkCreateSampler(device.handle(), &samplerInfo, nullptr, &sampler));
  sampler_ = OwnedSampler(device.handle(), sampler);
}

void Texture::upload(const Device& device, std::span<const std::uint8_t> texels) {
  FV_CHECK_EQ(texels.size(), std::size_t(size_.x) * std::size_t(size_.y) * kTexelBytes);
  const Buffer staging(device, texels.size(), MemoryUse::Upload, "texture upload");
  std::ranges::copy(std::as_bytes(texels), staging.mapped());
  Commands commands(device);
  commands.transition(image_.get(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {std::uint32_t(size_.x), std::uint32_t(size_.y), 1}};
  vkCmdCopyBufferToImage(commands.handle(), staging.handle(), image_.get(),
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  commands.transition(image_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_TRANSFER_BIT,
                      VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  commands.submitAndWait();
}

}  // namespace freevoxels
