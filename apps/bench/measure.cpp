#include "apps/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <thread>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels::bench {

double least(int runs, const std::function<double()>& run) {
  // An idle GPU takes a while to reach its full clock rate.
  constexpr std::chrono::milliseconds kAtLeast(300);
  const auto start = std::chrono::steady_clock::now();
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i < runs || std::chrono::steady_clock::now() - start < kAtLeast; ++i)
    best = std::min(best, run());
  return best;
}

double millisecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double copyTime(const Device& device, std::uint64_t bytes) {
  if (!device.isCpu()) {
    const Buffer from(device, bytes, MemoryUse::Device, "copied bytes"), to(device, bytes, MemoryUse::Device, "copy of bytes");
    return least(5, [&] {
      Commands commands(device);
      commands.beginPass("copy");
      commands.copy(from, to, {.srcOffset = 0, .dstOffset = 0, .size = bytes});
      commands.submitAndWait();
      return commands.times().front().milliseconds;
    });
  }
  std::vector<char> from(bytes, 1), to(bytes, 2);
  const std::size_t half = bytes / 2;
  return least(5, [&] {
    const auto start = std::chrono::steady_clock::now();
    std::thread other([&] { std::memcpy(to.data(), from.data(), half); });
    std::memcpy(to.data() + half, from.data() + half, bytes - half);
    other.join();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  });
}

}  // namespace freevoxels::bench
