#include "apps/view/swapchain.h"

// swapchain.h has volk, which declares what GLFW's Vulkan functions take.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/core/error.h"
#include "engine/vulkan/image_parts.h"

namespace freevoxels {

namespace {

/// Nanoseconds for an image, of which a window that nobody sees may have none: it has to answer all the same.
constexpr std::uint64_t kLongestWait = 100'000'000;

/// Bytes are shown as they are written, sRGB.
bool isPlain(VkSurfaceFormatKHR format) {
  return (format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM) &&
         format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
}

bool isStale(VkResult result) {
  return result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR;
}

}  // namespace

Swapchain::Swapchain(const Instance& instance, const Device& device, const Window& window)
    : instance_(instance), device_(device), window_(window) {
  makeSurface();
  const VkFenceCreateInfo info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  VK_CHECK(vkCreateFence(device.handle(), &info, nullptr, &fence));
  acquired_ = OwnedFence(device.handle(), fence);
}

Swapchain::~Swapchain() {
  views_.clear();
  destroy(retired_);
  destroy(swapchain_);
  vkDestroySurfaceKHR(instance_.handle(), surface_, nullptr);
}

/// When all that was submitted, and presented, is complete.
void Swapchain::destroy(OwnedSwapchain& swapchain) const {
  if (swapchain.get() == VK_NULL_HANDLE) return;
  device_.queue().waitIdle();
  swapchain = {};
}

void Swapchain::makeSurface() {
  VK_CHECK(glfwCreateWindowSurface(instance_.handle(), window_.handle(), nullptr, &surface_));
  VkBool32 supported = VK_FALSE;
  VK_CHECK(
      vkGetPhysicalDeviceSurfaceSupportKHR(device_.physical(), device_.queueFamily(), surface_, &supported));
  if (supported == VK_FALSE)
    fail(ErrorKind::Device, "{} cannot draw into a window here: choose another with --device",
         device_.description().name);
  chooseFormat();
}

void Swapchain::chooseFormat() {
  std::uint32_t count = 0;
  VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, nullptr));
  std::vector<VkSurfaceFormatKHR> formats(count);
  VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, formats.data()));
  const auto plain = std::ranges::find_if(formats, isPlain);
  if (plain == formats.end())
    fail(ErrorKind::Device, "{} has no window images of 8-bit sRGB bytes: choose another with --device",
         device_.description().name);
  format_ = *plain;
}

/// False where the window has no area now.
bool Swapchain::make() {
  VkSurfaceCapabilitiesKHR surface;
  VK_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &surface));
  VkExtent2D extent = surface.currentExtent;
  if (extent.width == std::numeric_limits<std::uint32_t>::max()) {  // it takes the size of the images
    const glm::ivec2 pixels = window_.pixels();
    extent = {
        std::clamp(std::uint32_t(pixels.x), surface.minImageExtent.width, surface.maxImageExtent.width),
        std::clamp(std::uint32_t(pixels.y), surface.minImageExtent.height, surface.maxImageExtent.height)};
  }
  views_.clear();
  if (extent.width == 0 || extent.height == 0) {
    destroy(swapchain_);
    return false;
  }
  readable_ = (surface.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
  const std::uint32_t most = surface.maxImageCount == 0 ? surface.minImageCount + 1 : surface.maxImageCount;
  const VkImageUsageFlags read = readable_ ? VkImageUsageFlags(VK_IMAGE_USAGE_TRANSFER_SRC_BIT) : 0;
  const VkCompositeAlphaFlagsKHR opaque = surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  const VkSwapchainCreateInfoKHR info{
      .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
      .surface = surface_,
      .minImageCount = std::min(surface.minImageCount + 1, most),
      .imageFormat = format_.format,
      .imageColorSpace = format_.colorSpace,
      .imageExtent = extent,
      .imageArrayLayers = 1,
      .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | read,
      .preTransform = surface.currentTransform,
      .compositeAlpha = opaque != 0 ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
      .presentMode = VK_PRESENT_MODE_FIFO_KHR,
      .clipped = VK_TRUE,
      .oldSwapchain = swapchain_.get()};
  VkSwapchainKHR made = VK_NULL_HANDLE;
  VK_CHECK(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &made));
  destroy(retired_);  // of a change before this one
  retired_ = std::exchange(swapchain_, OwnedSwapchain(device_.handle(), made));
  size_ = {int(extent.width), int(extent.height)};

  std::uint32_t count = 0;
  VK_CHECK(vkGetSwapchainImagesKHR(device_.handle(), made, &count, nullptr));
  images_.resize(count);
  VK_CHECK(vkGetSwapchainImagesKHR(device_.handle(), made, &count, images_.data()));
  for (const VkImage image : images_) views_.push_back(makeImageView(device_, image, format_.format));
  return true;
}

bool Swapchain::recreate(VkResult problem) {
  if (problem == VK_ERROR_SURFACE_LOST_KHR) {
    views_.clear();
    destroy(retired_);
    destroy(swapchain_);
    vkDestroySurfaceKHR(instance_.handle(), surface_, nullptr);
    surface_ = VK_NULL_HANDLE;
    makeSurface();
  }
  return make();
}

bool Swapchain::acquire() {
  if (window_.pixels().x == 0 || window_.pixels().y == 0) return false;
  if (swapchain_.get() == VK_NULL_HANDLE || size_ != window_.pixels())
    if (!make()) return false;
  const VkFence fence = acquired_.get();
  const auto next = [&] {
    return vkAcquireNextImageKHR(device_.handle(), swapchain_.get(), kLongestWait, VK_NULL_HANDLE, fence,
                                 &current_);
  };
  VkResult result = next();
  if (isStale(result)) {
    if (!recreate(result)) return false;
    result = next();
    if (isStale(result)) return false;  // it still changes
  }
  if (result == VK_TIMEOUT || result == VK_NOT_READY) return false;
  if (result != VK_SUBOPTIMAL_KHR) VK_CHECK_RESULT(result, "vkAcquireNextImageKHR");
  VK_CHECK(vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX));
  VK_CHECK(vkResetFences(device_.handle(), 1, &fence));
  destroy(retired_);
  return true;
}

void Swapchain::present() {
  const VkSwapchainKHR swapchain = swapchain_.get();
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain,
                              .pImageIndices = &current_};
  const VkResult result = device_.queue().present(info);
  if (isStale(result)) {
    recreate(result);
  } else if (result != VK_SUBOPTIMAL_KHR) {
    VK_CHECK_RESULT(result, "vkQueuePresentKHR");
  }
}

std::vector<std::uint8_t> Swapchain::read() const {
  if (!readable_)
    fail(ErrorKind::Device, "{} does not let the images of windows be read: take the image's own file",
         device_.description().name);
  const std::size_t texels = std::size_t(size_.x) * std::size_t(size_.y);
  const Buffer buffer(device_, 4 * texels, MemoryUse::Readback, "screenshot");
  Commands commands(device_);
  commands.transition(image(), VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {std::uint32_t(size_.x), std::uint32_t(size_.y), 1}};
  vkCmdCopyImageToBuffer(commands.handle(), image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.handle(), 1,
                         &region);
  commands.transition(image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                      VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  commands.submitAndWait();
  std::vector<std::uint8_t> bytes(4 * texels);
  std::memcpy(bytes.data(), buffer.mapped(), bytes.size());
  if (format_.format == VK_FORMAT_B8G8R8A8_UNORM)
    for (std::size_t i = 0; i < texels; ++i) std::swap(bytes[4 * i], bytes[4 * i + 2]);
  return bytes;
}

}  // namespace freevoxels
