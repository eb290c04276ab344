#pragma once
// Two-dimensional float images that are drawn into, read by compute passes and copied out.

#include <glm/glm.hpp>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

/// Bytes per pixel of a render target's format.
std::uint64_t bytesPerPixel(VkFormat format);

/// Fails with ErrorKind::OutOfMemory if the device does not support a target of this size.
void checkTargetFits(const Device& device, glm::ivec2 size, VkFormat format);

class RenderTarget {
 public:
  RenderTarget() = default;
  RenderTarget(const Device& device, glm::ivec2 size, VkFormat format, const char* name);

  VkImage handle() const { return image_.get(); }
  VkImageView view() const { return view_.get(); }
  VkFormat format() const { return format_; }
  glm::ivec2 size() const { return size_; }
  bool exists() const { return image_.get() != VK_NULL_HANDLE; }

 private:
  DeviceMemory memory_;
  OwnedImage image_;
  OwnedImageView view_;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  glm::ivec2 size_{0};
};

}  // namespace freevoxels
