#pragma once
// Sampled images, for user interfaces.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

/// An 8-bit RGBA image without colour conversion, with linear filtering and clamping to the edge. Sampled in
/// layout SHADER_READ_ONLY_OPTIMAL, drawn into in GENERAL.
class Texture {
 public:
  static constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

  Texture() = default;
  Texture(const Device& device, glm::ivec2 size, const char* name);

  /// Uploads 4 bytes a texel, top row first. Must be called before the texture is sampled. Blocks until the
  /// copy is complete.
  void upload(const Device& device, std::span<const std::uint8_t> texels);

  VkImage handle() const { return image_.get(); }
  VkImageView view() const { return view_.get(); }
  VkSampler sampler() const { return sampler_.get(); }
  glm::ivec2 size() const { return size_; }

 private:
  DeviceMemory memory_;
  OwnedImage image_;
  OwnedImageView view_;
  OwnedSampler sampler_;
  glm::ivec2 size_{0};
};

}  // namespace freevoxels
