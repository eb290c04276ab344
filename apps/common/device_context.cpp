#include "apps/common/device_context.h"

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

#include "engine/core/error.h"
#include "engine/vulkan/pipeline.h"

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

/// The process that was the first to open a device; 0 if none has. A forked process inherits the number.
std::atomic<int> openingProcess = 0;

/// Fails in a process forked from one that has opened a device: Vulkan's locks may be held there by threads that this one does not have.
int processThatMayOpen() {
  const int self = int(getpid());
  int first = 0;
  if (!openingProcess.compare_exchange_strong(first, self) && first != self)
    fail(ErrorKind::Device,
         "this process was forked from one that uses a Vulkan device already, and cannot use one: start processes by 'spawn', as "
         "multiprocessing.get_context('spawn') does, or fork before the first image");
  return self;
}

}  // namespace

void refuseInsideValidationLog() {
  if (isInsideLog) fail(ErrorKind::Usage, "nothing can be drawn or opened in a function that logs Vulkan's validation: do it afterwards");
}

DeviceContext::DeviceContext(const DeviceOptions& options, const ValidationLog& log)
    : process(processThatMayOpen()), isAdopted(false), instance(log != nullptr, noted(log)), device(options.open(instance)) {}

DeviceContext::DeviceContext(VkInstance adoptedInstance, const AdoptedDevice& adopted, const DeviceOptions& options)
    : process(processThatMayOpen()), isAdopted(true), instance(adoptedInstance), device(options.adopt(instance, adopted)) {}

bool DeviceContext::isOfThisProcess() const {
  return process == int(getpid());
}

void DeviceContext::refuseAfterFork() const {
  if (!isOfThisProcess()) processThatMayOpen();
}

void DeviceContext::checkValidation() const {
  if (const std::uint64_t count = instance.validationMessageCount(); count > 0)
    throw InternalError(fmt::format("{} Vulkan validation messages", count));
}

namespace {

struct SharedContexts {
  std::mutex opening;  ///< of what follows
  std::map<std::pair<std::string, int>, std::shared_ptr<DeviceContext>> contexts;
};

/// Never destroyed, because Python or static objects may release the last renderer after Vulkan's own static
/// objects are gone.
SharedContexts& sharedContexts() {
  static auto& shared = *new SharedContexts;
  return shared;
}

/// Threads may not call Vulkan when its own static objects are gone. Those were registered before, so that this is called first.
void endThreadsAtExit() {
  SharedContexts& shared = sharedContexts();
  const std::unique_lock lock(shared.opening, std::try_to_lock);
  if (!lock) return;  // a thread that is opening a device goes on
  for (const auto& [key, context] : shared.contexts)
    if (context && context->isOfThisProcess()) context->device->pipelines().stopCompilingAhead();
}

}  // namespace

std::shared_ptr<DeviceContext> sharedContext(const DeviceOptions& options) {
  refuseInsideValidationLog();
  processThatMayOpen();  // before the lock, which may have been held when this process was forked
  SharedContexts& shared = sharedContexts();
  const std::lock_guard lock(shared.opening);
  std::shared_ptr<DeviceContext>& context = shared.contexts[{options.selector.value_or(""), options.memoryLimit.value_or(0)}];
  if (context) return context;
  context = std::make_shared<DeviceContext>(options, validationRequested() ? logValidation : ValidationLog());
  static_cast<void>(std::atexit(endThreadsAtExit));
  return context;
}

}  // namespace freevoxels
