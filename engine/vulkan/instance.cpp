#include "engine/vulkan/instance.h"

#include <sys/resource.h>

#include <array>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/vulkan/owned.h"

namespace freevoxels {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// Whether the address space or the number of threads is limited.
bool processIsLimited() {
  rlimit space{}, threads{};
  getrlimit(RLIMIT_AS, &space);
  getrlimit(RLIMIT_NPROC, &threads);
  constexpr rlim_t kFewThreads = 64;
  return space.rlim_cur != RLIM_INFINITY || threads.rlim_cur < kFewThreads;
}

bool layerAvailable(const char* name) {
  std::uint32_t count = 0;
  VK_CHECK(vkEnumerateInstanceLayerProperties(&count, nullptr));
  std::vector<VkLayerProperties> layers(count);
  VK_CHECK(vkEnumerateInstanceLayerProperties(&count, layers.data()));
  for (const VkLayerProperties& layer : layers)
    if (std::strcmp(layer.layerName, name) == 0) return true;
  return false;
}

std::mutex loading;  ///< guards volk's function pointers, which all instances share, while they are set

void openLoader() {
  const std::lock_guard lock(loading);
  if (vkGetInstanceProcAddr == nullptr && volkInitialize() != VK_SUCCESS)
    fail(ErrorKind::Device,
         "no Vulkan loader was found: install libvulkan1, and mesa-vulkan-drivers to render without a GPU");
  if (vkEnumerateInstanceVersion == nullptr || volkGetInstanceVersion() < VK_API_VERSION_1_3)
    fail(ErrorKind::Device, "the Vulkan loader is older than Vulkan 1.3: update libvulkan1");
}

/// The loader's functions dispatch by their first argument, so those of the first instance serve all others, except for
/// functions of instance extensions that the first one did not enable.
void loadFunctions(VkInstance instance, bool hasExtensions) {
  static bool loaded = false;
  const std::lock_guard lock(loading);
  if (!loaded || hasExtensions) volkLoadInstance(instance);
  loaded = true;
}

template <typename Function>
Function extensionFunction(VkInstance instance, const char* name) {
  return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

}  // namespace

void checkVulkan(VkResult result, const char* call, const char* file, int line) {
  if (result == VK_SUCCESS) return;
  const std::string name = fmt::format("VkResult {}", int(result));
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    fail(ErrorKind::OutOfMemory, "the device is out of memory ({} in {}): use a smaller volume or image", name,
         call);
  if (result == VK_ERROR_DEVICE_LOST)
    fail(ErrorKind::Device, "the device was lost ({} in {}): try again, or choose another with {}", name,
         call, Parameter("device"));
  // What drivers answer that find too little of anything when they start; a limit set by the user is the likely reason.
  // The loader says of a layer that does not fit into the address space that it is not there.
  if (result == VK_ERROR_INITIALIZATION_FAILED || result == VK_ERROR_UNKNOWN || (result == VK_ERROR_LAYER_NOT_PRESENT && processIsLimited()))
    fail(processIsLimited() ? ErrorKind::OutOfMemory : ErrorKind::Device,
         "the Vulkan driver failed to start ({} in {}): raise the limits of this process on memory and threads (ulimit -v, ulimit "
         "-u), or choose another device with {}",
         name, call, Parameter("device"));
  throw InternalError(fmt::format("{}:{}: {} returned {}", file, line, call, name));
}

VkBool32 Instance::onValidationMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* instance) {
  Instance& self = *static_cast<Instance*>(instance);
  ++self.validationMessages_;
  if (self.log_) self.log_(data->pMessage);
  return VK_FALSE;
}

Instance::Instance(bool validation, ValidationLog log, std::span<const char* const> moreExtensions)
    : isOwn_(true), log_(std::move(log)) {
  openLoader();
  if (validation && !layerAvailable(kValidationLayer))
    fail(ErrorKind::Device, "validation is requested but there is no validation layer: install vulkan-validationlayers");

  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "FreeVoxels",
                                      .pEngineName = "FreeVoxels",
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType =
          VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
      .pfnUserCallback = onValidationMessage,
      .pUserData = this};
  // Synchronisation validation is off by default. It finds missing barriers, which a CPU device forgives.
  const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = std::uint32_t(enabled.size()),
                                         .pEnabledValidationFeatures = enabled.data()};
  std::vector<const char*> extensions(moreExtensions.begin(), moreExtensions.end());
  if (validation)
    extensions.insert(extensions.end(),
                      {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME});
  const VkInstanceCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
      .pNext = validation ? &features : nullptr,
      .pApplicationInfo = &application,
      .enabledLayerCount = validation ? 1u : 0u,
      .ppEnabledLayerNames = &kValidationLayer,
      .enabledExtensionCount = std::uint32_t(extensions.size()),
      .ppEnabledExtensionNames = extensions.data(),
  };
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    fail(ErrorKind::Device, "no Vulkan driver was found: install mesa-vulkan-drivers to render without a GPU");
  VK_CHECK_RESULT(result, "vkCreateInstance");
  loadFunctions(instance_, !moreExtensions.empty());
  if (validation)
    VK_CHECK(extensionFunction<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT")(
        instance_, &messenger, nullptr, &messenger_));
}

Instance::Instance(VkInstance adopted) : isOwn_(false), instance_(adopted) {
  openLoader();
  loadFunctions(instance_, false);
}

void Instance::callLocking(const std::function<void()>& functions) const {
  try {
    functions();
  } catch (...) {
    isLoaderLocked_ = true;
    throw;
  }
}

Instance::~Instance() {
  if (!isOwn_ || isLoaderLocked_) return;
  if (messenger_ != VK_NULL_HANDLE)
    extensionFunction<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(instance_, messenger_, nullptr);
  vkDestroyInstance(instance_, nullptr);
}

}  // namespace freevoxels
