#include "apps/python/device_context.h"

#include <map>
#include <utility>

namespace freevoxels {

DeviceContext::DeviceContext(const DeviceOptions& options) : instance(validationRequested()), device(options.open(instance)) {}

DeviceContext& deviceContext(const DeviceOptions& options) {
  // Never destroyed: Python may drop its last renderer after static objects, and Vulkan's own, are gone.
  static auto& contexts = *new std::map<std::pair<std::string, int>, std::unique_ptr<DeviceContext>>;
  std::unique_ptr<DeviceContext>& context = contexts[{options.selector.value_or(""), options.memoryLimit.value_or(0)}];
  if (!context) context = std::make_unique<DeviceContext>(options);
  return *context;
}

}  // namespace freevoxels
