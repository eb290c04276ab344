#pragma once
// The Vulkan loader and instance, headless unless the caller names a window system's extensions.

#include <volk.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

namespace freevoxels {

/// Is called with each message of the validation layers, by any thread that calls Vulkan.
using ValidationLog = std::function<void(std::string_view message)>;

/// The constructors fail with ErrorKind::Device and say what to install if there is no Vulkan loader or no driver, or if
/// validation is requested and its layer is missing. They may be called from any thread.
class Instance {
 public:
  /// Creates an instance, with the validation layers if `validation`. `extensions` are enabled in addition.
  explicit Instance(bool validation, ValidationLog log = {}, std::span<const char* const> extensions = {});
  /// Uses an instance of the caller's that was created for Vulkan 1.3 and must outlive this object.
  explicit Instance(VkInstance adopted);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return instance_; }
  bool validates() const { return messenger_ != VK_NULL_HANDLE; }
  /// Number of warnings and errors of the validation layers so far.
  std::uint64_t validationMessageCount() const { return validationMessages_; }
  /// Calls functions of the loader that take its lock, and passes exceptions on. A driver that finds no memory may throw one, which leaves
  /// the lock taken: this instance is then never destroyed, as that would wait for the lock forever.
  void callLocking(const std::function<void()>& functions) const;

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL onValidationMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* instance);

  const bool isOwn_;
  const ValidationLog log_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<std::uint64_t> validationMessages_ = 0;
  mutable std::atomic<bool> isLoaderLocked_ = false;
};

}  // namespace freevoxels
