#pragma once
// The images of a window.

#include <glm/glm.hpp>
#include <vector>

#include "apps/view/window.h"
#include "engine/image/image.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

/// Recreated when the window changes its size, or when its surface is lost.
class Swapchain {
 public:
  /// The arguments must outlive it. Fails with ErrorKind::Device if the device cannot draw into the window.
  Swapchain(const Instance& instance, const Device& device, const Window& window);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  VkFormat format() const { return format_.format; }

  /// Waits for an image to draw into, in layout UNDEFINED. Returns false if there is none: the window has no
  /// area, is changing or is hidden.
  bool acquire();
  glm::ivec2 size() const { return size_; }
  VkImage image() const { return images_[current_]; }
  VkImageView view() const { return views_[current_].get(); }
  /// Presents the acquired image, which must be in layout PRESENT_SRC_KHR, after all work on it is done.
  void present();

  /// Reads the acquired image, in layout PRESENT_SRC_KHR and complete: 8-bit RGBA, top row first. Fails with
  /// ErrorKind::Device if the window's images cannot be read.
  std::vector<std::uint8_t> read() const;

 private:
  void chooseFormat();
  void makeSurface();
  bool make();
  bool recreate(VkResult problem);
  void destroy(OwnedSwapchain& swapchain) const;

  const Instance& instance_;
  const Device& device_;
  const Window& window_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format_{};
  bool readable_ = false;
  glm::ivec2 size_{0};
  OwnedSwapchain swapchain_;
  OwnedSwapchain retired_;  ///< the one before, until an image of swapchain_ was acquired
  std::vector<VkImage> images_;
  std::vector<OwnedImageView> views_;
  OwnedFence acquired_;
  std::uint32_t current_ = 0;
};

}  // namespace freevoxels
