#pragma once
// The images of a window, one after the other.

#include <glm/glm.hpp>
#include <vector>

#include "apps/view/window.h"
#include "engine/image/image.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

/// Made again by itself when the window changes its size, or its surface is lost.
class Swapchain {
 public:
  /// All must live as long. Fails with ExitCode::Device where the device cannot show anything in the window.
  Swapchain(const Instance& instance, const Device& device, const Window& window);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  VkFormat format() const { return format_.format; }

  /// Waits for an image to draw into, in layout UNDEFINED. False where there is none: the window has no area,
  /// is changing or is out of sight.
  bool acquire();
  glm::ivec2 size() const { return size_; }
  VkImage image() const { return images_[current_]; }
  VkImageView view() const { return views_[current_].get(); }
  /// Shows the acquired image, in layout PRESENT_SRC_KHR, when all work on it is done.
  void present();

  /// Of the acquired image, in layout PRESENT_SRC_KHR and done: 8-bit RGBA, row 0 is the top. Fails with
  /// ExitCode::Device where the window's images cannot be read.
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
