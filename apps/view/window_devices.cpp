#include "apps/view/window_devices.h"

#include <fcntl.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "apps/view/swapchain.h"
#include "engine/image/display_pass.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

namespace {

using std::chrono::milliseconds;

constexpr std::array kShowing{VK_KHR_SWAPCHAIN_EXTENSION_NAME};
constexpr milliseconds kLongestTry{10'000}, kBetweenLooks{5};

/// Whether this program, started with the words, ends with exit code 0 in time. What it writes is not shown.
bool succeeds(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_addopen(&files, output, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int problem = posix_spawn(&child, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (problem != 0) return false;
  int status = 0;
  pid_t ended = 0;
  for (milliseconds waited{0}; ended == 0 && waited < kLongestTry; waited += kBetweenLooks) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended == 0) std::this_thread::sleep_for(kBetweenLooks);
  }
  if (ended == 0) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return false;
  }
  return ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The CPU's driver presents by copying, on every display.
bool canPresent(const DeviceDescription& device) {
  return device.vulkanType == VK_PHYSICAL_DEVICE_TYPE_CPU || succeeds({"freevoxels-view", kTryPresentation, "--device", device.uuid});
}

}  // namespace

WindowDevices::WindowDevices(const Instance& instance, const DeviceOptions& device, const std::optional<std::string>& showOn) {
  std::optional<std::string> other = showOn;
  if (!other || *other == kShowOnAuto) {
    other.reset();
    const DeviceDescription chosen = chooseDevice(instance, device.selector.value_or(""));
    const std::vector<DeviceDescription> all = listDevices(instance);
    const auto cpu = std::ranges::find_if(
        all, [](const DeviceDescription& one) { return one.vulkanType == VK_PHYSICAL_DEVICE_TYPE_CPU && one.rejections.empty(); });
    if (cpu != all.end() && !canPresent(chosen)) {
      spdlog::warn("{} cannot present images on this display: it makes them, and {} draws the window", chosen.name, cpu->name);
      other = cpu->uuid;
    }
  }
  drawing_ = device.open(instance, other ? std::span<const char* const>() : kShowing);
  if (other) showing_ = DeviceOptions{.selector = other, .memoryLimit = {}}.open(instance, kShowing);
}

RenderTarget WindowDevices::moved(const RenderTarget& image) const {
  Commands commands(*drawing_);
  TargetReadback readback;
  readback.record(*drawing_, commands, image);
  commands.submitAndWait();
  return uploadImage(*showing_, {.size = image.size(), .pixels = readback.read<glm::vec4>()});
}

void tryPresentation(const DeviceOptions& device) {
  const WindowSystem windows;
  withInstance(
      [&](const Instance& instance) {
        const Window window(windows, "FreeVoxels", {64, 64}, false);
        const std::unique_ptr<Device> opened = device.open(instance, kShowing);
        const Swapchain swapchain(instance, *opened, window);
      },
      windows.instanceExtensions());
}

}  // namespace freevoxels
