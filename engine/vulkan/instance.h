#pragma once
// The Vulkan loader and instance, headless unless the caller names a window system's extensions.

#include <volk.h>

#include <atomic>
#include <cstdint>
#include <span>

namespace freevoxels {

/// Whether the environment variable FREEVOXELS_VALIDATION is 1, as in the tests.
bool validationRequested();

/// The constructor fails with ExitCode::Device and says what to install if there is no Vulkan loader or no
/// driver, or if validation is requested and its layer is missing.
class Instance {
 public:
  explicit Instance(bool validation, std::span<const char* const> extensions = {});
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return instance_; }
  bool validates() const { return messenger_ != VK_NULL_HANDLE; }
  /// Number of warnings and errors of the validation layers so far. Each was also printed on stderr.
  std::uint64_t validationMessageCount() const { return validationMessages_; }

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<std::uint64_t> validationMessages_ = 0;
};

}  // namespace freevoxels
