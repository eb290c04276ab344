#include "apps/library/device_context.h"

#include <map>
#include <mutex>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Whether this thread is in a validation log.
thread_local bool isInsideLog = false;

struct InsideLog {
  InsideLog() { isInsideLog = true; }
  ~InsideLog() { isInsideLog = false; }
};

/// `log` where the calls are noted; null where `log` is.
ValidationLog noted(const ValidationLog& log) {
  refuseInsideValidationLog();
  if (log == nullptr) return nullptr;
  return [log](std::string_view message) {
    const InsideLog inside;
    log(message);
  };
}

}  // namespace

void refuseInsideValidationLog() {
  if (isInsideLog) fail(ErrorKind::Usage, "nothing can be drawn or opened in a function that logs Vulkan's validation: do it afterwards");
}

DeviceContext::DeviceContext(const DeviceOptions& options, const ValidationLog& log)
    : isAdopted(false), instance(log != nullptr, noted(log)), device(options.open(instance)) {}

DeviceContext::DeviceContext(VkInstance adoptedInstance, const AdoptedDevice& adopted, const DeviceOptions& options)
    : isAdopted(true), instance(adoptedInstance), device(options.adopt(instance, adopted)) {}

void DeviceContext::checkValidation() const {
  if (const std::uint64_t count = instance.validationMessageCount(); count > 0)
    throw InternalError(fmt::format("{} Vulkan validation messages", count));
}

std::shared_ptr<DeviceContext> sharedContext(const DeviceOptions& options) {
  refuseInsideValidationLog();
  static std::mutex opening;
  const std::lock_guard lock(opening);
  // Never destroyed, because Python or static objects may release the last renderer after Vulkan's own static
  // objects are gone.
  static auto& contexts = *new std::map<std::pair<std::string, int>, std::shared_ptr<DeviceContext>>;
  std::shared_ptr<DeviceContext>& context = contexts[{options.selector.value_or(""), options.memoryLimit.value_or(0)}];
  if (!context) context = std::make_shared<DeviceContext>(options, validationRequested() ? logValidation : ValidationLog());
  return context;
}

}  // namespace freevoxels
