#include "apps/library/device_context.h"

#include <map>
#include <utility>

namespace freevoxels {

DeviceContext::DeviceContext(const DeviceOptions& options) : instance(validationRequested(), logValidation), device(options.open(instance)) {}

DeviceContext& deviceContext(const DeviceOptions& options) {
  static std::mutex opening;
  const std::lock_guard lock(opening);
  // Never destroyed, because Python or static objects may release the last renderer after Vulkan's own static
  // objects are gone.
  static auto& contexts = *new std::map<std::pair<std::string, int>, std::unique_ptr<DeviceContext>>;
  std::unique_ptr<DeviceContext>& context = contexts[{options.selector.value_or(""), options.memoryLimit.value_or(0)}];
  if (!context) context = std::make_unique<DeviceContext>(options);
  return *context;
}

}  // namespace freevoxels
