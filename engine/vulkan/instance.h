#pragma once
// The Vulkan loader and instance, headless unless the caller names a window system's extensions.

#include <volk.h>

#include <atomic>
#include <cstdint>
#include <span>

namespace freevoxels {

/// True when the environment has FREEVOXELS_VALIDATION=1, as the tests do.
bool validationRequested();

/// Fails with ExitCode::Device, and says what to install, where there is no Vulkan loader or no driver; also
/// where validation is asked for and the layer is missing.
class Instance {
 public:
  explicit Instance(bool validation, std::span<const char* const> extensions = {});
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return instance_; }
  bool validates() const { return messenger_ != VK_NULL_HANDLE; }
  /// Warnings and errors of the validation layer so far; each was also printed on stderr.
  std::uint64_t validationMessageCount() const { return validationMessages_; }

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<std::uint64_t> validationMessages_ = 0;
};

}  // namespace freevoxels
